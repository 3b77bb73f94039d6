//! Fantasy (FN): a walled town around a castle, above woods, after the scene of the same name in the EOVC thesis, IV and
//! table 1: 7,437 objects of 17,879,189 triangles, "a small number of objects, but [it] consists of objects with high complexity
//! and high polygon count".
//!
//! Level of detail 2 has about the thesis' triangles. From the woods everything is in sight; the camera's last place is in a
//! lane between houses that hide nearly all.

mod meshes;

use super::detail::Detail;
use super::nature::{Nature, CAPS, GLASS, LEAVES, STONE};
use super::random::Random;
use super::terrain::{Terrain, TILE};
use super::{camera, count, lane, posed, shade, Assembly, SceneOptions};
use crate::model::{Scene, Walk};
use glam::{DMat3, DVec3};
use meshes::Meshes;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Objects at scale 1.
const OBJECTS: usize = 7_437;
const LEAST_OBJECTS: usize = 80;
/// Ground for an object, in square metres.
const ROOM: f64 = 31.0;
/// Radius of the town wall at scale 1, and the least, in metres.
const TOWN: f64 = 98.0;
const LEAST_TOWN: f64 = 50.0;
/// How high the town lies above the woods, in metres.
const PLATEAU: f64 = 10.0;
/// Radius of the innermost lane, and the distance of lanes, in metres.
const LANE: f64 = 28.0;
const LANES_APART: f64 = 24.0;
/// From the middle of a lane to that of the houses along it, in metres.
const TO_HOUSES: f64 = 7.5;
/// Width of a house in metres; the meshes are made for it.
pub(super) const HOUSE: f64 = 7.0;
const EYE: f64 = 1.7;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 75.0;
/// Sides of what is round, at level of detail 1.
const FINE: usize = 15;

const PLASTER: [[f32; 3]; 4] = [[0.72, 0.66, 0.54], [0.66, 0.56, 0.44], [0.6, 0.6, 0.56], [0.7, 0.6, 0.5]];
const ROOFS: [[f32; 3]; 4] = [[0.5, 0.2, 0.14], [0.36, 0.24, 0.2], [0.24, 0.28, 0.36], [0.45, 0.3, 0.14]];
const WOOD: [[f32; 3]; 3] = [[0.34, 0.22, 0.12], [0.42, 0.3, 0.18], [0.26, 0.18, 0.12]];
const CLOTH: [[f32; 3]; 4] = [[0.6, 0.12, 0.14], [0.14, 0.24, 0.55], [0.65, 0.52, 0.14], [0.2, 0.4, 0.2]];
const WALLS: [f32; 3] = [0.5, 0.48, 0.45];

struct Builder {
    assembly: Assembly,
    meshes: Meshes,
    nature: Nature,
    random: Random,
    terrain: Terrain,
    /// Radius of the town wall.
    town: f64,
    /// Half the edge of the land.
    half: f64,
}

pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let detail = Detail::new(options.detail);
    let mut random = Random::new(options.seed, 0);
    let town = (TOWN * options.scale.sqrt()).max(LEAST_TOWN);
    let least = ((town + 70.0) / TILE).ceil();
    let tiles =
        2 * (0.5 * (target as f64 * ROOM).sqrt() / TILE).ceil().max(if target < 400 { 1.0 } else { least }) as usize;
    let terrain = Terrain::new(&mut random, 14.0, [town + 8.0, PLATEAU]);
    let mut assembly = Assembly::new("fantasy");
    let meshes = Meshes::new(&mut assembly, detail, FINE);
    let nature = Nature::new(&mut assembly, detail, FINE);
    terrain.place(&mut assembly, &mut random, detail, tiles, [0.3, 0.38, 0.18]);
    let half = 0.5 * tiles as f64 * TILE;
    let mut builder = Builder { assembly, meshes, nature, random, terrain, town, half };
    builder.keep();
    builder.town_wall();
    for lane in 0..builder.lanes() {
        builder.lane(lane);
    }
    while builder.assembly.len() < target {
        builder.wood();
    }
    let walk = builder.walk();
    let mut scene = builder.assembly.scene;
    scene.objects.truncate(target);
    scene.cameras = vec![camera("lane", &walk, 0.1, 4.0 * half + 300.0)];
    scene.walk = Some(walk);
    scene
}

/// A place in the town: its direction from the middle, and how far out.
#[derive(Clone, Copy)]
struct Spot {
    angle: f64,
    out: f64,
    /// +z of what stands there looks outward, else inward.
    outward: bool,
}

impl Builder {
    fn lanes(&self) -> usize {
        ((self.town - 12.0 - TO_HOUSES - LANE) / LANES_APART) as usize + 1
    }

    /// Places a mesh at an offset from a spot, in the spot's own directions.
    fn put(&mut self, mesh: u32, palette: &[[f32; 3]], spot: Spot, at: DVec3, size: DVec3) {
        let turn = spot.angle + if spot.outward { FRAC_PI_2 } else { -FRAC_PI_2 };
        let middle = DVec3::new(spot.angle.cos(), 0.0, -spot.angle.sin()) * spot.out + DVec3::Y * PLATEAU;
        let colour = self.random.pick(palette);
        let colour = shade(&mut self.random, colour, 0.25);
        self.assembly.place(mesh, colour, posed(middle + DMat3::from_rotation_y(turn) * at, turn, size));
    }

    /// The castle in the middle: a great tower among smaller ones.
    fn keep(&mut self) {
        let middle = Spot { angle: 0.3, out: 0.0, outward: true };
        let (tower, roof, flag, hall) = (self.meshes.tower, self.meshes.spire, self.meshes.flag, self.meshes.hall);
        self.put(hall, &[WALLS], middle, DVec3::Y * -0.3, DVec3::new(1.0, 1.0, 1.0));
        for (number, (x, z, wide, high)) in [
            (0.0, 0.0, 1.5, 2.8),
            (-7.5, -6.0, 0.9, 1.7),
            (7.5, -6.0, 0.8, 2.1),
            (-7.5, 6.0, 0.8, 1.9),
            (7.5, 6.0, 0.9, 1.5),
        ]
        .into_iter()
        .enumerate()
        {
            let at = DVec3::new(x, -0.4 - 0.03 * number as f64, z);
            self.put(tower, &[WALLS], middle, at, DVec3::new(wide, high, wide));
            let top = at + DVec3::Y * meshes::TOWER_HIGH * high;
            self.put(roof, &ROOFS[2..3], middle, top, DVec3::splat(wide));
            self.put(flag, &CLOTH, middle, top + DVec3::Y * meshes::SPIRE_HIGH * wide, DVec3::ONE);
        }
    }

    /// Pieces of wall with merlons between round towers.
    fn town_wall(&mut self) {
        let pieces = (TAU * self.town / meshes::WALL_LONG).round() as usize;
        for piece in 0..pieces {
            let angle = piece as f64 / pieces as f64 * TAU;
            // Every other piece is a little thicker, so that no faces lie in one plane where they meet.
            let thick = 1.0 + 0.04 * (piece % 2) as f64;
            let spot = Spot { angle, out: self.town, outward: true };
            let wall = if piece % 16 == 8 { self.meshes.gate } else { self.meshes.wall };
            self.put(wall, &[WALLS], spot, DVec3::Y * -0.5, DVec3::new(1.05, thick, thick));
            if piece % 4 == 2 {
                let spot = Spot { angle: (piece as f64 + 0.5) / pieces as f64 * TAU, ..spot };
                let (tower, roof, flag) = (self.meshes.tower, self.meshes.spire, self.meshes.flag);
                self.put(tower, &[WALLS], spot, DVec3::Y * -0.6, DVec3::new(0.75, 1.25, 0.75));
                let top = DVec3::Y * (1.25 * meshes::TOWER_HIGH - 0.6);
                self.put(roof, &ROOFS[..1], spot, top, DVec3::splat(0.75));
                self.put(flag, &CLOTH, spot, top + DVec3::Y * 0.75 * meshes::SPIRE_HIGH, DVec3::ONE);
            }
        }
    }

    /// Two rows of houses along a lane, with gaps for the ways between lanes, and what stands in it.
    fn lane(&mut self, lane: usize) {
        let middle = LANE + LANES_APART * lane as f64;
        for (out, outward) in [(middle - TO_HOUSES, true), (middle + TO_HOUSES, false)] {
            let houses = (TAU * out / (HOUSE + 0.15)) as usize;
            for house in 0..houses {
                let spot = Spot { angle: house as f64 / houses as f64 * TAU, out, outward };
                if house % 14 == 5 {
                    let well = self.meshes.well;
                    self.put(well, &STONE, spot, DVec3::Y * -0.05, DVec3::ONE);
                } else {
                    self.house(spot);
                }
            }
        }
    }

    fn house(&mut self, spot: Spot) {
        let storeys = 1 + self.random.below(2);
        let (body, high) = (self.meshes.bodies[storeys - 1], meshes::HOUSE_HIGH[storeys - 1]);
        // Neighbours differ in depth: their fronts lie in different planes.
        let deep = self.random.range(0.92, 1.08);
        self.put(body, &PLASTER, spot, DVec3::Y * -0.3, DVec3::new(1.0, 1.0, deep));
        let (roof, chimney) = (self.meshes.roof, self.meshes.chimney);
        let steep = self.random.range(0.85, 1.35);
        self.put(roof, &ROOFS, spot, DVec3::Y * (high - 0.4), DVec3::new(1.0, steep, deep * 1.04));
        let aside = self.random.range(-2.0, 2.0);
        self.put(chimney, &STONE, spot, DVec3::new(aside, high + 0.5, -1.4), DVec3::ONE);
        let front = meshes::HOUSE_DEEP * deep;
        let (door, window, lantern) = (self.meshes.door, self.meshes.window, self.meshes.lantern);
        self.put(door, &WOOD, spot, DVec3::new(-1.6, -0.05, front), DVec3::ONE);
        self.put(lantern, &[[0.75, 0.65, 0.3]], spot, DVec3::new(-0.7, 2.2, front), DVec3::ONE);
        for storey in 0..storeys {
            for x in [0.6, 2.2] {
                let y = 1.0 + 2.7 * storey as f64;
                self.put(window, &WOOD, spot, DVec3::new(x, y, front), DVec3::ONE);
            }
        }
        if self.random.chance(0.8) {
            let prop = self.random.pick(&self.meshes.props);
            let place = DVec3::new(self.random.range(-0.4, 2.6), -0.03, front + 0.75);
            let size = self.random.range(0.85, 1.1);
            self.put(prop, &WOOD, spot, place, DVec3::splat(size));
        }
    }

    /// Something that grows outside of the walls.
    fn wood(&mut self) {
        let most = self.half - 3.0;
        let (x, z) = (self.random.range(-most, most), self.random.range(-most, most));
        // In a small land the town takes all of it: then plants stand close to the edge of the land.
        let free = (self.town + 9.0).min(most);
        if x.hypot(z) < free {
            return;
        }
        let size = self.random.range(0.7, 1.5);
        let (mesh, palette): (u32, &[[f32; 3]]) = match self.random.below(12) {
            0 => (self.nature.mushroom, &CAPS),
            1 => (self.nature.crystal, &GLASS),
            2 => (self.nature.bush, &LEAVES),
            3 => (self.random.pick(&self.nature.stones), &STONE),
            _ => (self.random.pick(&self.nature.trees), &LEAVES),
        };
        let colour = self.random.pick(palette);
        let colour = shade(&mut self.random, colour, 0.3);
        let angle = self.random.range(0.0, TAU);
        let at = self.terrain.on(x, z) - DVec3::Y * 0.1 * size;
        self.assembly.place(mesh, colour, posed(at, angle, DVec3::splat(size)));
    }

    /// Once around a lane.
    fn walk(&self) -> Walk {
        let lane = LANE + LANES_APART * ((self.lanes() - 1) / 2) as f64;
        Walk { points: lane::ring(DVec3::ZERO, lane, 1.2, |_| PLATEAU + EYE), length: WALK, clearance: 1.0 }
    }
}
