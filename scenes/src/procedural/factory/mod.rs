//! Factory (FC): closed halls full of machines along streets, after the scene of the same name in the EOVC thesis, IV and
//! table 1: 46,600 objects of 5,718,850 triangles, "a widespread medium-scale scene, containing detailed objects such as
//! street, barrels, and pipes".
//!
//! From a street one sees the fronts along it and what stands before them; what is in the halls and in the other streets is
//! hidden, 99 % of all. +y is up, the streets are at y = 0.

mod inside;
mod meshes;

use super::detail::Detail;
use super::random::Random;
use super::{camera, count, shade, sized, standing, turned, Assembly, SceneOptions};
use crate::model::{Scene, Walk};
use glam::DVec3;
use meshes::Meshes;

/// Objects at scale 1.
const OBJECTS: usize = 46_600;
const LEAST_OBJECTS: usize = 150;
/// About how many objects a hall with its streets has; decides how wide the factory is for its count.
const OBJECTS_A_HALL: f64 = 430.0;
/// Length of a piece of wall or roof in metres; the meshes are made for it.
pub(super) const PANEL: f64 = 6.0;
/// Pieces of wall along x and z.
const PANELS: [usize; 2] = [8, 5];
/// A hall in metres.
const HALL: [f64; 2] = [PANELS[0] as f64 * PANEL, PANELS[1] as f64 * PANEL];
/// Height of the walls in metres; the meshes are made for it.
pub(super) const WALL: f64 = 8.0;
/// Width of the streets in metres.
const STREET: f64 = 13.0;
const PITCH: [f64; 2] = [HALL[0] + STREET, HALL[1] + STREET];
const EYE: f64 = 1.7;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 120.0;

const WALLS: [[f32; 3]; 5] =
    [[0.5, 0.3, 0.24], [0.52, 0.52, 0.5], [0.36, 0.44, 0.5], [0.56, 0.5, 0.38], [0.38, 0.44, 0.38]];
const PAINT: [[f32; 3]; 6] =
    [[0.6, 0.18, 0.12], [0.16, 0.32, 0.55], [0.68, 0.54, 0.12], [0.2, 0.42, 0.25], [0.5, 0.5, 0.52], [0.3, 0.3, 0.32]];
const STEEL: [f32; 3] = [0.45, 0.46, 0.48];
const GLASS: [f32; 3] = [0.14, 0.2, 0.26];
const WOOD: [f32; 3] = [0.5, 0.38, 0.22];

/// The builder's hands: where things go, what there is to place, and chance.
struct Builder {
    assembly: Assembly,
    meshes: Meshes,
    random: Random,
}

pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let halls = (target as f64 / OBJECTS_A_HALL).ceil();
    let columns = (halls * PITCH[1] / PITCH[0]).sqrt().round().max(1.0) as usize;
    let rows = (halls / columns as f64).ceil().max(1.0);
    let corner = -0.5 * DVec3::new(columns as f64 * PITCH[0], 0.0, rows * PITCH[1]);
    let mut assembly = Assembly::new("factory");
    let meshes = Meshes::new(&mut assembly, Detail::new(options.detail));
    let mut builder = Builder { assembly, meshes, random: Random::new(options.seed, 0) };
    builder.assembly.scene.objects.reserve(target + 1024);
    let land = DVec3::new(columns as f64 * PITCH[0] + 160.0, 1.0, rows * PITCH[1] + 160.0);
    builder.assembly.place(builder.meshes.slab, [0.32, 0.34, 0.27], sized(DVec3::new(0.0, -1.3, 0.0), land));
    let mut hall = 0;
    while builder.assembly.len() < target {
        builder.random = Random::new(options.seed, 1 + hall as u64);
        let at = corner + DVec3::new((hall % columns) as f64 * PITCH[0], 0.0, (hall / columns) as f64 * PITCH[1]);
        builder.street(at);
        builder.hall(at + DVec3::new(STREET, 0.0, STREET));
        hall += 1;
    }
    let walk = street_walk(corner, columns, (hall / columns).max(1));
    let mut scene = builder.assembly.scene;
    scene.objects.truncate(target);
    scene.cameras = vec![camera("street", &walk, 0.1, 2500.0)];
    scene.walk = Some(walk);
    scene
}

impl Builder {
    fn put(&mut self, mesh: u32, colour: [f32; 3], at: DVec3, turns: i32) {
        let colour = shade(&mut self.random, colour, 0.25);
        self.assembly.place(mesh, colour, standing(at, turns));
    }

    fn painted(&mut self, mesh: u32, at: DVec3, turns: i32) {
        let colour = self.random.pick(&PAINT);
        self.put(mesh, colour, at, turns);
    }

    /// The streets before a hall at its smaller x and z, from a corner of their crossing.
    fn street(&mut self, at: DVec3) {
        let (slab, grey) = (self.meshes.slab, [0.24, 0.24, 0.25]);
        let mut paved = |x: f64, z: f64, size: [f64; 2], down: f64| {
            let middle = at + DVec3::new(x + 0.5 * size[0], -1.0 - down, z + 0.5 * size[1]);
            let colour = shade(&mut self.random, grey, 0.15);
            self.assembly.place(slab, colour, sized(middle, DVec3::new(size[0], 1.0, size[1])));
        };
        paved(0.0, 0.0, [PITCH[0], STREET], 0.0);
        paved(0.0, STREET - 0.1, [STREET, HALL[1] + 0.2], 0.02);
        for lamp in 0..3 {
            let along = 8.0 + 20.0 * f64::from(lamp);
            let lamp = self.meshes.lamp_post;
            self.put(lamp, STEEL, at + DVec3::new(along, -0.02, STREET - 0.9), 0);
        }
        self.pipe_rack(at);
        for _ in 0..8 {
            let along = self.random.range(STREET + 2.0, PITCH[0] - 3.0);
            self.heap(at + DVec3::new(along, 0.0, STREET - 2.2));
            let along = self.random.range(STREET + 3.0, PITCH[1] - 3.0);
            self.heap(at + DVec3::new(STREET - 2.2, 0.0, along));
        }
        if self.random.chance(0.4) {
            let truck = self.meshes.truck;
            let along = self.random.range(20.0, 50.0);
            self.painted(truck, at + DVec3::new(along, 0.0, 3.3), 0);
        }
        if self.random.chance(0.35) {
            let tank = self.meshes.tank;
            self.put(tank, [0.6, 0.6, 0.58], at + DVec3::new(STREET - 2.2, -0.05, PITCH[1] - 9.0), 0);
        }
    }

    /// Pipes on supports along one side of the street, above all heads.
    fn pipe_rack(&mut self, at: DVec3) {
        for piece in 0..PANELS[0] + 2 {
            let place = at + DVec3::new(piece as f64 * PANEL, 0.0, 1.1);
            if piece % 2 == 1 {
                let support = self.meshes.support;
                self.put(support, STEEL, place - DVec3::Y * 0.05, 0);
            }
            let pipes = self.random.pick(&self.meshes.rack_pipes);
            self.painted(pipes, place + DVec3::Y * 4.6, 0);
        }
        if self.random.chance(0.5) {
            // Across the street, from the rack into the hall.
            let bridge = self.meshes.bridge;
            let along = self.random.range(STREET + 4.0, PITCH[0] - 6.0);
            self.painted(bridge, at + DVec3::new(along, 5.6, 1.1), 0);
        }
    }

    /// Some barrels or crates beside one another.
    fn heap(&mut self, at: DVec3) {
        if self.random.chance(0.35) {
            let pallet = self.meshes.pallet;
            self.put(pallet, WOOD, at, 0);
            let crate_mesh = self.meshes.crate_box;
            self.put(crate_mesh, WOOD, at + DVec3::new(0.03, 0.14, 0.02), 0);
            return;
        }
        let paint = self.random.pick(&PAINT);
        for barrel in 0..1 + self.random.below(4) {
            let aside = DVec3::new(0.66 * (barrel / 2) as f64, 0.0, 0.66 * (barrel % 2) as f64);
            let jitter = DVec3::new(self.random.range(-0.03, 0.03), -0.01, self.random.range(-0.03, 0.03));
            let colour = shade(&mut self.random, paint, 0.3);
            let angle = self.random.range(0.0, 6.0);
            self.assembly.place(self.meshes.barrel, colour, turned(at + aside + jitter, angle));
        }
    }

    /// A hall from its corner: walls without gaps, a roof, and what is in it.
    fn hall(&mut self, at: DVec3) {
        let wall = self.random.pick(&WALLS);
        let floor = DVec3::new(HALL[0] - 0.1, 1.2, HALL[1] - 0.1);
        let middle = at + DVec3::new(0.5 * HALL[0], 0.0, 0.5 * HALL[1]);
        self.assembly.place(self.meshes.slab, [0.4, 0.4, 0.38], sized(middle - DVec3::Y * 1.15, floor));
        for side in 0..4 {
            self.wall(at, side, wall);
        }
        self.roof(at);
        self.inside(at);
    }

    /// One of four walls. Every other piece stands out a little: the pieces overlap, and no two faces lie in one plane.
    fn wall(&mut self, at: DVec3, side: i32, colour: [f32; 3]) {
        let pieces = PANELS[(side % 2) as usize];
        for piece in 0..pieces {
            let along = piece as f64 * PANEL;
            let out = 0.06 * (piece % 2) as f64;
            let place = match side {
                0 => DVec3::new(HALL[0] - along, 0.0, -out),
                1 => DVec3::new(-out, 0.0, along),
                2 => DVec3::new(along, 0.0, HALL[1] + out),
                _ => DVec3::new(HALL[0] + out, 0.0, HALL[1] - along),
            };
            let turns = [2, 3, 0, 1][side as usize];
            if piece == pieces / 2 {
                self.put(self.meshes.gate, colour, at + place, turns);
                continue;
            }
            self.put(self.meshes.wall, colour, at + place, turns);
            if self.random.chance(0.7) {
                self.put(self.meshes.windows, GLASS, at + place, turns);
            }
        }
        let corner = [DVec3::ZERO, DVec3::new(0.0, 0.0, HALL[1])];
        if side < 2 {
            let pillar = self.meshes.pillar;
            self.put(pillar, colour, at + corner[side as usize], 0);
            self.put(pillar, colour, at + corner[side as usize] + DVec3::X * HALL[0], 0);
        }
    }

    /// Pieces of a gable roof, every other one a little higher, with skylights and vents.
    fn roof(&mut self, at: DVec3) {
        for piece in 0..PANELS[0] {
            let middle = at + DVec3::new((piece as f64 + 0.5) * PANEL, WALL - 0.1, 0.5 * HALL[1]);
            let lift = DVec3::Y * 0.05 * (piece % 2) as f64;
            let roof = self.meshes.roof;
            self.put(roof, [0.36, 0.34, 0.33], middle + lift, 0);
            let vent = self.random.pick(&self.meshes.vents);
            let aside = self.random.range(-8.0, 8.0);
            // The roof rises by 3.4 m to the ridge.
            let high = 3.4 * (1.0 - aside.abs() / (0.5 * HALL[1]));
            self.put(vent, STEEL, middle + DVec3::new(0.0, high, aside), 0);
        }
        if self.random.chance(0.3) {
            let chimney = self.meshes.chimney;
            self.put(chimney, [0.5, 0.28, 0.22], at + DVec3::new(4.0, 0.0, 5.0), 0);
        }
    }
}

/// A loop around at most 3 by 3 halls in the middle of the factory, along the middle of the streets.
fn street_walk(corner: DVec3, columns: usize, rows: usize) -> Walk {
    let line = |pitch: f64, count: usize| {
        let around = count.saturating_sub(2).clamp(1, 3).min(count.saturating_sub(1).max(1));
        let first = (count - around) / 2;
        (first as f64 * pitch + 0.5 * STREET, (first + around) as f64 * pitch + 0.5 * STREET)
    };
    let ((x0, x1), (z0, z1)) = (line(PITCH[0], columns), line(PITCH[1], rows));
    let start = x1 - 60.0;
    let plan = [(start, z0), (x1, z0), (x1, z1), (x0, z1), (x0, z0), (start, z0)];
    let points = plan.map(|(x, z)| corner + DVec3::new(x, EYE, z)).to_vec();
    Walk { points, length: WALK, clearance: 1.5 }
}
