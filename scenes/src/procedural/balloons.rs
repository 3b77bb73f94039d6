//! Balloons (BL): hot-air balloons with baskets in open air, after the scene of the same name in Kim 2015, V (25,000 objects;
//! dynamic with 2,900 balloons) and in Lee et al. 2018, 4.1 (about 35,000 objects).
//!
//! A balloon and its basket are two objects. Balloons hide most of those behind them, and tiny baskets show through the gaps
//! over the whole depth of the swarm. A line through all of it meets some eight balloons; there is no ground. Kim's dynamic scene has 5,800 objects:
//! `moving-balloons` at scale 0.166.

use super::detail::Detail;
use super::lane;
use super::parts::Parts;
use super::random::Random;
use super::{camera, count, shade, turned, Assembly, SceneOptions};
use crate::animation::{Motion, Orbit};
use crate::model::{Scene, Walk};
use glam::DVec3;
use std::f64::consts::TAU;

/// Objects at scale 1: 17,500 balloons with a basket each.
const OBJECTS: usize = 35_000;
const LEAST_OBJECTS: usize = 24;
/// Room that each balloon has to itself, in metres, whatever its motion.
const CELL: DVec3 = DVec3::new(23.0, 25.0, 23.0);
/// Farthest from the middle of a balloon with its basket to its surface, in metres.
const REACH: f64 = 10.0;
/// Farthest from its cell's middle, at rest and by motion.
const JITTER: DVec3 = DVec3::new(2.8, 1.2, 2.8);
const DRIFT: f64 = 1.0;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 390.0;
/// From the way to the nearest balloon.
const CLEARANCE: f64 = 2.0;

const CLOTHS: [[f32; 3]; 9] = [
    [0.75, 0.1, 0.1],
    [0.85, 0.45, 0.05],
    [0.85, 0.75, 0.1],
    [0.15, 0.5, 0.2],
    [0.1, 0.35, 0.7],
    [0.35, 0.15, 0.6],
    [0.8, 0.3, 0.5],
    [0.1, 0.6, 0.65],
    [0.85, 0.82, 0.75],
];
const WICKER: [f32; 3] = [0.42, 0.27, 0.12];

pub(super) fn make_still(options: &SceneOptions) -> Scene {
    make(options, "balloons")
}

/// The same balloons at time 0, each of which circles, turns and bobs with its basket.
pub(super) fn make_moving(options: &SceneOptions) -> Scene {
    let mut scene = make(options, "moving-balloons");
    let mut random = Random::new(options.seed, 1);
    let mut orbits = Vec::with_capacity(scene.objects.len());
    for pair in 0..scene.objects.len().div_ceil(2) {
        let middle = scene.objects[2 * pair].world_from_object.translation;
        let angle = random.range(0.0, TAU);
        let orbit = Orbit {
            object: 0,
            base: scene.objects[2 * pair].world_from_object,
            centre: middle + DVec3::new(angle.cos(), 0.0, angle.sin()) * DRIFT,
            axis: DVec3::Y,
            radians_per_s: random.pick(&[-1.0, 1.0]) * TAU / random.range(12.0, 40.0),
            bob: DVec3::Y * random.range(0.3, 1.0) * DRIFT,
            bob_period_s: random.range(5.0, 15.0),
        };
        let end = (2 * pair + 2).min(scene.objects.len());
        for index in 2 * pair..end {
            let object = &mut scene.objects[index];
            object.dynamic = true;
            orbits.push(Orbit { object: index as u32, base: object.world_from_object, ..orbit });
        }
    }
    scene.motion = Motion::Orbits(orbits);
    scene
}

fn make(options: &SceneOptions, name: &str) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let balloons = target.div_ceil(2);
    let mut random = Random::new(options.seed, 0);
    let mut assembly = Assembly::new(name);
    let detail = Detail::new(options.detail);
    let envelopes = [[6.0, 1.0], [5.4, 1.25], [6.6, 0.9]]
        .map(|[radius, slender]| assembly.built("balloon", detail, |parts| envelope(parts, radius, slender)));
    let baskets = [1.0, 1.3].map(|width| assembly.built("basket", detail, |parts| basket(parts, width)));
    let swarm = Swarm::of(balloons);
    let way = swarm.way();
    let mut wanted = balloons;
    let cells = swarm.free_cells(&way, &mut random);
    for (index, cell) in cells.iter().enumerate() {
        // Exactly as many as wanted, each cell with the same chance.
        if random.below(cells.len() - index) >= wanted {
            continue;
        }
        wanted -= 1;
        let at = *cell;
        let turn = turned(at, random.range(0.0, TAU));
        let cloth = random.pick(&CLOTHS);
        let shape = random.pick(&envelopes);
        let colour = shade(&mut random, cloth, 0.25);
        assembly.place(shape, colour, turn);
        let colour = shade(&mut random, WICKER, 0.4);
        assembly.place(random.pick(&baskets), colour, turn);
    }
    let mut scene = assembly.scene;
    scene.objects.truncate(target);
    let walk = Walk { points: way, length: WALK, clearance: 0.5 * CLEARANCE };
    scene.cameras = vec![camera("among balloons", &walk, 0.2, 4000.0)];
    scene.walk = Some(walk);
    scene
}

/// Cells for balloons about the origin, with some to spare.
struct Swarm {
    layers: usize,
    side: usize,
}

impl Swarm {
    fn of(balloons: usize) -> Self {
        // A sixth of the cells stay empty, and some more for the way.
        let cells = 1.2 * balloons as f64 + 20.0;
        let layers = ((cells / 12.0).cbrt().round() as usize).max(2);
        Swarm { layers, side: (cells / layers as f64).sqrt().ceil() as usize + 1 }
    }

    /// Straight from a little within one side, aslant to the rows, until there are still balloons ahead.
    fn way(&self) -> Vec<DVec3> {
        let half = 0.5 * self.side as f64 * CELL.z;
        vec![DVec3::new(-0.1 * half, 0.0, 0.75 * half), DVec3::new(0.1 * half, 4.0, -0.3 * half)]
    }

    /// Middles of balloons that leave the way and the approach to it free.
    fn free_cells(&self, way: &[DVec3], random: &mut Random) -> Vec<DVec3> {
        let mut free = Vec::new();
        let approach = lane::approach(way, self.side as f64 * CELL.x);
        let middle = 0.5 * DVec3::new(self.side as f64, self.layers as f64, self.side as f64);
        for row in 0..self.side {
            // Rows do not stand behind one another, nor columns of a row beside one another: no gap goes through the swarm.
            let aside = random.unit();
            for column in 0..self.side {
                let up = random.unit();
                for layer in 0..self.layers {
                    let place = DVec3::new(column as f64 + aside, layer as f64 + up, row as f64 + 0.5);
                    let mut part = || random.range(-1.0, 1.0);
                    let jitter = JITTER * DVec3::new(part(), part(), part());
                    let at = (place - middle) * CELL + jitter;
                    let away = lane::distance(way, at).min(lane::distance(&approach, at));
                    if away > REACH + 2.0 * DRIFT + CLEARANCE {
                        free.push(at);
                    }
                }
            }
        }
        free
    }
}

/// The cloth of a balloon with its middle above the origin: a ball that narrows to the mouth, 5 m above the lowest point.
fn envelope(parts: &mut Parts, radius: f32, slender: f32) {
    let rows = 12;
    let outline = move |u: f32| {
        // From the crown to the mouth: a half circle, drawn out below.
        let angle = u * 2.75;
        let below = (u - 0.5).max(0.0);
        [radius * angle.sin() * (1.0 - 0.35 * below), radius * slender * angle.cos() - 3.0 * below * below]
    };
    let (sides, rows) = (18, rows);
    let gores = 9.0;
    let detail = parts.detail();
    parts.sheet(detail.rows(rows), detail.sides(sides), |u, v| {
        let [around, y] = outline(u);
        let around = if u == 0.0 { 0.0 } else { around };
        let angle = f64::from(if v == 1.0 { 0.0 } else { v }) * TAU;
        // Between its ropes the cloth bulges, but not at its mouth, where the skirt is sewn on.
        let bulge = 1.0 + 0.03 * (1.0 - u) * (gores * angle).sin().abs() as f32;
        glam::Vec3::new(angle.cos() as f32 * around * bulge, 2.0 + y, -angle.sin() as f32 * around * bulge)
    });
    // The skirt, its mouth closed from within.
    let [mouth, y] = outline(1.0);
    parts.lathe([0.0, 2.0 + y, 0.0], &[[0.0, 0.3], [0.8 * mouth, -0.9], [mouth, 0.0]], sides);
}

/// A basket on four ropes, some 10 m below the middle of the cloth.
fn basket(parts: &mut Parts, width: f32) {
    let half = 0.5 * width;
    parts.tapered([-half, -9.6, -half], [half, -8.6, half], -0.08, -0.08);
    for z in [-half - 0.1, half + 0.02] {
        parts.cuboid([-half - 0.1, -8.66, z], [half + 0.1, -8.54, z + 0.08]);
    }
    for (x, z) in [(-half, -half), (half, -half), (-half, half), (half, half)] {
        parts.rod([x, -8.7, z], [1.6 * x, -5.5, 1.6 * z], 0.04, 5);
    }
    parts.lathe([0.0, -7.6, 0.0], &[[0.0, 0.0], [0.2, 0.0], [0.12, 0.5], [0.0, 0.5]], 8);
}
