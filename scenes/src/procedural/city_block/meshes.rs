//! Meshes of the city. Shells and tiles have unit size and are scaled; all else is in metres.

use super::super::parts::Parts;
use crate::model::Mesh;
use crate::procedural::Assembly;
use glam::{Affine3A, Vec3};
use std::f32::consts::FRAC_PI_2;

/// Indices of the city's meshes.
pub(super) struct Meshes {
    pub cube: u32,
    pub tile: u32,
    pub shells: [u32; 3],
    pub house: u32,
    pub windows: [u32; 3],
    pub shop_window: u32,
    pub door: u32,
    pub balcony: u32,
    pub awning: u32,
    pub conditioner: u32,
    pub water_tank: u32,
    pub roof_unit: u32,
    pub antenna: u32,
    pub chimney: u32,
    pub crown: u32,
    pub lamp_post: u32,
    pub traffic_light: u32,
    pub cars: [u32; 2],
    pub trees: [u32; 2],
    pub bench: u32,
    pub hydrant: u32,
    pub bin: u32,
    pub fence: u32,
    pub crossing: u32,
}

impl Meshes {
    pub(super) fn new(assembly: &mut Assembly) -> Self {
        let mut add = |mesh: Mesh| assembly.mesh(mesh);
        Meshes {
            cube: add(cube()),
            tile: add(tile()),
            shells: [add(banded_shell("shell banded", 4)), add(banded_shell("shell plain", 1)), add(pillared_shell())],
            house: add(house()),
            windows: [
                add(window("window", 1.2, 1.5, 2)),
                add(window("window wide", 1.9, 1.5, 3)),
                add(window("window tall", 1.1, 2.1, 2)),
            ],
            shop_window: add(window("shop window", 2.6, 2.4, 2)),
            door: add(door()),
            balcony: add(balcony()),
            awning: add(awning()),
            conditioner: add(conditioner()),
            water_tank: add(water_tank()),
            roof_unit: add(roof_unit()),
            antenna: add(antenna()),
            chimney: add(chimney()),
            crown: add(crown()),
            lamp_post: add(lamp_post()),
            traffic_light: add(traffic_light()),
            cars: [add(car("car", 4.3, 0.75, 1.4)), add(car("van", 5.2, 0.95, 2.1))],
            trees: [add(broad_tree()), add(conifer())],
            bench: add(bench()),
            hydrant: add(hydrant()),
            bin: add(bin()),
            fence: add(fence()),
            crossing: add(crossing()),
        }
    }
}

fn built(name: &str, build: impl FnOnce(&mut Parts)) -> Mesh {
    let mut parts = Parts::default();
    build(&mut parts);
    parts.mesh(name)
}

/// From -0.5 to 0.5 across, from 0 to 1 up.
fn cube() -> Mesh {
    built("cube", |parts| parts.cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5]))
}

/// Ground: the top is the unit square at 0, the sides slope outward below it, under the neighbours.
/// So neighbours share edges, but no two faces lie in one plane.
fn tile() -> Mesh {
    built("tile", |parts| parts.tapered([-0.52, -1.0, -0.52], [0.52, 0.0, 0.52], 0.02, 0.02))
}

/// A storeyed block with a plinth, `bands` ledges and a cornice.
fn banded_shell(name: &str, bands: usize) -> Mesh {
    built(name, |parts| {
        parts.cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5]);
        parts.tapered([-0.507, 0.0, -0.51], [0.507, 0.03, 0.51], 0.003, 0.004);
        for band in 1..=bands {
            let y = band as f32 / (bands + 1) as f32;
            parts.cuboid([-0.505, y, -0.508], [0.505, y + 0.008, 0.508]);
        }
        parts.cuboid([-0.51, 0.965, -0.512], [0.51, 0.985, 0.512]);
        parts.tapered([-0.506, 0.98, -0.508], [0.506, 1.02, 0.508], 0.002, 0.002);
    })
}

/// A block with five pillars on its long sides.
fn pillared_shell() -> Mesh {
    built("shell pillared", |parts| {
        parts.cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5]);
        for pillar in 0..5 {
            let x = -0.49 + 0.245 * pillar as f32;
            for z in [-0.5, 0.5] {
                parts.cuboid([x - 0.01, 0.0, z - 0.012], [x + 0.01, 0.95, z + 0.012]);
            }
        }
        parts.cuboid([-0.508, 0.95, -0.52], [0.508, 1.01, 0.52]);
        parts.cuboid([-0.504, 0.0, -0.516], [0.504, 0.05, 0.516]);
    })
}

/// Walls up to 0.75, then a roof with eaves and its ridge along x.
fn house() -> Mesh {
    built("house", |parts| {
        parts.cuboid([-0.5, 0.0, -0.5], [0.5, 0.75, 0.5]);
        parts.gable([-0.51, 0.74, -0.53], [0.51, 1.0, 0.53]);
        parts.cuboid([-0.503, 0.0, -0.505], [0.503, 0.04, 0.505]);
    })
}

/// A frame with bars, a pane and a sill. The origin is the middle of its lower edge in the wall's face.
fn window(name: &str, width: f32, height: f32, panes: usize) -> Mesh {
    let half = 0.5 * width;
    built(name, |parts| {
        parts.cuboid([-half, 0.0, -0.1], [half, height, 0.03]);
        for x in [-half - 0.08, half - 0.02] {
            parts.tapered([x, -0.05, -0.05], [x + 0.1, height + 0.05, 0.09], 0.01, 0.0);
        }
        for y in [-0.07, height - 0.03] {
            parts.cuboid([-half - 0.07, y, -0.05], [half + 0.07, y + 0.1, 0.085]);
        }
        for bar in 1..panes {
            let x = -half + width * bar as f32 / panes as f32;
            parts.cuboid([x - 0.025, 0.0, -0.05], [x + 0.025, height, 0.06]);
        }
        parts.cuboid([-half, 0.6 * height, -0.05], [half, 0.6 * height + 0.05, 0.055]);
        parts.cuboid([-half - 0.15, -0.12, -0.05], [half + 0.15, -0.06, 0.2]);
        parts.tapered([-half - 0.12, height + 0.06, -0.05], [half + 0.12, height + 0.2, 0.13], 0.05, 0.02);
    })
}

fn door() -> Mesh {
    built("door", |parts| {
        parts.cuboid([-0.5, 0.0, -0.05], [0.5, 2.2, 0.03]);
        for x in [-0.62, 0.5] {
            parts.cuboid([x, 0.0, -0.05], [x + 0.12, 2.3, 0.09]);
        }
        parts.cuboid([-0.63, 2.2, -0.05], [0.63, 2.35, 0.11]);
        for (x, y) in [(-0.4, 0.2), (0.05, 0.2), (-0.4, 1.2), (0.05, 1.2)] {
            parts.tapered([x, y, 0.0], [x + 0.35, y + 0.8, 0.05], 0.02, 0.0);
        }
        parts.ball([0.4, 1.05, 0.08], [0.035, 0.035, 0.035], 4);
        parts.cuboid([-0.8, -0.15, -0.05], [0.8, 0.02, 0.35]);
    })
}

fn balcony() -> Mesh {
    built("balcony", |parts| {
        parts.cuboid([-1.4, -0.15, -0.1], [1.4, 0.0, 1.1]);
        parts.cuboid([-1.38, 0.98, 1.02], [1.38, 1.03, 1.08]);
        for bar in 0..15 {
            let x = -1.36 + 2.72 / 14.0 * bar as f32;
            parts.cuboid([x - 0.015, -0.02, 1.035], [x + 0.015, 1.0, 1.065]);
        }
        for x in [-1.37, 1.34] {
            parts.cuboid([x, 0.97, -0.05], [x + 0.035, 1.02, 1.04]);
            for bar in 0..6 {
                let z = 0.1 + 0.16 * bar as f32;
                parts.cuboid([x, -0.02, z], [x + 0.03, 1.0, z + 0.03]);
            }
        }
    })
}

fn awning() -> Mesh {
    built("awning", |parts| {
        for stripe in 0..8 {
            let x = -1.4 + 0.35 * stripe as f32;
            let drop = if stripe % 2 == 0 { 0.0 } else { 0.012 };
            let slope = Affine3A::from_translation(Vec3::new(0.0, -drop, 0.0)) * Affine3A::from_rotation_x(0.5);
            parts.moved(slope, |parts| parts.cuboid([x, -0.02, 0.0], [x + 0.35, 0.02, 1.3]));
        }
    })
}

fn conditioner() -> Mesh {
    built("air conditioner", |parts| {
        parts.cuboid([-0.45, 0.0, -0.05], [0.45, 0.6, 0.35]);
        for slat in 0..12 {
            let y = 0.05 + 0.042 * slat as f32;
            parts.cuboid([-0.41, y, 0.3], [0.05, y + 0.02, 0.37]);
        }
        let fan = Affine3A::from_translation(Vec3::new(0.25, 0.3, 0.33)) * Affine3A::from_rotation_x(FRAC_PI_2);
        parts.moved(fan, |parts| parts.cylinder([0.0; 3], [0.17, 0.15], 0.06, 20));
        for x in [-0.35, 0.3] {
            parts.cuboid([x, -0.08, -0.05], [x + 0.05, 0.01, 0.33]);
        }
    })
}

fn water_tank() -> Mesh {
    built("water tank", |parts| {
        for (x, z) in [(-0.8, -0.8), (0.8, -0.8), (-0.8, 0.8), (0.8, 0.8)] {
            parts.cuboid([x - 0.07, -0.1, z - 0.07], [x + 0.07, 1.6, z + 0.07]);
        }
        parts.cuboid([-1.1, 1.5, -1.1], [1.1, 1.65, 1.1]);
        parts.cylinder([0.0, 1.6, 0.0], [1.2, 1.15], 2.2, 28);
        for hoop in 0..4 {
            parts.cylinder([0.0, 1.75 + 0.5 * hoop as f32, 0.0], [1.23, 1.23], 0.06, 28);
        }
        parts.cylinder([0.0, 3.78, 0.0], [1.3, 0.0], 0.8, 28);
    })
}

fn roof_unit() -> Mesh {
    built("roof unit", |parts| {
        parts.cuboid([-1.2, -0.1, -0.8], [1.2, 1.1, 0.8]);
        for fan in [-0.6, 0.6] {
            parts.cylinder([fan, 1.05, 0.0], [0.45, 0.42], 0.2, 24);
        }
        for slat in 0..10 {
            let y = 0.1 + 0.09 * slat as f32;
            parts.cuboid([-1.1, y, -0.84], [1.1, y + 0.04, 0.84]);
        }
    })
}

fn antenna() -> Mesh {
    built("antenna", |parts| {
        parts.cylinder([0.0, -0.1, 0.0], [0.04, 0.02], 4.0, 8);
        for bar in 0..6 {
            let (y, half) = (2.2 + 0.28 * bar as f32, 0.7 - 0.09 * bar as f32);
            parts.cuboid([-half, y, -0.015], [half, y + 0.03, 0.015]);
        }
    })
}

fn chimney() -> Mesh {
    built("chimney", |parts| {
        parts.cuboid([-0.35, -0.5, -0.35], [0.35, 1.6, 0.35]);
        parts.tapered([-0.42, 1.5, -0.42], [0.42, 1.7, 0.42], 0.05, 0.05);
        for x in [-0.15, 0.15] {
            parts.cylinder([x, 1.65, 0.0], [0.1, 0.08], 0.4, 12);
        }
    })
}

/// Two storeys set back on a roof, in unit width and depth and 1 high.
fn crown() -> Mesh {
    built("crown", |parts| {
        parts.cuboid([-0.36, -0.05, -0.36], [0.36, 0.55, 0.36]);
        parts.cuboid([-0.37, 0.5, -0.37], [0.37, 0.58, 0.37]);
        parts.cuboid([-0.24, 0.5, -0.24], [0.24, 0.95, 0.24]);
        parts.tapered([-0.25, 0.92, -0.25], [0.25, 1.1, 0.25], 0.08, 0.08);
    })
}

fn lamp_post() -> Mesh {
    built("lamp post", |parts| {
        parts.cylinder([0.0, -0.05, 0.0], [0.14, 0.1], 0.6, 12);
        parts.cylinder([0.0, 0.5, 0.0], [0.06, 0.045], 4.6, 12);
        parts.cuboid([-0.03, 4.95, -0.05], [0.03, 5.02, 1.3]);
        parts.tapered([-0.14, 4.84, 0.9], [0.14, 5.0, 1.5], 0.05, 0.08);
    })
}

fn traffic_light() -> Mesh {
    built("traffic light", |parts| {
        parts.cylinder([0.0, -0.05, 0.0], [0.07, 0.06], 3.4, 12);
        parts.cuboid([-0.16, 2.5, 0.03], [0.16, 3.4, 0.24]);
        for light in 0..3 {
            parts.ball([0.0, 2.66 + 0.28 * light as f32, 0.24], [0.1, 0.1, 0.05], 6);
        }
    })
}

/// Its front is +x.
fn car(name: &str, length: f32, bonnet: f32, height: f32) -> Mesh {
    let half = 0.5 * length;
    built(name, |parts| {
        parts.tapered([-half, 0.28, -0.86], [half, bonnet, 0.86], 0.06, 0.05);
        parts.tapered([-0.9 * half, bonnet - 0.02, -0.8], [0.45 * half, height, 0.8], 0.35, 0.12);
        for x in [-half - 0.05, half - 0.07] {
            parts.cuboid([x, 0.3, -0.8], [x + 0.12, 0.48, 0.8]);
        }
        for (x, z) in [(-0.6, -0.8), (0.6, -0.8), (-0.6, 0.8), (0.6, 0.8)] {
            let axle = Affine3A::from_translation(Vec3::new(x * half, 0.32, z)) * Affine3A::from_rotation_x(FRAC_PI_2);
            parts.moved(axle, |parts| {
                parts.cylinder([0.0, -0.11, 0.0], [0.32, 0.32], 0.22, 22);
                parts.cylinder([0.0, -0.125, 0.0], [0.17, 0.17], 0.25, 14);
            });
        }
        for z in [-0.6, 0.6] {
            parts.ball([half - 0.02, 0.58, z], [0.07, 0.08, 0.13], 5);
            parts.cuboid(
                [0.3 * half, bonnet + 0.03, z * 1.45 - 0.06],
                [0.3 * half + 0.12, bonnet + 0.15, z * 1.45 + 0.06],
            );
        }
    })
}

fn broad_tree() -> Mesh {
    built("broad tree", |parts| {
        parts.cylinder([0.0, -0.1, 0.0], [0.22, 0.12], 2.6, 12);
        for (x, y, z, size) in
            [(0.0, 4.2, 0.0, 1.5), (0.9, 3.4, 0.3, 1.0), (-0.8, 3.5, 0.4, 1.05), (0.1, 3.3, -0.9, 1.0)]
        {
            parts.ball([x, y, z], [size, 0.85 * size, size], 11);
        }
    })
}

fn conifer() -> Mesh {
    built("conifer", |parts| {
        parts.cylinder([0.0, -0.1, 0.0], [0.16, 0.1], 1.2, 10);
        for layer in 0..6 {
            let (y, radius) = (0.8 + 0.75 * layer as f32, 1.35 - 0.2 * layer as f32);
            parts.cylinder([0.0, y, 0.0], [radius, 0.25 * radius], 1.0, 20);
        }
        parts.cylinder([0.0, 5.2, 0.0], [0.3, 0.0], 0.9, 20);
    })
}

fn bench() -> Mesh {
    built("bench", |parts| {
        for slat in 0..5 {
            let z = -0.2 + 0.09 * slat as f32;
            parts.cuboid([-0.9, 0.43, z], [0.9, 0.46, z + 0.07]);
        }
        for slat in 0..4 {
            let y = 0.52 + 0.1 * slat as f32;
            parts.cuboid([-0.9, y, -0.27], [0.9, y + 0.08, -0.24]);
        }
        for x in [-0.75, 0.69] {
            parts.cuboid([x, -0.05, -0.24], [x + 0.06, 0.88, -0.18]);
            parts.cuboid([x, -0.05, 0.17], [x + 0.06, 0.44, 0.23]);
        }
    })
}

fn hydrant() -> Mesh {
    built("hydrant", |parts| {
        parts.cylinder([0.0, -0.05, 0.0], [0.18, 0.18], 0.12, 16);
        parts.cylinder([0.0, 0.05, 0.0], [0.13, 0.12], 0.6, 16);
        parts.ball([0.0, 0.65, 0.0], [0.14, 0.13, 0.14], 6);
        let arm = Affine3A::from_rotation_x(FRAC_PI_2);
        parts.moved(arm, |parts| parts.cylinder([0.0, -0.22, -0.45], [0.07, 0.07], 0.44, 12));
    })
}

fn bin() -> Mesh {
    built("litter bin", |parts| {
        parts.cylinder([0.0, -0.02, 0.0], [0.2, 0.25], 0.75, 18);
        parts.cylinder([0.0, 0.7, 0.0], [0.28, 0.27], 0.08, 18);
        parts.ball([0.0, 0.78, 0.0], [0.25, 0.12, 0.25], 6);
    })
}

/// 2 m of railing along x.
fn fence() -> Mesh {
    built("fence", |parts| {
        for y in [0.25, 0.95] {
            parts.cuboid([-1.0, y, -0.02], [1.0, y + 0.05, 0.02]);
        }
        for bar in 0..14 {
            let x = -0.96 + 0.14 * bar as f32;
            parts.tapered([x, -0.05, -0.015], [x + 0.03, 1.15, 0.015], 0.01, 0.01);
        }
    })
}

/// Stripes across 8 m of road along x, 2 cm thick.
fn crossing() -> Mesh {
    built("crossing", |parts| {
        for stripe in 0..8 {
            let x = -3.75 + stripe as f32;
            parts.tapered([x, -0.05, -1.2], [x + 0.5, 0.02, 1.2], 0.01, 0.01);
        }
    })
}
