//! Things that stand in rooms: meshes in metres on the floor at y = 0, with their back to -z.

use super::parts::Parts;
use super::{shade, Assembly};
use crate::model::Mesh;
use crate::procedural::random::Random;
use glam::DAffine3;

/// Indices of the furniture meshes in a scene.
pub(super) struct Furniture {
    pub table: u32,
    pub chair: u32,
    pub shelf: u32,
    pub sofa: u32,
    pub bed: u32,
    pub desk: u32,
    pub plant: u32,
    pub lamp: u32,
    pub picture: u32,
    pub rug: u32,
    pub vase: u32,
}

const WOODS: [[f32; 3]; 4] = [[0.42, 0.26, 0.13], [0.55, 0.38, 0.2], [0.3, 0.18, 0.1], [0.75, 0.7, 0.62]];
const CLOTHS: [[f32; 3]; 5] =
    [[0.5, 0.12, 0.12], [0.15, 0.25, 0.5], [0.2, 0.4, 0.25], [0.6, 0.55, 0.45], [0.35, 0.2, 0.4]];

impl Furniture {
    pub(super) fn new(assembly: &mut Assembly) -> Self {
        Furniture {
            table: assembly.mesh(legged("table", [1.4, 0.74, 0.8], 0.05)),
            chair: assembly.mesh(chair()),
            shelf: assembly.mesh(shelf()),
            sofa: assembly.mesh(sofa()),
            bed: assembly.mesh(bed()),
            desk: assembly.mesh(desk()),
            plant: assembly.mesh(plant()),
            lamp: assembly.mesh(lamp()),
            picture: assembly.mesh(picture()),
            rug: assembly.mesh(rug()),
            vase: assembly.mesh(vase()),
        }
    }

    /// Places a piece in a colour that suits it.
    pub(super) fn place(&self, assembly: &mut Assembly, random: &mut Random, piece: u32, at: DAffine3) {
        let is_cloth = [self.sofa, self.bed, self.rug, self.picture].contains(&piece);
        let colour = match piece {
            _ if piece == self.plant => [0.15, 0.4, 0.15],
            _ if piece == self.lamp || piece == self.vase => [0.85, 0.8, 0.65],
            _ if is_cloth => random.pick(&CLOTHS),
            _ => random.pick(&WOODS),
        };
        let colour = shade(random, colour, 0.15);
        assembly.place(piece, colour, at);
    }
}

/// A top on four legs.
fn add_legged(parts: &mut Parts, [width, height, depth]: [f32; 3], leg: f32) {
    let (x, z) = (0.5 * width, 0.5 * depth);
    parts.cuboid([-x, height - 0.04, -z], [x, height, z]);
    for (side_x, side_z) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
        let (centre_x, centre_z) = (side_x * (x - leg), side_z * (z - leg));
        let half = 0.5 * leg;
        parts.cuboid([centre_x - half, 0.0, centre_z - half], [centre_x + half, height - 0.04, centre_z + half]);
    }
}

fn legged(name: &str, size: [f32; 3], leg: f32) -> Mesh {
    let mut parts = Parts::default();
    add_legged(&mut parts, size, leg);
    parts.mesh(name)
}

fn chair() -> Mesh {
    let mut parts = Parts::default();
    add_legged(&mut parts, [0.45, 0.46, 0.45], 0.04);
    for bar in 0..5 {
        let x = -0.19 + 0.095 * bar as f32;
        parts.cuboid([x - 0.015, 0.46, -0.22], [x + 0.015, 0.88, -0.19]);
    }
    parts.cuboid([-0.22, 0.86, -0.23], [0.22, 0.96, -0.18]);
    parts.mesh("chair")
}

fn shelf() -> Mesh {
    let mut parts = Parts::default();
    for x in [-0.5, 0.47] {
        parts.cuboid([x, 0.0, -0.15], [x + 0.03, 2.0, 0.15]);
    }
    for board in 0..6 {
        let y = 0.05 + 0.38 * board as f32;
        parts.cuboid([-0.48, y, -0.15], [0.48, y + 0.03, 0.14]);
        for book in 0..(if board < 5 { 8 } else { 0 }) {
            let x = -0.45 + 0.11 * book as f32;
            let height = 0.2 + 0.02 * ((board * 5 + book * 3) % 7) as f32;
            parts.cuboid([x, y + 0.03, -0.12], [x + 0.07, y + 0.03 + height, 0.08]);
        }
    }
    parts.mesh("shelf")
}

fn sofa() -> Mesh {
    let mut parts = Parts::default();
    parts.cuboid([-1.0, 0.1, -0.42], [1.0, 0.3, 0.42]);
    parts.tapered([-1.0, 0.3, -0.42], [1.0, 0.85, -0.2], 0.05, 0.05);
    for x in [-1.05, 0.87] {
        parts.tapered([x, 0.05, -0.43], [x + 0.18, 0.62, 0.43], 0.03, 0.03);
    }
    for x in [-0.85, 0.02] {
        parts.tapered([x, 0.3, -0.2], [x + 0.83, 0.46, 0.4], 0.04, 0.04);
        parts.tapered([x, 0.46, -0.22], [x + 0.83, 0.8, -0.05], 0.06, 0.05);
    }
    parts.mesh("sofa")
}

fn bed() -> Mesh {
    let mut parts = Parts::default();
    add_legged(&mut parts, [1.6, 0.3, 2.0], 0.08);
    parts.tapered([-0.78, 0.3, -0.95], [0.78, 0.52, 0.98], 0.03, 0.03);
    parts.cuboid([-0.82, 0.0, -1.05], [0.82, 0.95, -0.98]);
    for x in [-0.7, 0.08] {
        parts.ball([x + 0.31, 0.56, -0.7], [0.31, 0.09, 0.2], 6);
    }
    parts.mesh("bed")
}

fn desk() -> Mesh {
    let mut parts = Parts::default();
    add_legged(&mut parts, [1.4, 0.74, 0.7], 0.05);
    parts.cuboid([0.25, 0.15, -0.3], [0.62, 0.69, 0.3]);
    for drawer in 0..3 {
        let y = 0.18 + 0.17 * drawer as f32;
        parts.cuboid([0.27, y, 0.28], [0.6, y + 0.14, 0.32]);
    }
    parts.cuboid([-0.15, 0.74, -0.2], [0.15, 0.76, -0.02]);
    parts.cuboid([-0.02, 0.75, -0.13], [0.02, 0.9, -0.1]);
    parts.cuboid([-0.3, 0.86, -0.1], [0.3, 1.22, -0.07]);
    parts.cuboid([-0.25, 0.74, 0.05], [0.2, 0.76, 0.2]);
    parts.mesh("desk")
}

fn plant() -> Mesh {
    let mut parts = Parts::default();
    parts.cylinder([0.0, 0.0, 0.0], [0.14, 0.19], 0.3, 12);
    parts.cylinder([0.0, 0.25, 0.0], [0.02, 0.015], 0.6, 6);
    for (x, y, z, size) in
        [(0.0, 1.0, 0.0, 0.28), (0.18, 0.75, 0.08, 0.2), (-0.15, 0.8, 0.1, 0.2), (0.02, 0.7, -0.17, 0.18)]
    {
        parts.ball([x, y, z], [size, 0.9 * size, size], 5);
    }
    parts.mesh("plant")
}

/// Hangs from the point at its origin.
fn lamp() -> Mesh {
    let mut parts = Parts::default();
    parts.cylinder([0.0, -0.4, 0.0], [0.01, 0.01], 0.39, 5);
    parts.cylinder([0.0, -0.6, 0.0], [0.22, 0.06], 0.22, 16);
    parts.ball([0.0, -0.6, 0.0], [0.06, 0.06, 0.06], 5);
    parts.mesh("lamp")
}

/// Hangs on a wall behind its origin, 2 cm off it.
fn picture() -> Mesh {
    let mut parts = Parts::default();
    parts.cuboid([-0.36, -0.26, 0.02], [0.36, 0.26, 0.035]);
    for y in [-0.3, 0.25] {
        parts.cuboid([-0.4, y, 0.015], [0.4, y + 0.05, 0.06]);
    }
    for x in [-0.4, 0.35] {
        parts.cuboid([x, -0.27, 0.017], [x + 0.05, 0.27, 0.058]);
    }
    parts.mesh("picture")
}

fn rug() -> Mesh {
    let mut parts = Parts::default();
    parts.tapered([-1.1, -0.01, -0.8], [1.1, 0.015, 0.8], 0.03, 0.03);
    parts.mesh("rug")
}

fn vase() -> Mesh {
    let mut parts = Parts::default();
    parts.ball([0.0, 0.12, 0.0], [0.09, 0.12, 0.09], 6);
    parts.cylinder([0.0, 0.2, 0.0], [0.04, 0.06], 0.1, 12);
    parts.mesh("vase")
}
