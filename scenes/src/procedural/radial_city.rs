//! Radial city (RC): a city of towers on rings and spokes, after the scene of the same name in the EOVC thesis, IV and table 1:
//! 73,812 objects of 1,272,764 triangles, "low polygons with a city-like scene, but has large and tall buildings, which are
//! visible from afar".
//!
//! The streets are rings about the centre and twelve spokes. Low houses hide one another from the street; over them stand the
//! towers, highest in the middle. +y is up, the roads are at y = 0.

use super::detail::Detail;
use super::random::Random;
use super::{camera, count, posed, shade, Assembly, SceneOptions};
use crate::model::{Scene, Walk};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Objects at scale 1.
const OBJECTS: usize = 73_812;
const LEAST_OBJECTS: usize = 120;
/// About how many objects a lot has; decides how wide the city is for its count.
const OBJECTS_A_LOT: f64 = 16.0;
/// A lot in metres: along the ring, and outward.
const LOT: [f64; 2] = [30.0, 34.0];
/// Width of the ring roads and spokes.
const ROAD: f64 = 12.0;
const SPOKES: usize = 12;
/// Radius of the innermost ring's lots.
const INNERMOST: f64 = 90.0;
const EYE: f64 = 1.7;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 140.0;

const WALLS: [[f32; 3]; 7] = [
    [0.55, 0.53, 0.5],
    [0.62, 0.48, 0.38],
    [0.4, 0.45, 0.52],
    [0.66, 0.62, 0.52],
    [0.35, 0.38, 0.4],
    [0.5, 0.36, 0.3],
    [0.48, 0.55, 0.58],
];
const CARS: [[f32; 3]; 5] = [[0.5, 0.1, 0.1], [0.12, 0.2, 0.4], [0.7, 0.7, 0.7], [0.1, 0.1, 0.1], [0.5, 0.42, 0.15]];

struct Meshes {
    ground: u32,
    pavement: u32,
    block: u32,
    slab: u32,
    tower: u32,
    crown: u32,
    tree: u32,
    lamp: u32,
    car: u32,
}

/// A lot: its middle, the direction that its street looks to, and how far out it is.
struct Lot {
    middle: DVec3,
    angle: f64,
    out: f64,
}

struct Builder {
    assembly: Assembly,
    meshes: Meshes,
    random: Random,
}

pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let mut assembly = Assembly::new("radial-city");
    let meshes = meshes(&mut assembly, Detail::new(options.detail));
    let rings = rings(target as f64 / OBJECTS_A_LOT);
    let edge = radius(rings);
    assembly.scene.objects.reserve(target + 64);
    let size = DVec3::new(edge + 150.0, 1.0, edge + 150.0);
    assembly.place(meshes.ground, [0.27, 0.28, 0.27], posed(DVec3::ZERO, 0.0, size));
    let mut builder = Builder { assembly, meshes, random: Random::new(options.seed, 0) };
    builder.monument();
    let mut ring = 0;
    while builder.assembly.len() < target {
        builder.random = Random::new(options.seed, 1 + ring as u64);
        for lot in lots(ring) {
            builder.lot(&lot);
        }
        ring += 1;
    }
    let spoke = Random::new(options.seed, u64::MAX).below(SPOKES);
    let walk = Walk { points: spoke_walk(spoke, edge), length: WALK, clearance: 1.2 };
    builder.assembly.cut_off(target);
    let mut scene = builder.assembly.scene;
    scene.cameras = vec![camera("spoke", &walk, 0.1, 4.0 * edge + 600.0)];
    scene.walk = Some(walk);
    scene
}

/// Along the middle of a spoke, towards the centre. A spoke is straight: who comes from afar comes down along it and through no
/// tower.
fn spoke_walk(spoke: usize, edge: f64) -> Vec<DVec3> {
    let angle = spoke as f64 * TAU / SPOKES as f64;
    let at = |out: f64| DVec3::new(out * angle.cos(), EYE, -out * angle.sin());
    vec![at(0.7 * edge), at(0.5 * INNERMOST)]
}

/// Radius of the middles of a ring's lots.
fn radius(ring: usize) -> f64 {
    INNERMOST + ring as f64 * (LOT[1] + ROAD)
}

/// How many lots go around a ring between its spokes.
fn lots_between_spokes(ring: usize) -> usize {
    let arc = TAU * radius(ring) / SPOKES as f64 - ROAD;
    ((arc / LOT[0]) as usize).max(1)
}

/// Rings until there is room for so many lots; one at least.
fn rings(lots: f64) -> usize {
    let mut room = 0.0;
    (0..)
        .find(|&ring| {
            room += (lots_between_spokes(ring) * SPOKES) as f64;
            room >= lots
        })
        .unwrap_or(0)
        + 1
}

/// All lots of a ring.
fn lots(ring: usize) -> impl Iterator<Item = Lot> {
    let (out, between) = (radius(ring), lots_between_spokes(ring));
    let sector = TAU / SPOKES as f64;
    (0..SPOKES * between).map(move |lot| {
        let within = ROAD / out + (lot % between) as f64 * LOT[0] / out + 0.5 * LOT[0] / out;
        // Lots stand in the middle of their sector.
        let slack = sector - ROAD / out - between as f64 * LOT[0] / out;
        let angle = (lot / between) as f64 * sector + within + 0.5 * slack - 0.5 * ROAD / out;
        Lot { middle: DVec3::new(angle.cos(), 0.0, -angle.sin()) * out, angle: angle + FRAC_PI_2, out }
    })
}

impl Builder {
    /// Places a mesh of unit size on a lot: `at` is along the ring, up and outward from its middle.
    fn put(&mut self, lot: &Lot, mesh: u32, colour: [f32; 3], at: DVec3, size: DVec3) {
        let colour = shade(&mut self.random, colour, 0.2);
        let place = lot.middle + glam::DMat3::from_rotation_y(lot.angle) * at;
        self.assembly.place(mesh, colour, posed(place, lot.angle, size));
    }

    /// What the spokes look at.
    fn monument(&mut self) {
        let square = Lot { middle: DVec3::ZERO, angle: 0.4, out: 0.0 };
        let (tower, crown) = (self.meshes.tower, self.meshes.crown);
        self.put(&square, tower, [0.6, 0.58, 0.5], DVec3::ZERO, DVec3::new(16.0, 9.0, 16.0));
        self.put(&square, tower, [0.64, 0.62, 0.55], DVec3::Y * 8.7, DVec3::new(7.0, 60.0, 7.0));
        self.put(&square, crown, [0.7, 0.6, 0.3], DVec3::Y * 68.4, DVec3::new(6.0, 26.0, 6.0));
    }

    fn lot(&mut self, lot: &Lot) {
        let pavement = self.meshes.pavement;
        self.put(lot, pavement, [0.42, 0.42, 0.4], DVec3::Y * 0.1, DVec3::new(LOT[0], 1.0, LOT[1]));
        if self.random.chance(0.05) {
            self.park(lot);
        } else {
            self.building(lot);
        }
        self.street(lot);
    }

    fn park(&mut self, lot: &Lot) {
        for _ in 0..10 {
            self.tree(lot, 11.0);
        }
    }

    fn tree(&mut self, lot: &Lot, reach: f64) {
        let at = DVec3::new(self.random.range(-reach, reach), 0.05, self.random.range(-reach, reach));
        let size = DVec3::splat(self.random.range(0.7, 1.3));
        let mesh = self.meshes.tree;
        self.put(lot, mesh, [0.17, 0.34, 0.14], at, size);
    }

    /// How high a house is: towers in the middle, some of them anywhere.
    fn height(&mut self, out: f64) -> f64 {
        let middle = 190.0 * (-out / 320.0).exp() * self.random.unit();
        let tower = if self.random.chance(0.05) { self.random.range(60.0, 190.0) } else { 0.0 };
        self.random.range(12.0, 30.0) + middle.max(tower)
    }

    /// A podium and storeys that step back, a crown or what stands on flat roofs.
    fn building(&mut self, lot: &Lot) {
        let (high, wall) = (self.height(lot.out), self.random.pick(&WALLS));
        let mut size = DVec3::new(self.random.range(23.0, 26.0), 0.0, self.random.range(25.0, 29.0));
        let mut foot = 0.05;
        let steps = 2 + self.random.below(2) + usize::from(high > 70.0);
        for step in 0..steps {
            size.y = if step == 0 { (0.25 * high).min(12.0) } else { (high - foot) / (steps - step) as f64 };
            let mesh = self.random.pick(&[self.meshes.block, self.meshes.slab, self.meshes.tower]);
            self.put(lot, mesh, wall, DVec3::Y * foot, size);
            // A tower is narrower at its top.
            let [x, z] = if mesh == self.meshes.tower { [0.479, 0.469] } else { [0.5, 0.5] };
            self.assembly.solid([-x, 0.0, -z], [x, 1.0, z]);
            // Into the storeys below, so that no two faces lie in one plane.
            foot += size.y - 0.15;
            let narrower = self.random.range(0.6, 0.88);
            size.x *= narrower;
            size.z *= self.random.range(0.6, 0.88);
        }
        let block = self.meshes.block;
        if high > 60.0 && self.random.chance(0.5) {
            let crown = self.meshes.crown;
            let size = DVec3::new(0.8 * size.x, 0.12 * high, 0.8 * size.z);
            self.put(lot, crown, wall, DVec3::Y * foot, size);
        } else {
            for side in [-0.25, 0.2] {
                let unit = DVec3::new(2.5, self.random.range(1.5, 3.5), 2.0);
                self.put(lot, block, [0.5, 0.5, 0.5], DVec3::new(side * size.x, foot, side * size.z), unit);
            }
        }
        for front in [-1.0, 1.0] {
            let at = DVec3::new(self.random.range(-6.0, 6.0), 0.04, front * 0.5 * LOT[1] * 0.84);
            self.put(lot, block, [0.3, 0.28, 0.26], at, DVec3::new(4.0, 3.4, 3.0));
        }
    }

    /// Trees, lamps and cars along the ring roads at both sides of a lot.
    fn street(&mut self, lot: &Lot) {
        let kerb = 0.5 * LOT[1] - 0.7;
        for side in [-1.0, 1.0] {
            let lamp = self.meshes.lamp;
            let at = DVec3::new(side * 13.0, 0.0, side * kerb);
            self.put(lot, lamp, [0.3, 0.3, 0.32], at, DVec3::ONE);
            let tree = self.meshes.tree;
            let at = DVec3::new(side * 4.0 + self.random.range(-3.0, 3.0), 0.0, side * kerb);
            self.put(lot, tree, [0.2, 0.36, 0.15], at, DVec3::splat(0.6));
            for place in [-8.0, 3.0] {
                if self.random.chance(0.6) {
                    let (car, paint) = (self.meshes.car, self.random.pick(&CARS));
                    let at = DVec3::new(place + self.random.range(0.0, 4.0), 0.0, side * (0.5 * LOT[1] + 1.6));
                    self.put(lot, car, paint, at, DVec3::ONE);
                }
            }
        }
    }
}

/// Meshes of unit size, but for trees, lamps and cars, which are in metres.
fn meshes(assembly: &mut Assembly, detail: Detail) -> Meshes {
    Meshes {
        ground: assembly.built("ground", detail, |parts| {
            parts.lathe([0.0; 3], &[[0.0, -1.0], [1.0, -1.0], [0.99, -0.02], [0.0, -0.02]], 64);
        }),
        pavement: assembly.built("pavement", detail, |parts| {
            parts.tapered([-0.5, -1.0, -0.5], [0.5, 0.0, 0.5], 0.003, 0.003);
        }),
        block: assembly.built("block", detail, |parts| parts.cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5])),
        slab: assembly.built("ledged block", detail, |parts| {
            parts.cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5]);
            parts.cuboid([-0.515, 0.93, -0.512], [0.515, 0.97, 0.512]);
        }),
        tower: assembly.built("tower", detail, |parts| parts.tapered([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5], 0.02, 0.03)),
        crown: assembly.built("crown", detail, |parts| {
            parts.tapered([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5], 0.46, 0.46);
        }),
        tree: assembly.built("tree", detail, |parts| {
            parts.lathe([0.0; 3], &[[0.25, 0.0], [0.2, 2.6]], 4);
            parts.lathe([0.0; 3], &[[0.0, 2.4], [2.1, 3.4], [0.0, 8.5]], 6);
        }),
        lamp: assembly.built("lamp", detail, |parts| {
            parts.lathe([0.0; 3], &[[0.09, 0.0], [0.06, 5.5]], 3);
            parts.cuboid([-0.1, 5.4, -0.6], [0.1, 5.55, 0.6]);
        }),
        car: assembly.built("car", detail, |parts| {
            parts.tapered([-2.1, 0.25, -0.85], [2.1, 0.8, 0.85], 0.05, 0.05);
            parts.tapered([-1.7, 0.78, -0.78], [1.0, 1.4, 0.78], 0.35, 0.12);
        }),
    }
}
