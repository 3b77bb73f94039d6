//! What grows and lies about: meshes in metres with their root at y = 0.

use super::detail::Detail;
use super::parts::Parts;
use super::random::Random;
use super::Assembly;
use glam::Vec3;

/// Indices of the meshes of plants and stones in a scene.
pub(super) struct Nature {
    /// Trees 6 to 9 m high.
    pub trees: [u32; 4],
    /// Stones about 2 m across.
    pub stones: [u32; 3],
    /// 1 m high.
    pub mushroom: u32,
    /// 1.2 m across.
    pub bush: u32,
    /// 2.5 m high.
    pub crystal: u32,
}

pub(super) const LEAVES: [[f32; 3]; 4] = [[0.16, 0.36, 0.12], [0.24, 0.42, 0.14], [0.1, 0.28, 0.16], [0.45, 0.38, 0.1]];
pub(super) const STONE: [[f32; 3]; 3] = [[0.42, 0.4, 0.38], [0.35, 0.36, 0.4], [0.5, 0.45, 0.38]];
pub(super) const CAPS: [[f32; 3]; 3] = [[0.62, 0.12, 0.1], [0.7, 0.5, 0.2], [0.4, 0.2, 0.5]];
pub(super) const GLASS: [[f32; 3]; 3] = [[0.3, 0.7, 0.75], [0.6, 0.3, 0.75], [0.3, 0.75, 0.45]];

impl Nature {
    /// `fine` is the number of sides of what is round at level of detail 1: few for a game, more for a picture.
    pub(super) fn new(assembly: &mut Assembly, detail: Detail, fine: usize) -> Self {
        let mut chance = Random::new(0, 77);
        Nature {
            trees: [
                assembly.built("oak", detail, |parts| broad(parts, &mut chance, fine, 8)),
                assembly.built("beech", detail, |parts| broad(parts, &mut chance, fine, 6)),
                assembly.built("fir", detail, |parts| conifer(parts, fine, 5)),
                assembly.built("spruce", detail, |parts| conifer(parts, fine, 7)),
            ],
            stones: [0, 1, 2].map(|_| assembly.built("stone", detail, |parts| stone(parts, &mut chance, fine))),
            mushroom: assembly.built("mushroom", detail, |parts| mushroom(parts, fine)),
            bush: assembly.built("bush", detail, |parts| bush(parts, &mut chance, fine)),
            crystal: assembly.built("crystal", detail, |parts| crystal(parts, &mut chance)),
        }
    }
}

/// A radius that swells and sinks with the direction, between about 1 - `depth` and 1 + `depth`.
pub(super) fn lumps(random: &mut Random, depth: f32) -> impl Fn(Vec3) -> f32 {
    let mut wave = |pitch: f64| {
        let mut part = || random.range(-pitch, pitch) as f32;
        (Vec3::new(part(), part(), part()), part())
    };
    let waves = [wave(2.0), wave(3.0), wave(5.0), wave(8.0)];
    move |direction| {
        let bumps = waves.iter().enumerate();
        1.0 + bumps
            .map(|(order, (pitch, phase))| depth / (order + 2) as f32 * (pitch.dot(direction) + phase).sin())
            .sum::<f32>()
    }
}

fn broad(parts: &mut Parts, random: &mut Random, fine: usize, boughs: usize) {
    parts.lathe([0.0, -0.3, 0.0], &[[0.0, 0.0], [0.45, 0.0], [0.28, 1.0], [0.22, 4.0], [0.0, 4.0]], fine);
    for bough in 0..boughs {
        let angle = bough as f32 * 2.4;
        let out = Vec3::new(angle.cos(), 0.0, angle.sin()) * if bough == 0 { 0.0 } else { 1.3 };
        let middle = out + Vec3::Y * (5.4 - 0.25 * bough as f32);
        parts.rod([0.0, 2.4, 0.0], middle, 0.1, fine / 2);
        let size = random.range(1.1, 1.7) as f32;
        parts.globe(middle, Vec3::new(1.1, 0.85, 1.1) * size, [fine / 2, fine], lumps(random, 0.25));
    }
}

fn conifer(parts: &mut Parts, fine: usize, tiers: usize) {
    parts.lathe([0.0, -0.3, 0.0], &[[0.0, 0.0], [0.3, 0.0], [0.22, 1.6], [0.0, 1.6]], fine);
    for tier in 0..tiers {
        let part = tier as f32 / tiers as f32;
        let (radius, y) = (2.2 * (1.0 - 0.8 * part), 1.0 + 7.0 * part);
        parts.lathe([0.0, y, 0.0], &[[0.0, 0.25], [radius, 0.0], [0.4 * radius, 0.9], [0.0, 2.2]], fine);
    }
}

fn stone(parts: &mut Parts, random: &mut Random, fine: usize) {
    parts.globe([0.0, 0.3, 0.0], [1.1, 0.8, 0.9], [fine / 2 + 1, fine], lumps(random, 0.4));
}

fn mushroom(parts: &mut Parts, fine: usize) {
    parts.lathe([0.0, -0.1, 0.0], &[[0.0, 0.0], [0.18, 0.0], [0.11, 0.4], [0.12, 0.7], [0.0, 0.7]], fine);
    parts.lathe([0.0; 3], &[[0.0, 0.64], [0.5, 0.52], [0.55, 0.6], [0.4, 0.88], [0.2, 1.0], [0.0, 1.03]], fine);
}

fn bush(parts: &mut Parts, random: &mut Random, fine: usize) {
    for part in 0..3 {
        let angle = part as f32 * 2.1;
        let middle = Vec3::new(0.3 * angle.cos(), 0.35, 0.3 * angle.sin());
        parts.globe(middle, [0.45, 0.45, 0.45], [fine / 2, fine], lumps(random, 0.3));
    }
}

fn crystal(parts: &mut Parts, random: &mut Random) {
    for spike in 0..6 {
        let angle = spike as f32 * 1.05;
        let lean = if spike == 0 { 0.0 } else { 0.5 };
        let height = random.range(0.8, if spike == 0 { 2.5 } else { 1.6 }) as f32;
        let tilt = glam::Affine3A::from_rotation_y(angle) * glam::Affine3A::from_rotation_z(lean);
        parts.moved(tilt, |parts| {
            parts.lathe([0.0, -0.3, 0.0], &[[0.0, 0.0], [0.22, 0.0], [0.26, 0.8 * height], [0.0, height]], 6);
        });
    }
}
