//! Meshes put together from simple parts, flat shaded, counter-clockwise from outside.

mod cut;
mod round;

use super::detail::Detail;
use crate::model::{Mesh, Topology};
use glam::{Affine3A, Vec3};
use std::f32::consts::TAU;

/// A mesh in the making. Metres, +y up.
#[derive(Default)]
pub(super) struct Parts {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    indices: Vec<u32>,
    detail: Detail,
}

impl Parts {
    /// No parts yet; those to come are divided as a level of detail asks.
    pub(super) fn at(detail: Detail) -> Self {
        Parts { detail, ..Parts::default() }
    }

    /// The level that parts are divided by.
    pub(super) fn detail(&self) -> Detail {
        self.detail
    }

    /// The finished mesh.
    pub(super) fn mesh(self, name: &str) -> Mesh {
        let Parts { positions, normals, indices, .. } = self;
        let topology = Topology::Triangles;
        Mesh { name: name.into(), topology, positions, normals, indices, ..Mesh::default() }
    }

    /// A flat face with its corners counter-clockwise from outside; three corners or more, convex.
    pub(super) fn face(&mut self, corners: &[Vec3]) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or(Vec3::Y);
        if self.detail.cuts() > 1 {
            return self.cut_face(corners, normal);
        }
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(corners);
        self.normals.extend(corners.iter().map(|_| normal));
        for corner in 2..corners.len() as u32 {
            self.indices.extend([first, first + corner - 1, first + corner]);
        }
    }

    /// A box: 12 triangles.
    pub(super) fn cuboid(&mut self, min: impl Into<Vec3>, max: impl Into<Vec3>) {
        self.tapered(min, max, 0.0, 0.0);
    }

    /// A box whose top is smaller by `x` and `z` at each side.
    pub(super) fn tapered(&mut self, min: impl Into<Vec3>, max: impl Into<Vec3>, x: f32, z: f32) {
        let (min, max): (Vec3, Vec3) = (min.into(), max.into());
        let bottom = ring(min.y, (min.x, max.x), (min.z, max.z));
        let top = ring(max.y, (min.x + x, max.x - x), (min.z + z, max.z - z));
        self.between(&bottom, &top);
    }

    /// A cylinder or cone along +y with closed ends.
    pub(super) fn cylinder(&mut self, base: impl Into<Vec3>, radii: [f32; 2], height: f32, sides: usize) {
        let base: Vec3 = base.into();
        let circle = |radius: f32, y: f32| -> Vec<Vec3> {
            let corner = |side: usize| {
                let angle = side as f32 / sides as f32 * TAU;
                base + Vec3::new(radius * angle.cos(), y, -radius * angle.sin())
            };
            (0..sides).map(corner).collect()
        };
        self.between(&circle(radii[0], 0.0), &circle(radii[1], height));
    }

    /// A house roof or wedge: a box floor, and a ridge along x.
    pub(super) fn gable(&mut self, min: impl Into<Vec3>, max: impl Into<Vec3>) {
        let (min, max): (Vec3, Vec3) = (min.into(), max.into());
        let floor = ring(min.y, (min.x, max.x), (min.z, max.z));
        let middle = 0.5 * (min.z + max.z);
        let (left, right) = (Vec3::new(min.x, max.y, middle), Vec3::new(max.x, max.y, middle));
        let [front_left, front_right, back_right, back_left] = floor;
        self.face(&[front_left, front_right, right, left]);
        self.face(&[back_right, back_left, left, right]);
        self.face(&[front_right, back_right, right]);
        self.face(&[back_left, front_left, left]);
        self.face(&[back_left, back_right, front_right, front_left]);
    }

    /// A faceted ellipsoid with `rings` from pole to pole and twice as many sides.
    pub(super) fn ball(&mut self, centre: impl Into<Vec3>, radii: impl Into<Vec3>, rings: usize) {
        let (centre, radii): (Vec3, Vec3) = (centre.into(), radii.into());
        let sides = 2 * rings;
        let point = |ring: usize, side: usize| {
            let polar = ring as f32 / rings as f32 * 0.5 * TAU;
            let angle = (side % sides) as f32 / sides as f32 * TAU;
            // The poles exactly: the sine of pi is not zero in floating point.
            let across = if ring == 0 || ring == rings { 0.0 } else { polar.sin() };
            centre + radii * Vec3::new(across * angle.cos(), -polar.cos(), -across * angle.sin())
        };
        for ring in 0..rings {
            for side in 0..sides {
                let corners =
                    [point(ring, side), point(ring, side + 1), point(ring + 1, side + 1), point(ring + 1, side)];
                match ring {
                    0 => self.face(&[corners[0], corners[2], corners[3]]),
                    last if last + 1 == rings => self.face(&[corners[0], corners[1], corners[2]]),
                    _ => self.face(&corners),
                }
            }
        }
    }

    /// Adds what `build` makes, moved by a rigid transform.
    pub(super) fn moved(&mut self, transform: Affine3A, build: impl FnOnce(&mut Parts)) {
        let start = self.positions.len();
        build(self);
        for position in &mut self.positions[start..] {
            *position = transform.transform_point3(*position);
        }
        for normal in &mut self.normals[start..] {
            *normal = transform.transform_vector3(*normal);
        }
    }

    /// The closed body between two polygons of as many corners, both counter-clockwise from above.
    fn between(&mut self, bottom: &[Vec3], top: &[Vec3]) {
        for side in 0..bottom.len() {
            let next = (side + 1) % bottom.len();
            if top[side] == top[next] {
                self.face(&[bottom[side], bottom[next], top[side]]);
            } else if bottom[side] == bottom[next] {
                self.face(&[bottom[side], top[next], top[side]]);
            } else {
                self.face(&[bottom[side], bottom[next], top[next], top[side]]);
            }
        }
        let area = |ring: &[Vec3]| (ring[1] - ring[0]).cross(ring[2] - ring[0]).length_squared();
        if area(top) > 0.0 {
            self.face(top);
        }
        if area(bottom) > 0.0 {
            let below: Vec<Vec3> = bottom.iter().rev().copied().collect();
            self.face(&below);
        }
    }
}

/// A rectangle at a height, counter-clockwise from above, from the corner of least x and largest z.
fn ring(y: f32, x: (f32, f32), z: (f32, f32)) -> [Vec3; 4] {
    [Vec3::new(x.0, y, z.1), Vec3::new(x.1, y, z.1), Vec3::new(x.1, y, z.0), Vec3::new(x.0, y, z.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Volume by the divergence theorem: positive if all faces look outward.
    fn volume(mesh: &Mesh) -> f32 {
        let corner = |index: &u32| mesh.positions[*index as usize];
        let signed = |t: &[u32]| corner(&t[0]).dot(corner(&t[1]).cross(corner(&t[2]))) / 6.0;
        mesh.indices.chunks_exact(3).map(signed).sum()
    }

    /// Each edge is walked once in each direction.
    fn is_closed(mesh: &Mesh) -> bool {
        let key = |index: u32| mesh.positions[index as usize].to_array().map(|part| (part * 1e4).round() as i64);
        let mut edges = BTreeMap::new();
        for triangle in mesh.indices.chunks_exact(3) {
            for side in 0..3 {
                let (a, b) = (key(triangle[side]), key(triangle[(side + 1) % 3]));
                *edges.entry(if a < b { (a, b) } else { (b, a) }).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        edges.values().all(|&sum| sum == 0)
    }

    #[test]
    fn parts_are_closed_and_look_outward() {
        type Build = fn(&mut Parts);
        let cases: [(&str, Build, f32); 12] = [
            ("globe", |parts| parts.globe([0.0, 9.0, 0.0], [1.0; 3], [24, 48], |_| 1.0), 4.19),
            ("lathe", |parts| parts.lathe([3.0, 0.0, 0.0], &[[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]], 64), TAU),
            ("rod", |parts| parts.rod([0.0; 3], [3.0, 4.0, 0.0], 1.0, 64), 2.5 * TAU),
            (
                "ring",
                |parts| {
                    let around =
                        |u: f32| Vec3::new((TAU * u).cos(), 0.2 * (2.0 * TAU * u).sin(), (TAU * u).sin()) * 4.0;
                    parts.tube(around, [128, 32], 1.0, true);
                },
                0.5 * TAU * 26.1,
            ),
            // Both rods whole, and of the ball what lies outside of them, counted as often as parts hold it.
            ("pipe", |parts| parts.pipe(&[Vec3::ZERO, Vec3::X * 9.0, Vec3::new(9.0, 9.0, 0.0)], 1.0, 32), 75.0),
            ("cuboid", |parts| parts.cuboid([-1.0, 0.0, -2.0], [1.0, 3.0, 2.0]), 24.0),
            ("tapered", |parts| parts.tapered([-1.0, 0.0, -1.0], [1.0, 3.0, 1.0], 1.0, 1.0), 4.0),
            ("cylinder", |parts| parts.cylinder([5.0, 1.0, 0.0], [1.0, 1.0], 2.0, 64), TAU),
            ("cone", |parts| parts.cylinder([0.0, 1.0, 0.0], [1.0, 0.0], 3.0, 64), 0.5 * TAU),
            ("gable", |parts| parts.gable([0.0, 0.0, 0.0], [2.0, 1.0, 3.0]), 3.0),
            ("ball", |parts| parts.ball([0.0, 9.0, 0.0], [1.0, 1.0, 1.0], 32), 4.19),
            (
                "moved",
                |parts| parts.moved(Affine3A::from_rotation_x(1.0), |parts| parts.cuboid([0.0; 3], [1.0; 3])),
                1.0,
            ),
        ];
        for (name, build, expected) in cases {
            for level in [1, 2] {
                let mut parts = Parts::at(Detail::new(level));
                build(&mut parts);
                let mesh = parts.mesh(name);
                assert!((volume(&mesh) - expected).abs() < 0.02 * expected, "{name}: {}", volume(&mesh));
                assert!(is_closed(&mesh), "{name} at level {level}");
                assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5), "{name}");
            }
        }
    }
}
