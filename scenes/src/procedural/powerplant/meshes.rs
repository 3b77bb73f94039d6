//! Meshes of the power plant, in metres. Those of the frame fill a bay from its lower corner, pipes across a bay run along +x.

use super::BAY;
use crate::procedural::detail::Detail;
use crate::procedural::parts::Parts;
use crate::procedural::random::Random;
use crate::procedural::Assembly;
use glam::{Affine3A, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Indices of the power plant's meshes.
pub(super) struct Meshes {
    pub slab: u32,
    pub column: u32,
    pub girder: u32,
    pub brace: u32,
    pub grating: u32,
    pub railing: u32,
    pub sheet: u32,
    pub tray: u32,
    pub vessel: u32,
    pub tank: u32,
    pub chimney: u32,
    pub cooling_tower: u32,
    /// Pipes across a bay.
    pub runs: [u32; 8],
    /// Pipes up and down beside a vessel.
    pub risers: [u32; 5],
    /// Pipes that bend freely within a bay.
    pub tangles: [u32; 8],
    pub machines: [u32; 4],
}

const LONG: f32 = BAY.x as f32;
const HIGH: f32 = BAY.y as f32;

impl Meshes {
    pub(super) fn new(assembly: &mut Assembly, detail: Detail) -> Self {
        let mut random = Random::new(0, 4711);
        let mut add = |name: &str, build: &mut dyn FnMut(&mut Parts)| assembly.built(name, detail, build);
        Meshes {
            slab: add("slab", &mut |parts| parts.cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5])),
            column: add("column", &mut column),
            girder: add("girder", &mut girder),
            brace: add("brace", &mut brace),
            grating: add("grating", &mut grating),
            railing: add("railing", &mut railing),
            sheet: add("cladding", &mut sheet),
            tray: add("cable tray", &mut tray),
            vessel: add("vessel", &mut vessel),
            tank: add("tank", &mut tank),
            chimney: add("chimney", &mut chimney),
            cooling_tower: add("cooling tower", &mut cooling_tower),
            runs: [0; 8].map(|_| add("pipe run", &mut |parts| run(parts, &mut random))),
            risers: [0; 5].map(|_| add("risers", &mut |parts| risers(parts, &mut random))),
            tangles: [0; 8].map(|_| add("pipes", &mut |parts| tangle(parts, &mut random))),
            machines: [
                add("pump", &mut pump),
                add("heat exchanger", &mut exchanger),
                add("valves", &mut valves),
                add("cabinet", &mut cabinet),
            ],
        }
    }
}

/// A square bar between two points.
fn bar(parts: &mut Parts, from: Vec3, to: Vec3, thickness: f32) {
    parts.rod(from, to, 0.7 * thickness, 4);
}

/// Four angles and their lacing.
fn column(parts: &mut Parts) {
    let half = 0.22;
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    for (x, z) in corners {
        parts.cuboid([x - 0.045, -0.05, z - 0.045], [x + 0.045, HIGH - 0.02, z + 0.045]);
    }
    for tier in 0..5 {
        let (low, high) = (tier as f32 / 5.0 * HIGH, (tier + 1) as f32 / 5.0 * HIGH);
        for side in 0..4 {
            let (a, b) = (corners[side], corners[(side + 1) % 4]);
            bar(parts, Vec3::new(a.0, low, a.1), Vec3::new(b.0, high, b.1), 0.03);
        }
    }
}

/// A lattice girder along x.
fn girder(parts: &mut Parts) {
    for y in [-0.5, -0.04] {
        parts.cuboid([0.0, y, -0.1], [LONG, y + 0.035, 0.1]);
        parts.cuboid([0.01, y - 0.06, -0.02], [LONG - 0.01, y + 0.06, 0.02]);
    }
    for field in 0..8 {
        let (left, right) = (field as f32 / 8.0 * LONG, (field + 1) as f32 / 8.0 * LONG);
        let (from, to) = if field % 2 == 0 { (-0.48, -0.03) } else { (-0.03, -0.48) };
        bar(parts, Vec3::new(left, from, 0.0), Vec3::new(right, to, 0.0), 0.045);
    }
}

/// Two diagonals of a bay.
fn brace(parts: &mut Parts) {
    bar(parts, Vec3::new(0.1, 0.1, 0.06), Vec3::new(LONG - 0.1, HIGH - 0.6, 0.06), 0.06);
    bar(parts, Vec3::new(0.1, HIGH - 0.6, -0.06), Vec3::new(LONG - 0.1, 0.1, -0.06), 0.06);
}

fn grating(parts: &mut Parts) {
    for slat in 0..17 {
        let z = 0.05 + slat as f32 / 17.0 * LONG;
        parts.cuboid([0.02, -0.01, z], [LONG - 0.02, 0.03, z + 0.035]);
    }
    for cross in 0..5 {
        let x = 0.1 + cross as f32 / 5.0 * LONG;
        parts.cuboid([x, -0.03, 0.03], [x + 0.03, 0.02, LONG - 0.03]);
    }
}

fn railing(parts: &mut Parts) {
    for y in [0.55, 1.05] {
        parts.rod([0.05, y, 0.0], [LONG - 0.05, y, 0.0], 0.025, 6);
    }
    for post in 0..4 {
        let x = 0.3 + 1.8 * post as f32;
        parts.rod([x, -0.02, 0.0], [x, 1.05, 0.0], 0.03, 6);
    }
}

/// Corrugated: a sheet of waves and its back.
fn sheet(parts: &mut Parts) {
    let detail = parts.detail();
    let wave = |u: f32, front: f32| 0.05 * (12.0 * TAU * u).cos() + 0.01 * front;
    parts.sheet(detail.rows(2), detail.rows(72), |u, v| Vec3::new(v * LONG, (1.0 - u) * HIGH, wave(v, 1.0)));
    parts.sheet(detail.rows(2), detail.rows(72), |u, v| {
        Vec3::new((1.0 - v) * LONG, (1.0 - u) * HIGH, wave(1.0 - v, -1.0))
    });
}

fn tray(parts: &mut Parts) {
    for z in [-0.25, 0.22] {
        parts.cuboid([0.0, 0.0, z], [LONG, 0.12, z + 0.03]);
    }
    for rung in 0..10 {
        let x = 0.1 + rung as f32 / 10.0 * LONG;
        parts.cuboid([x, 0.01, -0.24], [x + 0.04, 0.03, 0.24]);
    }
    for cable in 0..3 {
        let z = -0.15 + 0.1 * cable as f32;
        let sway = move |u: f32| Vec3::new(0.02 + u * (LONG - 0.04), 0.07, z + 0.03 * (9.0 * u + 2.0 * z).sin());
        parts.tube(sway, [6, 5], 0.035, false);
    }
}

/// A boiler's shell as high as a floor, with bands and nozzles.
fn vessel(parts: &mut Parts) {
    parts.lathe([0.0; 3], &[[0.0, -0.02], [1.9, -0.02], [1.9, HIGH + 0.01], [0.0, HIGH + 0.01]], 32);
    for band in 0..4 {
        let y = 0.5 + 1.2 * band as f32;
        parts.lathe([0.0, y, 0.0], &[[1.85, 0.0], [2.0, 0.0], [2.0, 0.16], [1.85, 0.16]], 32);
    }
    for nozzle in 0..5 {
        let angle = nozzle as f32 * 2.3;
        let out = Vec3::new(angle.cos(), 0.0, angle.sin());
        let at = Vec3::Y * (0.9 + 0.8 * nozzle as f32);
        parts.pipe(&[at + out * 1.8, at + out * 2.3, at + out * 2.3 + Vec3::Y * 0.5], 0.12, 8);
    }
}

fn tank(parts: &mut Parts) {
    let profile = [[0.0, -0.1], [4.0, -0.1], [4.0, 5.0], [3.0, 5.8], [1.5, 6.2], [0.0, 6.3]];
    parts.lathe([0.0; 3], &profile, 48);
    let stair = |u: f32| {
        let angle = 4.0 * u;
        Vec3::new(4.35 * angle.cos(), 0.2 + 5.6 * u, 4.35 * angle.sin())
    };
    parts.tube(stair, [32, 5], 0.06, false);
    parts.tube(|u| stair(u) + Vec3::Y, [32, 5], 0.04, false);
    for post in 0..16 {
        let foot = stair(post as f32 / 15.0);
        parts.rod(foot, foot + Vec3::Y, 0.03, 4);
    }
}

/// 1 high, to be scaled along y.
fn chimney(parts: &mut Parts) {
    parts.lathe([0.0; 3], &[[0.0, 0.0], [4.2, 0.0], [3.0, 0.4], [2.4, 1.0], [2.0, 1.0], [2.0, 0.96], [0.0, 0.96]], 40);
    for gallery in 0..4 {
        let y = 0.24 + 0.23 * gallery as f32;
        let radius = 4.0 - 1.4 * y;
        parts.lathe([0.0, y, 0.0], &[[1.5, 0.0], [radius, 0.0], [radius, 0.006], [1.5, 0.006]], 40);
    }
}

/// A hyperboloid of 40 m, open at the top and with a wall of half a metre.
fn cooling_tower(parts: &mut Parts) {
    let detail = parts.detail();
    let radius = |y: f32| 11.0 * (1.0 + ((y - 30.0) / 28.0).powi(2)).sqrt();
    let point = move |u: f32, v: f32, wall: f32| {
        let (y, angle) = (40.0 * (1.0 - u), TAU * if v == 1.0 { 0.0 } else { v });
        let radius = radius(y) - wall;
        Vec3::new(radius * angle.cos(), y, -radius * angle.sin())
    };
    let (rows, sides) = (detail.rows(14), detail.sides(48));
    parts.sheet(rows, sides, |u, v| point(u, v, 0.0));
    parts.sheet(rows, sides, |u, v| point(u, 1.0 - v, 0.5));
    parts.sheet(1, sides, |u, v| point(0.0, v, 0.5 * (1.0 - u)));
}

/// Two pipes side by side across a bay, each with a swing or a flange on its way.
fn run(parts: &mut Parts, random: &mut Random) {
    let mut aside = -0.5;
    for _ in 0..2 {
        let radius = random.pick(&[0.06f32, 0.09, 0.14, 0.2]);
        aside += radius + 0.06;
        let (out, at) = (0.3 * random.range(-1.0, 1.0) as f32, random.range(0.2, 0.6) as f32 * LONG);
        let point = |x: f32, y: f32| Vec3::new(x, y, aside);
        if random.chance(0.35) {
            parts.pipe(
                &[
                    point(0.0, 0.0),
                    point(at, 0.0),
                    point(at, out),
                    point(at + 1.2, out),
                    point(at + 1.2, 0.0),
                    point(LONG, 0.0),
                ],
                radius,
                10,
            );
        } else {
            parts.pipe(&[point(0.0, 0.0), point(LONG, 0.0)], radius, 8);
            parts.rod(point(at, 0.0), point(at + 0.15, 0.0), 1.5 * radius, 8);
        }
        aside += radius;
    }
    for hanger in [0.2, 0.8] {
        let x = hanger * LONG;
        parts.cuboid([x, -0.24, -0.9], [x + 0.05, -0.2, 0.9]);
    }
}

/// Pipes around a vessel from floor to floor.
fn risers(parts: &mut Parts, random: &mut Random) {
    for pipe in 0..3 {
        let angle = random.range(0.0, 1.6) as f32 + 0.2 * pipe as f32;
        let out = Vec3::new(angle.cos(), 0.0, angle.sin()) * (2.45 + 0.18 * pipe as f32);
        let bend = random.range(1.5, 3.5) as f32;
        let turned = glam::Quat::from_rotation_y(0.35) * out;
        let corners = [out, out + Vec3::Y * bend, turned + Vec3::Y * bend, turned + Vec3::Y * HIGH];
        parts.pipe(&corners, 0.09, 6);
    }
}

/// Pipes that turn at right angles through a bay, below its ceiling, about its middle.
fn tangle(parts: &mut Parts, random: &mut Random) {
    for _ in 0..2 {
        let mut corner = Vec3::new(random.range(-2.2, 2.2) as f32, 0.0, random.range(-2.2, 2.2) as f32);
        let mut corners = vec![corner];
        corner.y = random.range(0.5, 3.4) as f32;
        corners.push(corner);
        for turn in 0..2 + random.below(2) {
            let axis = [0, 2, 1][turn % 3];
            let (low, high) = if axis == 1 { (0.4, 3.6) } else { (-2.4, 2.4) };
            corner[axis] = random.range(low, high) as f32;
            corners.push(corner);
        }
        parts.pipe(&corners, random.pick(&[0.05, 0.08, 0.11, 0.16]), 6);
    }
}

/// A motor and a pump on a base, with ribs.
fn pump(parts: &mut Parts) {
    parts.cuboid([-1.1, 0.0, -0.45], [1.1, 0.2, 0.45]);
    let lying = Affine3A::from_translation(Vec3::new(0.0, 0.65, 0.0)) * Affine3A::from_rotation_z(FRAC_PI_2);
    parts.moved(lying, |parts| {
        parts.lathe(
            [0.0; 3],
            &[[0.0, -1.0], [0.35, -1.0], [0.4, -0.9], [0.4, -0.1], [0.15, 0.0], [0.15, 0.3], [0.0, 0.3]],
            12,
        );
        parts.lathe(
            [0.0, 0.3, 0.0],
            &[[0.0, 0.0], [0.3, 0.0], [0.55, 0.2], [0.55, 0.45], [0.3, 0.65], [0.0, 0.65]],
            12,
        );
        for rib in 0..4 {
            let y = -0.85 + 0.14 * rib as f32;
            parts.lathe([0.0, y, 0.0], &[[0.38, 0.0], [0.46, 0.0], [0.46, 0.03], [0.38, 0.03]], 12);
        }
    });
    parts.pipe(&[Vec3::new(-0.6, 0.8, 0.0), Vec3::new(-0.6, 1.8, 0.0), Vec3::new(-0.6, 1.8, -0.9)], 0.14, 8);
}

/// A lying drum with domed ends on saddles.
fn exchanger(parts: &mut Parts) {
    let lying = Affine3A::from_translation(Vec3::new(0.0, 1.1, 0.0)) * Affine3A::from_rotation_z(FRAC_PI_2);
    parts.moved(lying, |parts| {
        let dome = |part: f32| [0.6 * (FRAC_PI_2 * part).sin(), 0.3 * (FRAC_PI_2 * part).cos()];
        let mut profile: Vec<[f32; 2]> =
            (0..=4).map(|step| dome(step as f32 / 4.0)).map(|[r, y]| [r, -1.2 - y]).collect();
        profile.extend((0..=4).rev().map(|step| dome(step as f32 / 4.0)).map(|[r, y]| [r, 1.2 + y]));
        (profile[0][0], profile[9][0]) = (0.0, 0.0);
        parts.lathe([0.0; 3], &profile, 14);
        for flange in [-1.2, -0.4, 0.4, 1.1] {
            parts.lathe([0.0, flange, 0.0], &[[0.58, 0.0], [0.7, 0.0], [0.7, 0.1], [0.58, 0.1]], 14);
        }
    });
    for x in [-0.8, 0.6] {
        parts.tapered([x, 0.0, -0.5], [x + 0.2, 0.7, 0.5], 0.0, 0.1);
    }
}

/// A manifold with three hand wheels.
fn valves(parts: &mut Parts) {
    parts.pipe(&[Vec3::new(-1.2, 0.7, 0.0), Vec3::new(1.2, 0.7, 0.0)], 0.16, 8);
    for valve in -1..=1 {
        let x = 0.7 * valve as f32;
        parts.globe([x, 0.7, 0.0], [0.26, 0.3, 0.26], [5, 8], |_| 1.0);
        parts.rod([x, 0.0, 0.0], [x, 1.35, 0.0], 0.06, 6);
        let wheel = move |u: f32| Vec3::new(x + 0.24 * (TAU * u).cos(), 1.3, -0.24 * (TAU * u).sin());
        parts.tube(wheel, [12, 5], 0.03, true);
        for spoke in 0..2 {
            let angle = spoke as f32 * FRAC_PI_2;
            let arm = Vec3::new(0.23 * angle.cos(), 0.0, 0.23 * angle.sin());
            let hub = Vec3::new(x, 1.3, 0.0);
            parts.rod(hub - arm, hub + arm, 0.02, 5);
        }
    }
}

/// Switches behind louvred doors.
fn cabinet(parts: &mut Parts) {
    parts.cuboid([-0.9, 0.0, -0.35], [0.9, 2.0, 0.35]);
    for door in [-0.86, 0.02] {
        parts.cuboid([door, 0.1, 0.33], [door + 0.84, 1.93, 0.38]);
        for slat in 0..5 {
            let y = 0.3 + 0.16 * slat as f32;
            parts.cuboid([door + 0.1, y, 0.36], [door + 0.74, y + 0.03, 0.41]);
        }
    }
    parts.pipe(&[Vec3::new(0.5, 1.9, 0.0), Vec3::new(0.5, 2.6, 0.0), Vec3::new(1.4, 2.6, 0.0)], 0.05, 8);
}
