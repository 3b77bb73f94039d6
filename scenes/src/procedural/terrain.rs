//! Hills: a height for each place, and tiles of ground that meet without gaps.

use super::detail::Detail;
use super::parts::Parts;
use super::random::Random;
use super::{shade, Assembly};
use glam::{DAffine3, DVec3, Vec3};

/// Edge of a tile in metres.
pub(super) const TILE: f64 = 32.0;
/// Cells along the edge of a tile at level of detail 1.
const CELLS: usize = 8;

/// Hills as a sum of waves, flat around the origin.
pub(super) struct Terrain {
    waves: Vec<[f64; 4]>,
    /// Radius of the plateau in the middle, and how high it lies, in metres.
    pub plateau: [f64; 2],
}

impl Terrain {
    /// Hills that rise by up to about `height` metres, with a plateau in the middle.
    pub(super) fn new(random: &mut Random, height: f64, plateau: [f64; 2]) -> Self {
        let wave = |octave: usize, random: &mut Random| {
            let wavelength = 170.0 / 1.8f64.powi(octave as i32 / 2);
            let angle = random.range(0.0, std::f64::consts::TAU);
            let frequency = std::f64::consts::TAU / wavelength;
            // Smaller waves are lower by as much as they are shorter, or a little more.
            let amplitude = 0.3 * height / 2.0f64.powi(octave as i32 / 2);
            [frequency * angle.cos(), frequency * angle.sin(), random.range(0.0, std::f64::consts::TAU), amplitude]
        };
        Terrain { waves: (0..8).map(|octave| wave(octave, random)).collect(), plateau }
    }

    /// Height of the ground in metres.
    pub(super) fn height(&self, x: f64, z: f64) -> f64 {
        let hills: f64 =
            self.waves.iter().map(|[kx, kz, phase, amplitude]| amplitude * (kx * x + kz * z + phase).sin()).sum();
        let [radius, top] = self.plateau;
        // From the plateau's edge to the hills within 60 m.
        let out = ((x.hypot(z) - radius) / 60.0).clamp(0.0, 1.0);
        let out = out * out * (3.0 - 2.0 * out);
        top + (hills - top) * out
    }

    /// Somewhere on the ground.
    pub(super) fn on(&self, x: f64, z: f64) -> DVec3 {
        DVec3::new(x, self.height(x, z), z)
    }

    /// Places `side` by `side` tiles of ground about the origin. Each is a mesh in the world's own place, so that neighbours
    /// have the same vertices along their common edge.
    pub(super) fn place(
        &self,
        assembly: &mut Assembly,
        random: &mut Random,
        detail: Detail,
        side: usize,
        grass: [f32; 3],
    ) {
        let first = -0.5 * side as f64 * TILE;
        for tile in 0..side * side {
            let corner = [first + (tile % side) as f64 * TILE, first + (tile / side) as f64 * TILE];
            let mesh = assembly.built("ground", detail, |parts| self.tile(parts, detail, corner));
            let colour = shade(random, grass, 0.12);
            assembly.place(mesh, colour, DAffine3::IDENTITY);
        }
    }

    fn tile(&self, parts: &mut Parts, detail: Detail, [x, z]: [f64; 2]) {
        let cells = detail.rows(CELLS);
        parts.sheet(cells, cells, |u, v| {
            let (x, z) = (x + TILE * f64::from(v), z + TILE * f64::from(u));
            Vec3::new(x as f32, self.height(x, z) as f32, z as f32)
        });
    }
}
