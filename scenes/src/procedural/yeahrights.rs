//! Yeahrights (YR): few objects with very many triangles each and high depth complexity, after the scene of the same name in
//! Lee et al. 2018, 4.1: copies of Keenan Crane's "Yeahright", a hollow ball of knotted tubes, above ground.
//!
//! That model is not ours to give away. Ours are tangles made by rule: closed tubes that wind through a ball and show one
//! another through their gaps. Many-layered depth of few objects: culling gains little, warping has much to do.

use super::detail::Detail;
use super::parts::Parts;
use super::random::Random;
use super::terrain::{Terrain, TILE};
use super::{camera, count, lane, posed, shade, Assembly, SceneOptions};
use crate::model::{Scene, Walk};
use glam::{DVec3, Quat, Vec3};
use std::f32::consts::TAU;

/// Objects at scale 1, the ground's tiles among them.
const OBJECTS: usize = 60;
const LEAST_OBJECTS: usize = 8;
/// Distance between tangles in metres; each has a radius of 1.
const PITCH: f64 = 2.7;
const EYE: f64 = 1.6;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 19.0;
/// Different tangles.
const SHAPES: usize = 8;

const METALS: [[f32; 3]; 6] =
    [[0.7, 0.45, 0.2], [0.55, 0.55, 0.58], [0.3, 0.5, 0.45], [0.65, 0.25, 0.2], [0.35, 0.4, 0.65], [0.75, 0.68, 0.4]];

pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let detail = Detail::new(options.detail);
    let mut random = Random::new(options.seed, 0);
    let mut assembly = Assembly::new("yeahrights");
    // A third of the places go to the way, and the ground reaches 2 m farther.
    let side = (1.5 * target as f64 + 4.0).sqrt().ceil() as usize;
    let ground_tiles = ((side as f64 * PITCH + 4.0) / TILE).ceil() as usize;
    let tangles = target - ground_tiles * ground_tiles;
    let ground = Terrain::new(&mut random, 0.5, [0.5 * side as f64 * PITCH, 0.0]);
    ground.place(&mut assembly, &mut random, detail, ground_tiles, [0.36, 0.38, 0.33]);
    let shapes: Vec<u32> = (0..SHAPES.min(tangles))
        .map(|shape| assembly.built("tangle", detail, |parts| tangle(parts, &mut random, shape)))
        .collect();
    let half = 0.5 * side as f64 * PITCH;
    let eye = DVec3::Y * EYE;
    let way = vec![DVec3::new(-0.2, 0.0, half + 0.4) + eye, DVec3::new(0.15 * half, 0.0, -half) + eye];
    let mut placed = 0;
    for place in 0.. {
        if placed == tangles {
            break;
        }
        // Rows beyond the square, if the way takes more places than were set aside.
        let (column, row) = (place % side, place / side);
        // Every other row stands in the gaps of the one before.
        let shift = 0.5 * PITCH * ((row % 2) as f64 - 0.5);
        let aside = DVec3::new(random.range(-0.25, 0.25), random.range(0.0, 1.2), random.range(-0.25, 0.25));
        let at =
            DVec3::new((column as f64 + 0.5) * PITCH - half + shift, 1.35, half - (row as f64 + 0.5) * PITCH) + aside;
        if lane::distance(&way, at) < 1.5 {
            continue;
        }
        let size = random.range(0.85, 1.15);
        let metal = random.pick(&METALS);
        let colour = shade(&mut random, metal, 0.3);
        let turn = random.range(0.0, std::f64::consts::TAU);
        assembly.place(shapes[placed % shapes.len()], colour, posed(at, turn, DVec3::splat(size)));
        placed += 1;
    }
    let walk = Walk { points: way, length: WALK, clearance: 0.3 };
    let mut scene = assembly.scene;
    scene.cameras = vec![camera("among tangles", &walk, 0.05, 200.0)];
    scene.walk = Some(walk);
    scene
}

/// Closed tubes in a ball of radius 1 around the origin: a cage of rings, and knots within it.
fn tangle(parts: &mut Parts, random: &mut Random, shape: usize) {
    let turn = |random: &mut Random| {
        let mut part = || random.range(-1.0, 1.0) as f32;
        Quat::from_xyzw(part(), part(), part(), 1.0).normalize()
    };
    for _ in 0..10 {
        let rotation = turn(random);
        let waves = 2 + random.below(4);
        let depth = random.range(0.04, 0.12) as f32;
        let ring = move |u: f32| {
            let angle = TAU * u;
            let radius = 0.86 + depth * (waves as f32 * angle).cos();
            let swing = 0.22 * ((waves + 1) as f32 * angle).sin();
            rotation * Vec3::new(radius * angle.cos(), swing, radius * angle.sin())
        };
        parts.tube(ring, [130, 12], 0.05, true);
    }
    for _ in 0..3 {
        let rotation = turn(random);
        let (p, q) = random.pick(&[(2.0f32, 3.0f32), (2.0, 5.0), (3.0, 4.0), (3.0, 5.0)]);
        let outer = random.range(0.4, 0.58) as f32;
        let knot = move |u: f32| {
            let angle = TAU * u;
            let radius = outer + 0.22 * (q * angle).cos();
            rotation * Vec3::new(radius * (p * angle).cos(), 0.3 * (q * angle).sin(), radius * (p * angle).sin())
        };
        parts.tube(knot, [260, 12], 0.045, true);
    }
    // Spikes through the gaps, another number on each.
    for spike in 0..6 + 2 * shape {
        let out = turn(random) * Vec3::Y;
        let bend = turn(random) * Vec3::X * 0.12;
        let arm = move |u: f32| out * (0.3 + 0.75 * u) + bend * (TAU * u * (1.0 + 0.3 * spike as f32)).sin() * u;
        parts.tube(arm, [40, 10], 0.03, false);
        parts.globe(arm(1.0), Vec3::splat(0.06), [8, 12], |_| 1.0);
    }
}
