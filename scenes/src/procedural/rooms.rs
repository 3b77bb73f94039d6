//! Rooms: pairs of rows of furnished rooms along corridors, joined by doorways. From inside, doorways are the only way out
//! for the eye, as in the scenes of portal culling.

use super::furniture::Furniture;
use super::parts::Parts;
use super::random::Random;
use super::{shade, sized, standing, Assembly, SceneOptions};
use crate::camera::{Camera, Pose, Projection};
use crate::model::{Aabb, Cell, Cells, Mesh, Portal, Scene, Walk};
use glam::DVec3;

/// About how many objects scale 1 has.
const OBJECTS: f64 = 4000.0;
const OBJECTS_A_ROOM: f64 = 19.4;
/// Sizes in metres. A pair of rows is a room's depth, a corridor and a room's depth.
const WIDTH: f64 = 6.0;
const DEPTH: f64 = 5.0;
const CORRIDOR: f64 = 2.4;
const PAIR: f64 = 2.0 * DEPTH + CORRIDOR;
const CEILING: f64 = 2.7;
const EYE: f64 = 1.6;
const WALL: f64 = 0.15;

struct Builder {
    assembly: Assembly,
    furniture: Furniture,
    cube: u32,
    /// Walls with a doorway, as wide and as deep as a room.
    doorways: [u32; 2],
    random: Random,
    columns: usize,
    pairs: usize,
    /// The doorways, by where they are in the middle of the floor and whether they lead along z.
    doors: Vec<(DVec3, bool)>,
}

/// Which of the two rows of a pair: before the corridor or behind it.
#[derive(Clone, Copy, PartialEq)]
enum Row {
    Before,
    Behind,
}

pub(super) fn make(options: &SceneOptions) -> Scene {
    let rooms = (OBJECTS * options.scale / OBJECTS_A_ROOM).max(6.0);
    let columns = ((rooms * 0.5 * PAIR / WIDTH).sqrt().round() as usize).max(3);
    let pairs = ((rooms / (2 * columns) as f64).round() as usize).max(1);
    let mut assembly = Assembly::new("rooms");
    let cube = assembly.mesh(cube());
    let doorways =
        [assembly.mesh(doorway("doorway wide", WIDTH as f32)), assembly.mesh(doorway("doorway", DEPTH as f32))];
    let furniture = Furniture::new(&mut assembly);
    let random = Random::new(options.seed, 0);
    let mut builder = Builder { assembly, furniture, cube, doorways, random, columns, pairs, doors: Vec::new() };
    for pair in 0..pairs {
        for column in 0..columns {
            builder.random = Random::new(options.seed, (1 + pair * columns + column) as u64);
            builder.room(pair, column, Row::Before);
            builder.room(pair, column, Row::Behind);
            builder.corridor(pair, column);
        }
        builder.ends(pair);
    }
    builder.last_row();
    let (walk, cells) = (builder.walk(), builder.cells());
    let mut scene = builder.assembly.scene;
    scene.cells = Some(cells);
    scene.cameras = vec![Camera {
        name: "room".into(),
        // From beside one wall, past the middle of the room, to the doorway to the corridor.
        pose: Pose::looking_at(walk.points[0] - DVec3::new(2.3, 0.0, 0.4), walk.points[0] + DVec3::new(0.6, -0.3, 2.4)),
        projection: Projection::Perspective { fov_y: 60f64.to_radians(), near: 0.05, far: Some(500.0) },
        aspect: None,
        node: None,
    }];
    scene.walk = Some(walk);
    scene
}

/// From -0.5 to 0.5 across, from 0 to 1 up.
fn cube() -> Mesh {
    let mut parts = Parts::default();
    parts.cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5]);
    parts.mesh("cube")
}

/// A wall along x with an opening of 1 m by 2.1 m in its middle, framed.
fn doorway(name: &str, length: f32) -> Mesh {
    let (end, half, top) = (0.5 * length, 0.5 * WALL as f32, CEILING as f32 + 0.1);
    let mut parts = Parts::default();
    parts.cuboid([-end, -0.1, -half], [-0.5, top, half]);
    parts.cuboid([0.5, -0.1, -half], [end, top, half]);
    parts.cuboid([-0.5, 2.1, -half], [0.5, top, half]);
    for x in [-0.58, 0.5] {
        parts.cuboid([x, -0.05, -half - 0.02], [x + 0.08, 2.18, half + 0.02]);
    }
    parts.cuboid([-0.57, 2.1, -half - 0.025], [0.57, 2.2, half + 0.025]);
    parts.mesh(name)
}

/// An upright opening that stands on a point, as high as `size.y`, and half as wide as it is in x or z.
fn opening(cells: [u32; 2], at: DVec3, size: DVec3) -> Portal {
    let side = DVec3::new(size.x, 0.0, size.z);
    let up = DVec3::Y * size.y;
    Portal { cells: cells.map(Some), corners: vec![at - side, at + side, at + side + up, at - side + up] }
}

impl Builder {
    /// The middle of a room's floor.
    fn middle(&self, pair: usize, column: usize, row: Row) -> DVec3 {
        let z = if row == Row::Before { 0.5 * DEPTH } else { 1.5 * DEPTH + CORRIDOR };
        self.origin() + DVec3::new((column as f64 + 0.5) * WIDTH, 0.0, pair as f64 * PAIR + z)
    }

    /// The corner of the building; its middle is at 0.
    fn origin(&self) -> DVec3 {
        -0.5 * DVec3::new(self.columns as f64 * WIDTH, 0.0, self.pairs as f64 * PAIR)
    }

    /// Columns that the walk leads through, in the middle pair's row before the corridor.
    fn walk_columns(&self) -> (usize, usize) {
        let from = (self.columns - 1) / 2 - usize::from(self.columns > 3);
        (from, (from + 2).min(self.columns - 1))
    }

    fn walk_pair(&self) -> usize {
        self.pairs / 2
    }

    fn room(&mut self, pair: usize, column: usize, row: Row) {
        let at = self.middle(pair, column, row);
        self.floor_and_ceiling(at, DVec3::new(WIDTH, 0.0, DEPTH));
        // The side at smaller x; the building's end closes the last room.
        let (from, to) = self.walk_columns();
        let on_walk = pair == self.walk_pair() && row == Row::Before && column > from && column <= to;
        let has_door = column > 0 && (on_walk || self.random.chance(0.3));
        self.side_wall(at - DVec3::new(0.5 * WIDTH, 0.0, 0.0), has_door);
        let (corridor, outer) = if row == Row::Before { (0.5, -0.5) } else { (-0.5, 0.5) };
        self.long_wall(at + DVec3::new(0.0, 0.0, corridor * DEPTH), true);
        // The wall to the pair before is this room's own; that to the pair after belongs to the next.
        if row == Row::Before {
            let has_door = pair > 0 && self.random.chance(0.25);
            self.long_wall(at + DVec3::new(0.0, 0.0, outer * DEPTH), has_door);
        }
        self.furnish(at);
    }

    fn floor_and_ceiling(&mut self, at: DVec3, size: DVec3) {
        let floor = shade(&mut self.random, [0.45, 0.33, 0.22], 0.15);
        let slab = DVec3::new(size.x, 0.2, size.z);
        self.assembly.place(self.cube, floor, sized(at - DVec3::new(0.0, 0.2, 0.0), slab));
        self.assembly.place(self.cube, [0.85, 0.85, 0.83], sized(at + DVec3::new(0.0, CEILING, 0.0), slab));
    }

    /// A wall along x, with its middle at a point.
    fn long_wall(&mut self, at: DVec3, has_door: bool) {
        let colour = shade(&mut self.random, [0.78, 0.75, 0.68], 0.08);
        if has_door {
            self.doors.push((at, true));
            self.assembly.place(self.doorways[0], colour, standing(at, 0));
        } else {
            let size = DVec3::new(WIDTH, CEILING + 0.2, WALL);
            self.assembly.place(self.cube, colour, sized(at - DVec3::new(0.0, 0.1, 0.0), size));
        }
    }

    /// A wall along z, and the post that hides where it meets others.
    fn side_wall(&mut self, at: DVec3, has_door: bool) {
        let colour = shade(&mut self.random, [0.72, 0.74, 0.7], 0.08);
        if has_door {
            self.doors.push((at, false));
            self.assembly.place(self.doorways[1], colour, standing(at, 1));
        } else {
            let size = DVec3::new(WALL, CEILING + 0.2, DEPTH);
            self.assembly.place(self.cube, colour, sized(at - DVec3::new(0.0, 0.1, 0.0), size));
        }
        for end in [-0.5, 0.5] {
            let post = at + DVec3::new(0.0, -0.05, end * DEPTH);
            // Posts of the next pair stand in the same place, and would lie in the same planes.
            let thickness = if end < 0.0 { 0.22 } else { 0.24 };
            let size = DVec3::new(thickness, CEILING + 0.1, thickness);
            self.assembly.place(self.cube, [0.6, 0.58, 0.55], sized(post, size));
        }
    }

    fn corridor(&mut self, pair: usize, column: usize) {
        let at = self.middle(pair, column, Row::Before) + DVec3::new(0.0, 0.0, 0.5 * (DEPTH + CORRIDOR));
        self.floor_and_ceiling(at, DVec3::new(WIDTH, 0.0, CORRIDOR));
        let lamp = standing(at + DVec3::new(1.5, CEILING, 0.0), 0);
        self.furniture.place(&mut self.assembly, &mut self.random, self.furniture.lamp, lamp);
        for (side, turns) in [(-1.0, 0), (1.0, 2)] {
            let along = self.random.range(1.2, 2.3);
            let wall = at + DVec3::new(along, 1.5, side * 0.5 * (CORRIDOR - WALL));
            self.furniture.place(&mut self.assembly, &mut self.random, self.furniture.picture, standing(wall, turns));
        }
    }

    /// Closes a pair of rows at its larger x, and its corridor at both ends.
    fn ends(&mut self, pair: usize) {
        let reach = 0.5 * WIDTH;
        for row in [Row::Before, Row::Behind] {
            let last = self.middle(pair, self.columns - 1, row);
            self.side_wall(last + DVec3::new(reach, 0.0, 0.0), false);
        }
        let to_corridor = DVec3::new(0.0, -0.1, 0.5 * (DEPTH + CORRIDOR));
        let first = self.middle(pair, 0, Row::Before) + to_corridor - DVec3::new(reach, 0.0, 0.0);
        let last = self.middle(pair, self.columns - 1, Row::Before) + to_corridor + DVec3::new(reach, 0.0, 0.0);
        for at in [first, last] {
            let size = DVec3::new(WALL + 0.02, CEILING + 0.2, CORRIDOR);
            self.assembly.place(self.cube, [0.7, 0.7, 0.68], sized(at, size));
        }
    }

    /// The outer wall of the last row.
    fn last_row(&mut self) {
        for column in 0..self.columns {
            let at = self.middle(self.pairs - 1, column, Row::Behind) + DVec3::new(0.0, 0.0, 0.5 * DEPTH);
            self.long_wall(at, false);
        }
    }

    /// A piece in each corner, so that the ways between the doorways stay free; a lamp, a rug, pictures.
    fn furnish(&mut self, at: DVec3) {
        let lamp = standing(at + DVec3::new(0.0, CEILING, 0.0), 0);
        self.furniture.place(&mut self.assembly, &mut self.random, self.furniture.lamp, lamp);
        if self.random.chance(0.6) {
            self.furniture.place(&mut self.assembly, &mut self.random, self.furniture.rug, standing(at, 0));
        }
        for (x, z) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            self.corner(at, x, z);
        }
        for (side, turns) in [(-1.0, 1), (1.0, 3)] {
            let wall = at + DVec3::new(side * 0.5 * (WIDTH - WALL), 1.6, self.random.range(-1.6, -1.1));
            self.furniture.place(&mut self.assembly, &mut self.random, self.furniture.picture, standing(wall, turns));
        }
    }

    /// One piece with its back to the wall at `z`, and what goes with it.
    fn corner(&mut self, at: DVec3, x: f64, z: f64) {
        let furniture = &self.furniture;
        // The piece, and half its depth.
        let choices = [
            (furniture.shelf, 0.15),
            (furniture.sofa, 0.45),
            (furniture.bed, 1.06),
            (furniture.desk, 0.36),
            (furniture.table, 0.42),
            (furniture.plant, 0.3),
        ];
        let (piece, half_depth) = self.random.pick(&choices);
        let turns = if z < 0.0 { 0 } else { 2 };
        let back = z * (0.5 * DEPTH - 0.5 * WALL - 0.06 - half_depth);
        let place = at + DVec3::new(1.8 * x, 0.0, back);
        self.furniture.place(&mut self.assembly, &mut self.random, piece, standing(place, turns));
        let is_table = piece == self.furniture.desk || piece == self.furniture.table;
        if is_table {
            let chair = place - DVec3::new(0.0, 0.0, z * (half_depth + 0.25));
            self.furniture.place(
                &mut self.assembly,
                &mut self.random,
                self.furniture.chair,
                standing(chair, turns + 2),
            );
            let vase = place + DVec3::new(-0.45 * x, 0.742, 0.1 * z);
            self.furniture.place(&mut self.assembly, &mut self.random, self.furniture.vase, standing(vase, 0));
        }
    }

    /// Rooms and the corridor before each, up to the middles of walls, floors and ceilings; their doorways, and the corridor's open ends.
    fn cells(&self) -> Cells {
        let mut cells = Vec::new();
        let mut portals = Vec::new();
        for pair in 0..self.pairs {
            for column in 0..self.columns {
                let before = self.middle(pair, column, Row::Before);
                let out = DVec3::new(0.0, 0.0, 0.5 * (DEPTH + CORRIDOR));
                let spots = [(before, DEPTH), (before + out, CORRIDOR), (before + 2.0 * out, DEPTH)];
                for ((at, depth), name) in spots.into_iter().zip(["room before", "corridor", "room behind"]) {
                    let half = DVec3::new(0.5 * WIDTH, 0.0, 0.5 * depth);
                    let bounds = Aabb { min: at - half - DVec3::Y * 0.1, max: at + half + DVec3::Y * (CEILING + 0.1) };
                    cells.push(Cell { name: format!("{name} {pair}.{column}"), bounds });
                }
                if column > 0 {
                    let corridor = cells.len() as u32 - 2;
                    let at = before + out - DVec3::new(0.5 * WIDTH, 0.1, 0.0);
                    let size = DVec3::new(0.0, CEILING + 0.2, 0.5 * CORRIDOR);
                    portals.push(opening([corridor - 3, corridor], at, size));
                }
            }
        }
        for (at, along_z) in &self.doors {
            let across = if *along_z { DVec3::Z } else { DVec3::X };
            let holding = |point: DVec3| cells.iter().position(|cell| cell.bounds.contains(point)).unwrap_or(0) as u32;
            let sides = [-0.5, 0.5].map(|side| holding(*at + DVec3::Y + side * across));
            // From below the floor to the lintel.
            portals.push(opening(sides, *at - DVec3::Y * 0.1, DVec3::new(0.5, 2.2, 0.5) * (DVec3::ONE - across)));
        }
        // Posts and door frames reach farthest from the middles of walls.
        Cells { half_wall: 0.5 * WALL - 1e-3, reach: 0.125, cells, portals }
    }

    /// Out of a room, along the corridor, into another, and back from room to room.
    fn walk(&self) -> Walk {
        let (from, to) = self.walk_columns();
        let eye = DVec3::new(0.0, EYE, 0.0);
        let first = self.middle(self.walk_pair(), from, Row::Before) + eye;
        let last = self.middle(self.walk_pair(), to, Row::Before) + eye;
        let out = DVec3::new(0.0, 0.0, 0.5 * (DEPTH + CORRIDOR));
        let points = vec![first, first + out, last + out, last, first];
        Walk { points, length: 16.0, clearance: 0.4 }
    }
}
