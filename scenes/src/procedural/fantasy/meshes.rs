//! Meshes of the town in metres. Houses, walls and what hangs on them look to +z.

use super::HOUSE;
use crate::procedural::detail::Detail;
use crate::procedural::parts::Parts;
use crate::procedural::Assembly;
use glam::{Affine3A, Vec3};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Indices of the town's meshes.
pub(super) struct Meshes {
    /// Of one and of two storeys.
    pub bodies: [u32; 2],
    pub roof: u32,
    pub chimney: u32,
    pub door: u32,
    pub window: u32,
    pub lantern: u32,
    /// Barrels, carts and the like.
    pub props: [u32; 4],
    pub well: u32,
    pub wall: u32,
    pub gate: u32,
    pub tower: u32,
    pub spire: u32,
    pub flag: u32,
    pub hall: u32,
}

/// Height of the walls of houses of one and two storeys.
pub(super) const HOUSE_HIGH: [f64; 2] = [3.0, 5.7];
/// From the middle of a house to its front.
pub(super) const HOUSE_DEEP: f64 = 4.0;
/// Length of a piece of the town wall.
pub(super) const WALL_LONG: f64 = 12.0;
/// Height of a tower, and of a roof on it.
pub(super) const TOWER_HIGH: f64 = 11.0;
pub(super) const SPIRE_HIGH: f64 = 9.0;

impl Meshes {
    /// `fine` is the number of sides of what is round.
    pub(super) fn new(assembly: &mut Assembly, detail: Detail, fine: usize) -> Self {
        let mut add =
            |name: &str, build: fn(&mut Parts, usize)| assembly.built(name, detail, |parts| build(parts, fine));
        Meshes {
            bodies: [add("house", |parts, _| body(parts, 1)), add("high house", |parts, _| body(parts, 2))],
            roof: add("roof", |parts, _| roof(parts)),
            chimney: add("chimney", |parts, _| chimney(parts)),
            door: add("door", |parts, _| door(parts)),
            window: add("window", |parts, _| window(parts)),
            lantern: add("lantern", lantern),
            props: [add("barrel", barrel), add("cart", cart), add("bench", |parts, _| bench(parts)), add("pots", pots)],
            well: add("well", well),
            wall: add("town wall", |parts, _| wall(parts, false)),
            gate: add("town gate", |parts, _| wall(parts, true)),
            tower: add("tower", tower),
            spire: add("spire", spire),
            flag: add("flag", |parts, _| flag(parts)),
            hall: add("hall", |parts, _| hall(parts)),
        }
    }
}

/// Plaster between timbers; upper storeys stand out over the lane.
fn body(parts: &mut Parts, storeys: usize) {
    let (half, deep) = (0.5 * HOUSE as f32, HOUSE_DEEP as f32);
    parts.cuboid([-half, -0.3, -deep], [half, HOUSE_HIGH[storeys - 1] as f32, deep]);
    parts.tapered([-half - 0.05, -0.3, -deep - 0.1], [half + 0.05, 0.6, deep + 0.12], 0.0, 0.06);
    for storey in 0..storeys {
        let (low, high) = (0.5 + 2.7 * storey as f32, 3.0 + 2.7 * storey as f32);
        for face in [-deep, deep] {
            for post in 0..5 {
                let x = -half + 0.02 + (HOUSE as f32 - 0.24) * post as f32 / 4.0;
                parts.cuboid([x, low, face - 0.07], [x + 0.2, high - 0.1, face + 0.07]);
            }
            for y in [low, high - 0.2] {
                parts.cuboid([-half - 0.02, y, face - 0.09], [half + 0.02, y + 0.2, face + 0.09]);
            }
            for (foot, top) in [(-3.3, -2.0), (3.3, 2.0)] {
                parts.rod([foot, low + 0.1, face], [top, high - 0.2, face], 0.08, 4);
            }
        }
    }
}

/// A gable with its ridge along x, covered by rows of tiles.
fn roof(parts: &mut Parts) {
    let (half, deep, high) = (0.5 * HOUSE as f32 + 0.25, HOUSE_DEEP as f32 + 0.5, 3.2);
    parts.gable([-half, 0.0, -deep], [half, high, deep]);
    for row in 0..9 {
        let (part, next) = (row as f32 / 9.0, (row + 1) as f32 / 9.0);
        for side in [-1.0, 1.0] {
            let (from, to) = (side * deep * (1.0 - part), side * deep * (1.0 - next));
            let near = from.min(to);
            parts.tapered(
                [-half - 0.05, high * part - 0.1, near],
                [half + 0.05, high * part + 0.32, near + (to - from).abs()],
                0.02,
                0.05,
            );
        }
    }
    parts.rod([-half - 0.1, high + 0.05, 0.0], [half + 0.1, high + 0.05, 0.0], 0.16, 8);
}

fn chimney(parts: &mut Parts) {
    for course in 0..6 {
        let (y, out) = (0.45 * course as f32, 0.02 * (course % 2) as f32);
        parts.cuboid([-0.4 - out, y - 0.01, -0.35 - out], [0.4 + out, y + 0.45, 0.35 + out]);
    }
    parts.tapered([-0.5, 2.6, -0.45], [0.5, 2.9, 0.45], 0.1, 0.1);
    parts.lathe([0.0, 2.85, 0.0], &[[0.0, 0.0], [0.2, 0.0], [0.15, 0.4], [0.0, 0.4]], 10);
}

fn door(parts: &mut Parts) {
    for board in 0..5 {
        let x = -0.5 + 0.2 * board as f32;
        parts.cuboid([x, 0.0, -0.05], [x + 0.19, 2.0, 0.06]);
    }
    for (x, y) in [(-0.64, 0.0), (0.5, 0.0)] {
        parts.cuboid([x, y, -0.05], [x + 0.14, 2.2, 0.14]);
    }
    parts.cuboid([-0.7, 2.02, -0.05], [0.7, 2.2, 0.17]);
    let ring = |u: f32| Vec3::new(0.3 + 0.09 * (TAU * u).cos(), 1.0 + 0.09 * (TAU * u).sin(), 0.1);
    parts.tube(ring, [12, 6], 0.02, true);
    parts.cuboid([-0.75, -0.2, -0.05], [0.75, 0.03, 0.5]);
}

fn window(parts: &mut Parts) {
    parts.cuboid([-0.4, 0.0, -0.05], [0.4, 1.1, 0.04]);
    for bar in 0..3 {
        let x = -0.25 + 0.25 * bar as f32;
        parts.cuboid([x - 0.015, 0.0, -0.02], [x + 0.015, 1.1, 0.07]);
        parts.cuboid([-0.4, 0.27 + 0.27 * bar as f32, -0.02], [0.4, 0.3 + 0.27 * bar as f32, 0.065]);
    }
    for x in [-0.85, 0.45] {
        for board in 0..2 {
            let x = x + 0.21 * board as f32;
            parts.cuboid([x, -0.05, 0.0], [x + 0.2, 1.15, 0.1]);
        }
    }
    parts.cuboid([-0.6, -0.2, -0.05], [0.6, -0.06, 0.3]);
    parts.cuboid([-0.55, 1.12, -0.05], [0.55, 1.24, 0.13]);
}

fn lantern(parts: &mut Parts, fine: usize) {
    parts.rod([0.0, 0.5, -0.05], [0.0, 0.5, 0.5], 0.03, 6);
    parts.rod([0.0, 0.1, 0.0], [0.0, 0.5, 0.4], 0.02, 6);
    parts.lathe([0.0, 0.0, 0.5], &[[0.0, 0.0], [0.12, 0.02], [0.16, 0.32], [0.2, 0.34], [0.0, 0.5]], fine);
}

fn barrel(parts: &mut Parts, fine: usize) {
    let profile = [
        [0.0, 0.0],
        [0.32, 0.0],
        [0.38, 0.25],
        [0.4, 0.5],
        [0.38, 0.75],
        [0.32, 1.0],
        [0.28, 1.0],
        [0.28, 0.95],
        [0.0, 0.95],
    ];
    parts.lathe([0.0; 3], &profile, fine + 3);
    for (y, radius) in [(0.12, 0.37), (0.34, 0.41), (0.62, 0.41), (0.84, 0.37)] {
        parts.lathe([0.0, y, 0.0], &[[0.3, 0.0], [radius, 0.0], [radius, 0.06], [0.3, 0.06]], fine + 3);
    }
}

fn wheel(parts: &mut Parts, at: [f32; 3], fine: usize) {
    let middle = Vec3::from(at);
    let rim = move |u: f32| middle + Vec3::new(0.4 * (TAU * u).cos(), 0.4 * (TAU * u).sin(), 0.0);
    parts.tube(rim, [2 * fine, 6], 0.05, true);
    for spoke in 0..4 {
        let angle = spoke as f32 * FRAC_PI_2 * 0.5;
        let arm = Vec3::new(0.4 * angle.cos(), 0.4 * angle.sin(), 0.0);
        parts.rod(middle - arm, middle + arm, 0.03, 5);
    }
}

/// Its shafts point to +x.
fn cart(parts: &mut Parts, fine: usize) {
    for board in 0..4 {
        let z = -0.36 + 0.18 * board as f32;
        parts.cuboid([-0.8, 0.5, z], [0.6, 0.55, z + 0.17]);
    }
    for z in [-0.4, 0.34] {
        parts.tapered([-0.85, 0.53, z], [0.65, 0.9, z + 0.06], 0.0, 0.0);
        parts.rod([0.5, 0.5, z + 0.03], [1.3, 0.35, z + 0.03], 0.04, 6);
    }
    wheel(parts, [-0.1, 0.43, -0.48], fine);
    wheel(parts, [-0.1, 0.43, 0.46], fine);
    parts.globe([-0.1, 0.75, 0.0], [0.5, 0.3, 0.28], [6, fine], |direction| 1.0 + 0.1 * (9.0 * direction.x).sin());
}

fn bench(parts: &mut Parts) {
    for board in 0..3 {
        let z = -0.2 + 0.14 * board as f32;
        parts.cuboid([-0.9, 0.45, z], [0.9, 0.5, z + 0.12]);
    }
    for x in [-0.75, 0.65] {
        parts.tapered([x, 0.0, -0.2], [x + 0.1, 0.46, 0.2], 0.0, 0.03);
    }
    parts.cuboid([-0.9, 0.75, -0.28], [0.9, 0.95, -0.22]);
    for x in [-0.7, 0.62] {
        parts.cuboid([x, 0.3, -0.27], [x + 0.08, 0.9, -0.21]);
    }
}

fn pots(parts: &mut Parts, fine: usize) {
    for (x, z, size) in [(-0.4, 0.0, 1.0f32), (0.15, 0.1, 0.75), (0.55, -0.1, 0.9)] {
        let profile = [[0.0, 0.0], [0.16, 0.0], [0.26, 0.25], [0.24, 0.42], [0.14, 0.55], [0.18, 0.62], [0.0, 0.5]];
        parts.lathe([x, 0.0, z], &profile.map(|[radius, y]| [radius * size, y * size]), fine);
    }
}

fn well(parts: &mut Parts, fine: usize) {
    parts.lathe([0.0; 3], &[[0.0, -0.2], [1.0, -0.2], [1.0, 0.9], [0.75, 0.9], [0.7, 0.3], [0.0, 0.3]], 2 * fine);
    for x in [-0.9, 0.9] {
        parts.rod([x, 0.7, 0.0], [x, 2.4, 0.0], 0.08, 8);
    }
    parts.rod([-1.0, 1.7, 0.0], [1.0, 1.7, 0.0], 0.1, 10);
    parts.gable([-1.3, 2.3, -0.9], [1.3, 3.2, 0.9]);
    parts.rod([0.0, 0.8, 0.0], [0.0, 1.7, 0.0], 0.02, 5);
    parts.lathe([0.0, 0.6, 0.0], &[[0.0, 0.0], [0.16, 0.0], [0.2, 0.3], [0.0, 0.28]], fine);
}

/// A piece of wall with courses of stones and merlons; the gate has doors below an arch.
fn wall(parts: &mut Parts, is_gate: bool) {
    let half = 0.5 * WALL_LONG as f32;
    for course in 0..8 {
        let (y, out) = (0.9 * course as f32, 0.04 * (course % 2) as f32);
        parts.cuboid([-half, y - 0.02, -0.9 - out], [half, y + 0.9, 0.9 + out]);
    }
    parts.cuboid([-half, 7.1, -1.25], [half, 7.5, 1.25]);
    for merlon in 0..6 {
        let x = -half + 0.35 + 2.0 * merlon as f32;
        parts.tapered([x, 7.4, 0.7], [x + 1.2, 8.6, 1.2], 0.05, 0.05);
        parts.tapered([x + 0.8, 7.4, -1.2], [x + 1.6, 8.0, -0.8], 0.03, 0.03);
    }
    if is_gate {
        for board in 0..8 {
            let x = -2.0 + 0.5 * board as f32;
            parts.cuboid([x, 0.2, -1.1], [x + 0.46, 4.4, 1.1]);
        }
        for side in [-2.4, 2.05] {
            parts.cuboid([side, 0.0, -1.3], [side + 0.35, 4.8, 1.3]);
        }
        parts.cuboid([-2.5, 4.5, -1.35], [2.5, 5.2, 1.35]);
    }
}

/// Round, with a battlement on corbels.
fn tower(parts: &mut Parts, fine: usize) {
    let high = TOWER_HIGH as f32;
    let sides = 2 * fine;
    parts.lathe(
        [0.0; 3],
        &[[0.0, 0.0], [3.6, 0.0], [3.1, 1.2], [3.0, high - 1.6], [3.6, high - 1.0], [3.6, high], [0.0, high]],
        sides,
    );
    for merlon in 0..10 {
        let angle = merlon as f32 / 10.0 * TAU;
        let place = Affine3A::from_rotation_y(angle) * Affine3A::from_translation(Vec3::new(0.0, high - 0.1, 3.35));
        parts.moved(place, |parts| parts.cuboid([-0.6, 0.0, -0.25], [0.6, 1.0, 0.3]));
    }
    for slit in 0..6 {
        let place = Affine3A::from_rotation_y(slit as f32 * 1.9)
            * Affine3A::from_translation(Vec3::new(0.0, 2.0 + 1.1 * slit as f32, 2.98));
        parts.moved(place, |parts| parts.tapered([-0.2, 0.0, -0.1], [0.2, 1.1, 0.12], 0.05, 0.0));
    }
}

/// A pointed roof on a tower.
fn spire(parts: &mut Parts, fine: usize) {
    let high = SPIRE_HIGH as f32;
    parts.lathe(
        [0.0; 3],
        &[[0.0, -0.2], [2.9, -0.2], [2.9, 0.4], [3.3, 0.3], [1.4, 0.5 * high], [0.0, high]],
        2 * fine,
    );
    parts.globe([0.0, high, 0.0], [0.2, 0.2, 0.2], [6, fine], |_| 1.0);
}

fn flag(parts: &mut Parts) {
    parts.rod([0.0, -0.3, 0.0], [0.0, 3.0, 0.0], 0.05, 6);
    let detail = parts.detail();
    let cloth = |u: f32, v: f32, thick: f32| {
        let x = 0.05 + 2.0 * v;
        Vec3::new(x, 2.9 - u * (1.2 - 0.3 * v), 0.15 * v * (7.0 * v).sin() + thick)
    };
    parts.sheet(detail.rows(4), detail.rows(12), |u, v| cloth(u, v, 0.01));
    parts.sheet(detail.rows(4), detail.rows(12), |u, v| cloth(u, 1.0 - v, -0.01));
}

/// The castle's hall, on four sides of a tower.
fn hall(parts: &mut Parts) {
    parts.cuboid([-8.0, 0.0, -6.5], [8.0, 9.0, 6.5]);
    parts.gable([-8.3, 8.8, -7.0], [8.3, 13.0, 7.0]);
    parts.tapered([-8.3, 0.0, -6.8], [8.3, 1.5, 6.8], 0.2, 0.2);
    for buttress in 0..7 {
        let x = -6.0 + 2.0 * buttress as f32;
        for z in [-6.9, 6.3] {
            parts.tapered([x - 0.3, 0.0, z], [x + 0.3, 8.0, z + 0.6], 0.05, 0.05);
        }
    }
}
