//! Meshes of the factory in metres. Walls and racks run along +x for one piece from their origin; walls look to +z.

use super::{PANEL, WALL};
use crate::procedural::detail::Detail;
use crate::procedural::parts::Parts;
use crate::procedural::Assembly;
use glam::{Affine3A, Vec3};
use std::f32::consts::FRAC_PI_2;

/// Indices of the factory's meshes.
pub(super) struct Meshes {
    pub slab: u32,
    pub wall: u32,
    pub windows: u32,
    pub gate: u32,
    pub pillar: u32,
    pub roof: u32,
    pub vents: [u32; 2],
    pub chimney: u32,
    pub tank: u32,
    pub truck: u32,
    pub lamp_post: u32,
    pub support: u32,
    pub rack_pipes: [u32; 3],
    pub bridge: u32,
    pub barrel: u32,
    pub pallet: u32,
    pub crate_box: u32,
    pub machines: [u32; 4],
    pub conveyor: u32,
    pub cabinet: u32,
    pub drop_pipe: u32,
    pub loads: [u32; 2],
    pub shelf: u32,
    pub column: u32,
    pub truss: u32,
    pub lamp: u32,
    pub crane: u32,
}

const LONG: f32 = PANEL as f32;
const HIGH: f32 = WALL as f32;

impl Meshes {
    pub(super) fn new(assembly: &mut Assembly, detail: Detail) -> Self {
        let mut add = |name: &str, build: fn(&mut Parts)| assembly.built(name, detail, build);
        Meshes {
            slab: add("slab", |parts| parts.cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5])),
            wall: add("wall", wall),
            windows: add("windows", windows),
            gate: add("gate", gate),
            pillar: add("pillar", |parts| parts.cuboid([-0.45, -0.5, -0.45], [0.45, HIGH + 0.4, 0.45])),
            roof: add("roof", |parts| parts.gable([-3.06, -0.2, -15.6], [3.06, 3.4, 15.6])),
            vents: [add("vent", vent), add("skylight", |parts| parts.gable([-1.6, -0.8, -0.9], [1.6, 0.7, 0.9]))],
            chimney: add("chimney", chimney),
            tank: add("tank", tank),
            truck: add("truck", truck),
            lamp_post: add("lamp post", lamp_post),
            support: add("support", support),
            rack_pipes: [
                add("pipes", |parts| pipes(parts, 0)),
                add("pipes", |parts| pipes(parts, 1)),
                add("pipes", |parts| pipes(parts, 2)),
            ],
            bridge: add("pipe bridge", bridge),
            barrel: add("barrel", barrel),
            pallet: add("pallet", pallet),
            crate_box: add("crate", crate_box),
            machines: [add("press", press), add("lathe", turning), add("boiler", boiler), add("mill", mill)],
            conveyor: add("conveyor", conveyor),
            cabinet: add("cabinet", cabinet),
            drop_pipe: add("drop pipe", drop_pipe),
            loads: [add("box", |parts| parts.cuboid([-0.4, 0.0, -0.3], [0.4, 0.5, 0.3])), add("boxes", boxes)],
            shelf: add("shelf", shelf),
            column: add("column", column),
            truss: add("truss", truss),
            lamp: add("lamp", |parts| parts.lathe([0.0; 3], &[[0.0, 0.0], [0.4, 0.0], [0.15, 0.4], [0.0, 0.9]], 10)),
            crane: add("crane", crane),
        }
    }
}

/// A plinth and ribs stand out of it.
fn wall(parts: &mut Parts) {
    parts.cuboid([-0.05, -0.6, -0.3], [LONG + 0.05, HIGH, 0.0]);
    parts.tapered([-0.04, -0.6, -0.1], [LONG + 0.04, 0.9, 0.1], 0.0, 0.03);
    for rib in [0.3, LONG - 0.5] {
        parts.cuboid([rib, 0.8, -0.1], [rib + 0.2, HIGH - 0.1, 0.12]);
    }
}

/// Two rows of panes with bars, for a piece of wall.
fn windows(parts: &mut Parts) {
    for row in 0..2 {
        let y = 2.4 + 2.6 * row as f32;
        for pane in 0..2 {
            let x = 0.9 + 2.2 * pane as f32;
            parts.tapered([x, y, -0.05], [x + 1.9, y + 1.7, 0.06], 0.03, 0.0);
            parts.cuboid([x + 0.9, y, -0.02], [x + 0.98, y + 1.7, 0.09]);
        }
    }
}

/// A rolling gate that is shut.
fn gate(parts: &mut Parts) {
    parts.cuboid([-0.05, -0.6, -0.3], [LONG + 0.05, HIGH, 0.0]);
    for slat in 0..9 {
        let y = 0.02 + 0.5 * slat as f32;
        parts.cuboid([0.7, y, -0.1], [LONG - 0.7, y + 0.44, 0.05]);
    }
    for x in [0.5, LONG - 0.75] {
        parts.cuboid([x, -0.1, -0.1], [x + 0.25, 4.9, 0.14]);
    }
    parts.tapered([0.2, 4.7, -0.1], [LONG - 0.2, 5.0, 0.9], 0.1, 0.1);
}

fn vent(parts: &mut Parts) {
    parts.cuboid([-0.7, -0.9, -0.7], [0.7, 0.6, 0.7]);
    parts.lathe([0.0, 0.55, 0.0], &[[0.0, 0.0], [0.4, 0.0], [0.4, 0.7], [0.6, 0.8], [0.0, 1.2]], 12);
}

fn chimney(parts: &mut Parts) {
    parts.lathe([0.0; 3], &[[0.0, -0.5], [1.5, -0.5], [1.0, 26.0], [1.15, 26.1], [1.1, 27.0], [0.0, 27.0]], 20);
}

fn tank(parts: &mut Parts) {
    parts.lathe([0.0; 3], &[[0.0, 0.0], [1.6, 0.0], [1.6, 4.5], [1.1, 5.2], [0.0, 5.5]], 24);
    for hoop in 0..3 {
        let y = 0.8 + 1.4 * hoop as f32;
        parts.lathe([0.0, y, 0.0], &[[1.5, 0.0], [1.66, 0.0], [1.66, 0.1], [1.5, 0.1]], 24);
    }
    for rung in 0..12 {
        let y = 0.3 + 0.38 * rung as f32;
        parts.cuboid([-0.25, y, 1.6], [0.25, y + 0.04, 1.72]);
    }
}

/// Its front is +x.
fn truck(parts: &mut Parts) {
    parts.cuboid([-3.6, 0.75, -1.15], [1.6, 3.3, 1.15]);
    parts.tapered([1.75, 0.6, -1.1], [3.6, 2.5, 1.1], 0.25, 0.1);
    parts.cuboid([-3.5, 0.5, -0.9], [3.4, 0.8, 0.9]);
    for (x, z) in [(-2.6, -1.0), (-1.6, -1.0), (2.6, -1.0), (-2.6, 1.0), (-1.6, 1.0), (2.6, 1.0)] {
        let lying = Affine3A::from_translation(Vec3::new(x, 0.48, z)) * Affine3A::from_rotation_x(FRAC_PI_2);
        parts
            .moved(lying, |parts| parts.lathe([0.0; 3], &[[0.0, -0.15], [0.48, -0.15], [0.48, 0.15], [0.0, 0.15]], 14));
    }
}

fn lamp_post(parts: &mut Parts) {
    parts.lathe([0.0; 3], &[[0.0, -0.1], [0.12, -0.1], [0.07, 6.0], [0.0, 6.0]], 8);
    parts.cuboid([-0.05, 5.9, -1.6], [0.05, 6.0, 0.1]);
    parts.tapered([-0.15, 5.82, -1.9], [0.15, 5.97, -1.1], 0.04, 0.05);
}

/// Two posts and three beams under a rack of pipes.
fn support(parts: &mut Parts) {
    for z in [-0.85, 0.75] {
        parts.cuboid([-0.08, -0.3, z], [0.08, 5.6, z + 0.1]);
    }
    for y in [3.9, 4.4, 5.3] {
        parts.cuboid([-0.06, y, -0.9], [0.06, y + 0.1, 0.9]);
    }
}

/// Four pipes along a piece of a rack; in kind 1 one of them swings out, in kind 2 there is a valve.
fn pipes(parts: &mut Parts, kind: usize) {
    for (pipe, radius) in [0.12, 0.2, 0.09, 0.15].into_iter().enumerate() {
        let (z, radius) = (-0.6 + 0.4 * pipe as f32, radius);
        let at = |x: f32, y: f32| Vec3::new(x, y, z);
        match (kind, pipe) {
            (1, 0) => parts.pipe(
                &[at(-0.01, 0.0), at(2.0, 0.0), at(2.0, 0.8), at(4.0, 0.8), at(4.0, 0.0), at(LONG + 0.01, 0.0)],
                radius,
                6,
            ),
            _ => parts.pipe(&[at(0.0, 0.0), at(LONG, 0.0)], radius, 8),
        }
        if kind == 2 && pipe == 1 {
            parts.rod(at(2.9, 0.0), at(3.1, 0.0), 1.7 * radius, 8);
            parts.rod(at(3.0, 0.0), at(3.0, 0.6), 0.05, 5);
            parts.lathe(at(3.0, 0.6), &[[0.0, 0.0], [0.3, 0.0], [0.3, 0.05], [0.0, 0.05]], 10);
        }
    }
}

/// Three pipes across a street along +z.
fn bridge(parts: &mut Parts) {
    for pipe in 0..3 {
        let (x, z) = (0.45 * pipe as f32, 0.2 - 0.3 * pipe as f32);
        parts.pipe(&[Vec3::new(x, -0.8, z), Vec3::new(x, 0.0, z), Vec3::new(x, 0.0, 12.3)], 0.13, 8);
    }
}

fn barrel(parts: &mut Parts) {
    let profile =
        [[0.0, 0.02], [0.29, 0.0], [0.29, 0.29], [0.31, 0.31], [0.29, 0.33], [0.29, 0.88], [0.27, 0.88], [0.0, 0.86]];
    parts.lathe([0.0; 3], &profile, 9);
}

fn pallet(parts: &mut Parts) {
    for board in 0..5 {
        let z = -0.6 + 0.26 * board as f32;
        parts.cuboid([-0.6, 0.1, z], [0.6, 0.13, z + 0.16]);
    }
    for foot in [-0.58, -0.05, 0.48] {
        parts.cuboid([foot, -0.02, -0.58], [foot + 0.1, 0.11, 0.58]);
    }
}

fn crate_box(parts: &mut Parts) {
    parts.cuboid([-0.5, 0.0, -0.5], [0.5, 0.95, 0.5]);
    for y in [0.02, 0.82] {
        parts.cuboid([-0.53, y, -0.53], [0.53, y + 0.12, 0.53]);
    }
    for (x, z) in [(-0.52, -0.52), (0.42, -0.52), (-0.52, 0.42), (0.42, 0.42)] {
        parts.cuboid([x, 0.05, z], [x + 0.1, 0.9, z + 0.1]);
    }
}

fn press(parts: &mut Parts) {
    parts.cuboid([-1.2, -0.05, -0.9], [1.2, 0.8, 0.9]);
    for x in [-1.1, 0.8] {
        parts.cuboid([x, 0.75, -0.7], [x + 0.3, 3.0, 0.7]);
    }
    parts.tapered([-1.25, 2.9, -0.85], [1.25, 3.6, 0.85], 0.2, 0.2);
    parts.lathe([0.0, 1.3, 0.0], &[[0.0, 0.0], [0.45, 0.0], [0.45, 0.3], [0.2, 0.3], [0.2, 1.8], [0.0, 1.8]], 14);
}

fn turning(parts: &mut Parts) {
    parts.cuboid([-1.7, -0.05, -0.5], [1.7, 0.75, 0.5]);
    parts.cuboid([-1.7, 0.7, -0.6], [-0.8, 1.7, 0.6]);
    let lying = Affine3A::from_translation(Vec3::new(-0.85, 1.2, 0.0)) * Affine3A::from_rotation_z(-FRAC_PI_2);
    parts.moved(lying, |parts| {
        parts.lathe([0.0; 3], &[[0.0, 0.0], [0.35, 0.0], [0.35, 0.3], [0.12, 0.32], [0.12, 1.8], [0.0, 1.8]], 14);
    });
    parts.cuboid([1.0, 0.7, -0.3], [1.5, 1.45, 0.3]);
    parts.tapered([-0.2, 0.7, -0.4], [0.4, 1.0, 0.7], 0.05, 0.1);
}

fn boiler(parts: &mut Parts) {
    parts.lathe([0.0; 3], &[[0.0, -0.05], [1.0, -0.05], [1.0, 2.6], [0.7, 3.1], [0.0, 3.3]], 18);
    parts.pipe(&[Vec3::new(0.0, 3.2, 0.0), Vec3::new(0.0, 4.0, 0.0), Vec3::new(0.0, 4.0, -1.4)], 0.15, 8);
    parts.pipe(&[Vec3::new(0.9, 0.6, 0.0), Vec3::new(1.5, 0.6, 0.0), Vec3::new(1.5, 2.4, 0.0)], 0.1, 8);
}

fn mill(parts: &mut Parts) {
    parts.cuboid([-1.0, -0.05, -0.8], [1.0, 0.9, 0.8]);
    parts.cuboid([-0.4, 0.85, -0.8], [0.4, 2.8, -0.2]);
    parts.tapered([-0.35, 1.9, -0.25], [0.35, 2.6, 0.7], 0.05, 0.05);
    parts.lathe([0.0, 1.2, 0.35], &[[0.0, 0.0], [0.1, 0.0], [0.1, 0.3], [0.22, 0.35], [0.22, 0.75], [0.0, 0.75]], 10);
    parts.tapered([-0.9, 0.88, -0.1], [0.9, 1.0, 0.7], 0.02, 0.02);
}

/// Rollers on a frame, 5.6 m along x about its origin.
fn conveyor(parts: &mut Parts) {
    for z in [-0.45, 0.38] {
        parts.cuboid([-2.78, 0.68, z], [2.78, 0.82, z + 0.07]);
    }
    for roller in 0..7 {
        let x = -2.5 + 0.82 * roller as f32;
        parts.rod([x, 0.75, -0.38], [x, 0.75, 0.38], 0.07, 6);
    }
    for x in [-2.4, 2.3] {
        parts.cuboid([x, 0.0, -0.42], [x + 0.1, 0.7, 0.42]);
    }
}

fn cabinet(parts: &mut Parts) {
    parts.cuboid([-0.4, 0.0, -0.3], [0.4, 1.9, 0.3]);
    parts.cuboid([-0.36, 0.1, 0.28], [0.36, 1.85, 0.33]);
    for slat in 0..4 {
        let y = 0.3 + 0.08 * slat as f32;
        parts.cuboid([-0.25, y, 0.3], [0.25, y + 0.03, 0.35]);
    }
}

/// From under the roof down to a machine.
fn drop_pipe(parts: &mut Parts) {
    parts.pipe(
        &[Vec3::new(0.0, 1.2, 0.0), Vec3::new(0.0, 4.4, 0.0), Vec3::new(0.0, 4.4, -1.5), Vec3::new(0.0, 6.6, -1.5)],
        0.11,
        8,
    );
}

fn boxes(parts: &mut Parts) {
    parts.cuboid([-0.45, 0.0, -0.3], [-0.02, 0.4, 0.28]);
    parts.cuboid([0.02, 0.0, -0.27], [0.44, 0.36, 0.3]);
    parts.cuboid([-0.25, 0.39, -0.25], [0.2, 0.68, 0.22]);
}

/// Along x about its origin, its back to -z.
fn shelf(parts: &mut Parts) {
    for (x, z) in [(-1.75, -0.4), (1.68, -0.4), (-1.75, 0.33), (1.68, 0.33)] {
        parts.cuboid([x, 0.0, z], [x + 0.07, 3.0, z + 0.07]);
    }
    for board in 0..3 {
        let y = 0.06 + 0.9 * board as f32;
        parts.cuboid([-1.73, y, -0.38], [1.73, y + 0.05, 0.38]);
    }
}

fn column(parts: &mut Parts) {
    parts.cuboid([-0.15, 0.0, -0.16], [0.15, HIGH - 0.6, -0.12]);
    parts.cuboid([-0.15, 0.0, 0.12], [0.15, HIGH - 0.6, 0.16]);
    parts.cuboid([-0.02, 0.0, -0.13], [0.02, HIGH - 0.6, 0.13]);
    parts.tapered([-0.3, -0.05, -0.3], [0.3, 0.25, 0.3], 0.08, 0.08);
}

/// From wall to wall along z about its origin.
fn truss(parts: &mut Parts) {
    for y in [-0.1, 0.9] {
        parts.cuboid([-0.06, y, -14.6], [0.06, y + 0.12, 14.6]);
    }
    for field in 0..14 {
        let z = -14.0 + 2.0 * field as f32;
        let (low, high) = if field % 2 == 0 { (0.0, 0.95) } else { (0.95, 0.0) };
        parts.rod([0.0, low, z], [0.0, high, z + 2.0], 0.05, 4);
    }
}

fn crane(parts: &mut Parts) {
    parts.cuboid([-0.35, 0.0, -14.2], [0.35, 0.7, 14.2]);
    parts.cuboid([-0.7, 0.3, -2.0], [0.7, 1.0, -0.4]);
    parts.rod([0.0, 0.1, -1.2], [0.0, -2.2, -1.2], 0.04, 5);
    parts.tapered([-0.25, -2.7, -1.45], [0.25, -2.1, -0.95], 0.08, 0.08);
}
