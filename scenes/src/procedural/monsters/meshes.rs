//! Monsters and their huts: meshes in metres with their feet at y = 0, which look to +x.

use crate::procedural::detail::Detail;
use crate::procedural::parts::Parts;
use crate::procedural::Assembly;
use glam::{Affine3A, Vec3};

/// Indices of the meshes in a scene.
pub(super) struct Meshes {
    pub monsters: [u32; 5],
    pub hut: u32,
    pub fire: u32,
    pub totem: u32,
    pub bones: u32,
    pub palisade: u32,
}

impl Meshes {
    /// `fine` is the number of sides of what is round.
    pub(super) fn new(assembly: &mut Assembly, detail: Detail, fine: usize) -> Self {
        let mut add =
            |name: &str, build: fn(&mut Parts, usize)| assembly.built(name, detail, |parts| build(parts, fine));
        Meshes {
            monsters: [
                add("ogre", ogre),
                add("lizard", lizard),
                add("spider", spider),
                add("cyclops", cyclops),
                add("worm", worm),
            ],
            hut: add("hut", hut),
            fire: add("fire", fire),
            totem: add("totem", totem),
            bones: add("bones", bones),
            palisade: add("palisade", palisade),
        }
    }
}

fn ball(parts: &mut Parts, at: [f32; 3], radii: [f32; 3], fine: usize) {
    parts.globe(at, radii, [fine / 2 + 1, fine], |_| 1.0);
}

/// Two limbs, one a side of the middle.
fn pair(parts: &mut Parts, from: [f32; 3], to: [f32; 3], radius: f32, fine: usize) {
    for side in [-1.0, 1.0] {
        let mirrored = |[x, y, z]: [f32; 3]| [x, y, side * z];
        parts.rod(mirrored(from), mirrored(to), radius, fine);
    }
}

/// A spike from a point.
fn horn(parts: &mut Parts, at: [f32; 3], length: f32, tilt: f32) {
    let place = Affine3A::from_translation(Vec3::from(at)) * Affine3A::from_rotation_x(tilt);
    parts.moved(place, |parts| parts.lathe([0.0; 3], &[[0.0, 0.0], [0.14, 0.0], [0.0, length]], 5));
}

fn ogre(parts: &mut Parts, fine: usize) {
    pair(parts, [0.0, 0.0, 0.4], [0.0, 1.0, 0.35], 0.28, fine);
    ball(parts, [0.0, 1.6, 0.0], [0.65, 0.9, 0.8], fine);
    ball(parts, [0.25, 2.6, 0.0], [0.42, 0.42, 0.4], fine);
    pair(parts, [0.05, 2.1, 0.75], [0.35, 1.1, 1.15], 0.2, fine);
    pair(parts, [0.35, 1.1, 1.15], [1.0, 1.3, 1.0], 0.18, fine);
    horn(parts, [0.2, 2.9, 0.25], 0.5, 0.4);
    horn(parts, [0.2, 2.9, -0.25], 0.5, -0.4);
    parts.rod([1.0, 0.9, 1.0], [1.2, 2.6, 1.0], 0.16, fine);
}

fn lizard(parts: &mut Parts, fine: usize) {
    ball(parts, [0.0, 0.9, 0.0], [1.3, 0.55, 0.6], fine);
    pair(parts, [0.8, 0.9, 0.4], [0.9, 0.0, 0.7], 0.16, fine);
    pair(parts, [-0.7, 0.9, 0.4], [-0.8, 0.0, 0.7], 0.18, fine);
    parts.rod([1.0, 1.1, 0.0], [1.7, 1.7, 0.0], 0.24, fine);
    ball(parts, [1.95, 1.75, 0.0], [0.5, 0.26, 0.3], fine);
    let tail = |u: f32| Vec3::new(-1.1 - 1.6 * u, 0.9 - 0.7 * u, 0.5 * (3.0 * u).sin());
    parts.tube(tail, [4, fine], 0.18, false);
    for spine in 0..5 {
        horn(parts, [-0.9 + 0.45 * spine as f32, 1.3, 0.0], 0.5, 0.0);
    }
}

fn spider(parts: &mut Parts, fine: usize) {
    ball(parts, [-0.6, 0.9, 0.0], [0.9, 0.6, 0.75], fine);
    ball(parts, [0.5, 0.8, 0.0], [0.5, 0.4, 0.45], fine);
    for leg in 0..4 {
        let along = 0.6 - 0.4 * leg as f32;
        pair(parts, [along, 0.8, 0.3], [1.6 * along, 1.5, 1.2], 0.07, 5);
        pair(parts, [1.6 * along, 1.5, 1.2], [2.2 * along, -0.05, 1.8], 0.06, 5);
    }
    pair(parts, [0.85, 0.7, 0.15], [1.15, 0.4, 0.12], 0.06, 5);
}

fn cyclops(parts: &mut Parts, fine: usize) {
    ball(parts, [0.0, 1.3, 0.0], [0.95, 1.0, 0.95], fine + 2);
    ball(parts, [0.78, 1.6, 0.0], [0.32, 0.34, 0.34], fine);
    pair(parts, [0.0, 0.5, 0.4], [0.1, 0.0, 0.5], 0.2, fine);
    pair(parts, [0.0, 1.2, 0.85], [0.3, 0.5, 1.4], 0.13, fine);
    for horned in [-0.5, 0.5] {
        horn(parts, [0.0, 2.05, horned], 0.6, 0.8 * horned);
    }
}

fn worm(parts: &mut Parts, fine: usize) {
    let body = |u: f32| Vec3::new(2.6 * u - 1.6, 0.4 + 1.6 * u * u * u + 0.25 * (9.0 * u).sin(), 0.6 * (5.0 * u).sin());
    parts.tube(body, [10, fine + 2], 0.38, false);
    let [x, y, z] = body(1.0).to_array();
    ball(parts, [x, y, z], [0.55, 0.5, 0.5], fine);
    for spike in 1..6 {
        let [x, y, z] = body(spike as f32 / 6.0).to_array();
        horn(parts, [x, y + 0.3, z], 0.35, 0.0);
    }
}

fn hut(parts: &mut Parts, fine: usize) {
    parts.lathe([0.0, -0.4, 0.0], &[[0.0, 0.0], [2.3, 0.0], [2.2, 2.4], [0.0, 2.4]], fine + 2);
    parts.lathe([0.0; 3], &[[0.0, 2.1], [2.9, 1.7], [1.3, 3.6], [0.0, 4.4]], fine + 2);
    parts.cuboid([1.9, -0.2, -0.5], [2.4, 1.6, 0.5]);
}

fn fire(parts: &mut Parts, _: usize) {
    for stick in 0..6 {
        let angle = stick as f32 * 1.05;
        let foot = Vec3::new(0.7 * angle.cos(), 0.0, 0.7 * angle.sin());
        parts.rod(foot, Vec3::Y * (0.9 + 0.03 * stick as f32) - 0.2 * foot, 0.07, 5);
    }
    parts.lathe([0.0; 3], &[[0.0, 0.05], [0.4, 0.2], [0.25, 0.7], [0.0, 1.4]], 6);
}

fn totem(parts: &mut Parts, fine: usize) {
    parts.rod([0.0, -0.3, 0.0], [0.0, 3.4, 0.0], 0.25, fine);
    for face in 0..3 {
        let y = 0.9 + face as f32;
        parts.tapered([-0.4, y, -0.4], [0.4, y + 0.7, 0.4], 0.06, 0.06);
        parts.cuboid([0.35, y + 0.3, -0.1], [0.65, y + 0.42, 0.1]);
    }
    pair(parts, [0.0, 3.1, 0.2], [0.0, 3.5, 1.1], 0.08, 5);
}

fn bones(parts: &mut Parts, fine: usize) {
    for rib in 0..5 {
        let x = -0.8 + 0.4 * rib as f32;
        let curve = move |u: f32| Vec3::new(x, 0.75 * (3.0 * u).sin() + 0.02, 0.6 * (3.0 * u).cos());
        parts.tube(curve, [5, 5], 0.05, false);
    }
    parts.rod([-1.1, 0.75, 0.0], [1.1, 0.78, 0.0], 0.08, 5);
    ball(parts, [1.4, 0.5, 0.0], [0.4, 0.3, 0.28], fine);
}

fn palisade(parts: &mut Parts, _: usize) {
    for stake in 0..7 {
        let (x, high) = (-1.35 + 0.45 * stake as f32, 1.7 + 0.2 * (stake % 3) as f32);
        parts.lathe([x, -0.5, 0.0], &[[0.0, 0.0], [0.18, 0.0], [0.17, high], [0.0, high + 0.5]], 5);
    }
    parts.cuboid([-1.5, 0.7, -0.22], [1.5, 0.85, -0.1]);
}
