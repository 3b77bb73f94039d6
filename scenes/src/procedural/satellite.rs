//! Satellite (ST): satellites among stones, after the scene of the same name in the EOVC thesis, IV and table 1: 120,000
//! objects of 807,172,000 triangles, "varying sizes and high complexity", and "many unoccluded spaces".
//!
//! Level of detail 4 has about the thesis' triangles. Stones of all sizes, most of them small, fill a disc about the origin;
//! satellites with dishes and wings hang between them. Seen from outside nearly every object is in the open; the camera's last
//! place is behind large stones.

use super::detail::Detail;
use super::lane;
use super::nature::lumps;
use super::parts::Parts;
use super::random::Random;
use super::{camera, count, shade, Assembly, SceneOptions};
use crate::model::{Scene, Walk};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec3};
use std::f32::consts::FRAC_PI_2;
use std::f64::consts::TAU;

/// Objects at scale 1.
const OBJECTS: usize = 120_000;
const LEAST_OBJECTS: usize = 60;
/// Room an object has on average, as the edge of a cube in metres.
const PITCH: f64 = 11.0;
/// Radius of the largest stones in metres.
const LARGEST: f64 = 24.0;
/// The disc's height over its radius.
const FLATNESS: f64 = 0.22;
/// One object in so many belongs to a satellite.
const STONES_A_SATELLITE: usize = 24;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 110.0;
/// From the way to the nearest surface, in metres.
const CLEARANCE: f64 = 2.0;

const ROCK: [[f32; 3]; 5] =
    [[0.42, 0.38, 0.34], [0.34, 0.32, 0.33], [0.5, 0.42, 0.34], [0.3, 0.34, 0.38], [0.46, 0.36, 0.3]];
const BODY: [[f32; 3]; 3] = [[0.75, 0.62, 0.25], [0.7, 0.7, 0.72], [0.5, 0.52, 0.55]];

struct Meshes {
    stones: Vec<u32>,
    bodies: [u32; 2],
    wing: u32,
    dish: u32,
    mast: u32,
}

pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let detail = Detail::new(options.detail);
    let mut random = Random::new(options.seed, 0);
    let mut assembly = Assembly::new("satellite");
    let meshes = meshes(&mut assembly, detail, &mut random);
    // A cylinder of as much room as the objects need.
    let radius = (target as f64 * PITCH.powi(3) / (TAU * FLATNESS)).cbrt();
    let start = random.range(0.0, TAU);
    let way = lane::ring(DVec3::ZERO, 0.45 * radius, start, |at| 0.15 * FLATNESS * at.x);
    assembly.scene.objects.reserve(target + 8);
    let approach = lane::approach(&way, 2.0 * radius);
    curtain(&mut assembly, &meshes, &mut random, &way);
    while assembly.len() < target {
        let size = size(&mut random);
        let at = place(&mut random, radius);
        let away = lane::distance(&way, at).min(lane::distance(&approach, at));
        if random.below(STONES_A_SATELLITE) == 0 {
            if away > 9.0 + CLEARANCE {
                satellite(&mut assembly, &meshes, &mut random, at);
            }
        } else if away > 1.8 * size + CLEARANCE {
            let rock = random.pick(&ROCK);
            let colour = shade(&mut random, rock, 0.4);
            let stretch = DVec3::new(1.0, random.range(0.6, 1.0), random.range(0.7, 1.1));
            let matrix3 = turn(&mut random) * DMat3::from_diagonal(stretch * size);
            let mesh = random.pick(&meshes.stones);
            assembly.place(mesh, colour, DAffine3 { matrix3, translation: at });
        }
    }
    let mut scene = assembly.scene;
    scene.objects.truncate(target);
    let walk = Walk { points: way, length: WALK, clearance: 0.5 * CLEARANCE };
    scene.cameras = vec![camera("among stones", &walk, 0.2, 8.0 * radius + 200.0)];
    scene.walk = Some(walk);
    scene
}

/// Large stones ahead of the camera's place, beyond the bend of the way: what they hide is most of the disc.
fn curtain(assembly: &mut Assembly, meshes: &Meshes, random: &mut Random, way: &[DVec3]) {
    let ahead = (way[1] - way[0]).normalize_or(DVec3::X);
    let aside = ahead.cross(DVec3::Y);
    for stone in 0..60 {
        let far = LARGEST * (1.2 + 0.1 * f64::from(stone));
        let at = way[0] + ahead * far + (aside * random.range(-0.6, 0.6) + DVec3::Y * random.range(-0.3, 0.3)) * far;
        let size = LARGEST * random.range(0.3, 0.9);
        if lane::distance(way, at) > 1.8 * size + CLEARANCE {
            let colour = shade(random, ROCK[1], 0.4);
            let place = DAffine3 { matrix3: turn(random) * size, translation: at };
            assembly.place(random.pick(&meshes.stones), colour, place);
        }
    }
}

/// Radius of a stone in metres: as in belts of stones, a tenth of the size is some hundred times as frequent.
fn size(random: &mut Random) -> f64 {
    const LEAST: f64 = 0.8;
    const POWER: f64 = 2.3;
    let (low, high) = (LEAST.powf(-POWER), LARGEST.powf(-POWER));
    random.range(high, low).powf(-1.0 / POWER)
}

/// Somewhere in the disc, thicker in its middle.
fn place(random: &mut Random, radius: f64) -> DVec3 {
    let (angle, out) = (random.range(0.0, TAU), random.unit().sqrt());
    let high = (random.range(-1.0, 1.0) + random.range(-1.0, 1.0)) * FLATNESS * radius;
    DVec3::new(out * radius * angle.cos(), high, out * radius * angle.sin())
}

fn turn(random: &mut Random) -> DMat3 {
    let mut angle = || random.range(0.0, TAU);
    DMat3::from_rotation_y(angle()) * DMat3::from_rotation_x(angle()) * DMat3::from_rotation_z(angle())
}

/// A body, two wings, a dish and a mast: five objects that are turned together.
fn satellite(assembly: &mut Assembly, meshes: &Meshes, random: &mut Random, at: DVec3) {
    let (matrix3, metal) = (turn(random) * random.range(0.7, 1.3), random.pick(&BODY));
    let mut add = |mesh: u32, colour: [f32; 3], half_turn: f64| {
        let colour = shade(random, colour, 0.2);
        let matrix3 = matrix3 * DMat3::from_rotation_y(half_turn);
        assembly.place(mesh, colour, DAffine3 { matrix3, translation: at });
    };
    let body = meshes.bodies[usize::from(metal == BODY[0])];
    add(body, metal, 0.0);
    add(meshes.wing, [0.08, 0.12, 0.3], 0.0);
    add(meshes.wing, [0.08, 0.12, 0.3], 0.5 * TAU);
    add(meshes.dish, [0.8, 0.8, 0.78], 0.0);
    add(meshes.mast, [0.6, 0.6, 0.6], 0.0);
}

fn meshes(assembly: &mut Assembly, detail: Detail, random: &mut Random) -> Meshes {
    let mut shape = |depth: f32| {
        let swell = lumps(random, depth);
        assembly.built("stone", detail, |parts| parts.globe([0.0; 3], [1.0; 3], [7, 8], swell))
    };
    Meshes {
        stones: (0..12).map(|stone| shape(0.25 + 0.03 * stone as f32)).collect(),
        bodies: [
            assembly.built("satellite", detail, |parts| {
                parts.tapered([-1.0, -1.2, -1.0], [1.0, 1.2, 1.0], 0.1, 0.1);
                parts.lathe([0.0, 1.15, 0.0], &[[0.0, 0.0], [0.8, 0.0], [0.5, 0.5], [0.0, 0.5]], 10);
            }),
            assembly.built("probe", detail, |parts| {
                parts.lathe([0.0; 3], &[[0.0, -1.5], [0.6, -1.5], [1.0, -0.9], [1.0, 1.1], [0.0, 1.3]], 8);
            }),
        ],
        wing: assembly.built("wing", detail, wing),
        dish: assembly.built("dish", detail, dish),
        mast: assembly.built("mast", detail, mast),
    }
}

/// Four solar panels on an arm along +x.
fn wing(parts: &mut Parts) {
    parts.rod([0.7, 0.0, 0.0], [7.5, 0.0, 0.0], 0.06, 5);
    for panel in 0..4 {
        let x = 1.6 + 1.5 * panel as f32;
        parts.cuboid([x, -0.04, -1.3], [x + 1.4, 0.03, 1.3]);
    }
}

/// A bowl that looks to +z, and what stands in its focus.
fn dish(parts: &mut Parts) {
    let forward = Affine3A::from_translation(Vec3::new(0.0, 0.2, 0.9)) * Affine3A::from_rotation_x(FRAC_PI_2);
    parts.moved(forward, |parts| {
        let bowl = [[0.0, 0.0], [0.5, 0.1], [1.0, 0.4], [1.4, 0.9], [0.9, 0.45], [0.0, 0.12]];
        parts.lathe([0.0; 3], &bowl, 10);
        parts.rod([0.0, 0.1, 0.0], [0.0, 1.2, 0.0], 0.04, 4);
    });
}

/// Antennas below the body.
fn mast(parts: &mut Parts) {
    parts.rod([0.0, -1.0, 0.0], [0.0, -4.0, 0.0], 0.05, 4);
    for bar in 0..3 {
        let (y, half) = (-2.2 - 0.6 * bar as f32, 0.9 - 0.2 * bar as f32);
        parts.rod([-half, y, 0.0], [half, y, 0.0], 0.03, 4);
    }
}
