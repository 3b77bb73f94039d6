//! The reach of vertices that morph targets displace, for weights that may be anywhere in given ranges.
//!
//! **Derivation.** Along a direction a, a vertex p with displacements d is at `a·p + sum w (a·d)`, which is linear in each weight. Its
//! largest value for weights between lo and hi is `a·p + sum max(lo (a·d), hi (a·d))`. The largest of these over all vertices is the
//! reach along a.
//!
//! A vertex is dropped if, along each direction, its largest value for the weights of the whole animation is below the smallest value
//! of another vertex. Most meshes keep few vertices, so that a box for each frame costs little.
//!
//! **Rounding.** `world/skin_vertices` rounds w to f32, multiplies, and adds up n products and p: one rounding for w, one for the
//! product, at most n for the sums. With u = 2^-24 that is at most (n + 2) u (1 + 2^-8) of `S = |p| + sum |w| |d|` along an axis, for
//! the weights that make S largest. The slack of 2^-8 covers n up to 2^15, and the rounding of this file in f64. The loss of numbers
//! below f32's smallest normal one is added likewise.

use super::spread::{weights, Span};
use crate::animation::NodeAnimation;
use crate::bounds::{Reach, SMALLEST};
use crate::morph::Deformed;
use glam::DVec3;
use std::borrow::Cow;

/// A rounding to f32, with slack for higher orders: (1 + u)^n - 1 < n u (1 + n u), and n u is at most 2^-9.
const ROUNDED: f64 = 1.0 / 16_777_216.0 * (1.0 + 1.0 / 256.0);

/// The smallest and the largest value of each weight that moves a mesh.
pub(super) type Ranges = Vec<[f64; 2]>;

/// The weights that move a mesh, as indices into those of the animation. Vertices refer to them by their index in this list.
#[derive(Clone, Debug, Default)]
pub(super) struct Weights(pub(super) Vec<u32>);

impl Weights {
    pub(super) fn of(deformed: &Deformed) -> Self {
        Weights(deformed.targets.iter().map(|target| target.weight).collect())
    }

    /// Returns their values. `all` has the values of all weights of the animation at a time.
    pub(super) fn now(&self, all: &[f64]) -> Vec<f64> {
        self.0.iter().map(|weight| all[*weight as usize]).collect()
    }

    /// Returns their ranges within a span.
    pub(super) fn during(&self, nodes: &NodeAnimation, span: Span) -> Ranges {
        self.0.iter().map(|weight| weights(&nodes.weights()[*weight as usize], span)).collect()
    }

    /// Returns their ranges over the whole animation.
    pub(super) fn ever(&self, nodes: &NodeAnimation) -> Ranges {
        self.0.iter().map(|weight| nodes.weight_ranges()[*weight as usize]).collect()
    }
}

/// A vertex that targets displace.
#[derive(Clone, Debug)]
struct Moved {
    position: DVec3,
    /// Indices into [`Weights`], and displacements at weight 1.
    displacements: Vec<(usize, DVec3)>,
}

/// Some vertices of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Points {
    /// The reach of those that no target displaces.
    still: Reach,
    /// Vertices that targets displace, without those that never reach farthest.
    moved: Vec<Moved>,
    /// The largest rounding error of the device for any displaced vertex, along each axis.
    error: DVec3,
}

/// Returns, for each vertex, the targets that displace it (indices among the targets of its mesh) and their displacements at weight 1.
pub(super) fn displacements(deformed: &Deformed) -> Vec<Vec<(usize, DVec3)>> {
    let mut by_vertex = vec![Vec::new(); deformed.rest.len()];
    for (number, target) in deformed.targets.iter().enumerate() {
        for displaced in target.displacements.iter().filter(|displaced| displaced.position != glam::Vec3::ZERO) {
            by_vertex[displaced.vertex as usize].push((number, displaced.position.as_dvec3()));
        }
    }
    by_vertex
}

impl Points {
    /// Takes vertices with their displacements. Their weights stay in the ranges `ever`.
    pub(super) fn new<'a>(vertices: impl Iterator<Item = (DVec3, &'a [(usize, DVec3)])>, ever: &Ranges) -> Self {
        let (mut still, mut moved, mut error) = (Reach::NOTHING, Vec::new(), DVec3::ZERO);
        for (position, displacements) in vertices {
            if displacements.is_empty() {
                still.take(position);
                continue;
            }
            let vertex = Moved { position, displacements: displacements.to_vec() };
            error = error.max(vertex.error(ever));
            moved.push(vertex);
        }
        let moved = farthest(moved, &still, ever);
        let still = match moved.is_empty() {
            // Displaced vertices that were dropped stay behind the others, but the device may round them in front.
            true if error != DVec3::ZERO => still.widened(error).with_largest(),
            true => still.with_largest(),
            false => still,
        };
        Points { still, moved, error }
    }

    /// Counts the positions and displacements that [`Points::reach`] looks at.
    pub(super) fn steps(&self) -> u64 {
        self.moved.iter().map(|vertex| 1 + vertex.displacements.len() as u64).sum()
    }

    /// Returns their reach for weights in these ranges, with room for the device's rounding.
    pub(super) fn reach(&self, ranges: &Ranges) -> Cow<'_, Reach> {
        if self.moved.is_empty() {
            return Cow::Borrowed(&self.still);
        }
        let mut reach = self.still.clone();
        for vertex in &self.moved {
            reach.take_between(|direction| vertex.along(direction, ranges));
        }
        Cow::Owned(reach.widened(self.error).with_largest())
    }

    /// Returns their reach for these weights, with room for the device's rounding. Equals `reach` with ranges of one value each, but
    /// displaces each vertex once, not once a direction.
    pub(super) fn reach_now(&self, weights: &[f64]) -> Cow<'_, Reach> {
        if self.moved.is_empty() {
            return Cow::Borrowed(&self.still);
        }
        let mut reach = self.still.clone();
        for Moved { position, displacements } in &self.moved {
            reach.take(displacements.iter().fold(*position, |at, (weight, by)| at + weights[*weight] * *by));
        }
        Cow::Owned(reach.widened(self.error).with_largest())
    }
}

impl Moved {
    /// Returns the smallest and the largest place that it can have along a direction.
    fn along(&self, direction: DVec3, ranges: &Ranges) -> [f64; 2] {
        let at = direction.dot(self.position);
        self.displacements.iter().fold([at; 2], |[least, most], (weight, displacement)| {
            let ends = ranges[*weight].map(|weight| weight * direction.dot(*displacement));
            [least + ends[0].min(ends[1]), most + ends[0].max(ends[1])]
        })
    }

    /// Returns the rounding error of the device, along each axis.
    fn error(&self, ever: &Ranges) -> DVec3 {
        let roundings = (self.displacements.len() + 2) as f64;
        let (mut size, mut small) = (self.position.abs(), DVec3::splat(2.0));
        for (weight, displacement) in &self.displacements {
            let weight = ever[*weight][0].abs().max(ever[*weight][1].abs());
            size += weight * displacement.abs();
            small += displacement.abs() + DVec3::splat(weight + 3.0);
        }
        roundings * ROUNDED * size + SMALLEST * small
    }
}

/// Keeps the vertices that reach farthest along some direction, for some weights in these ranges.
fn farthest(moved: Vec<Moved>, still: &Reach, ever: &Ranges) -> Vec<Moved> {
    let mut sure = still.clone();
    for vertex in &moved {
        // The vertex reaches at least to its smallest place along a direction, and to its largest along the opposite one.
        sure.take_between(|direction| {
            let [least, most] = vertex.along(direction, ever);
            [most, least]
        });
    }
    let reaches = |vertex: &Moved| sure.any_reached(|direction| vertex.along(direction, ever));
    moved.into_iter().filter(reaches).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A displaced vertex that was dropped took its rounding with it.
    #[test]
    fn vertices_that_are_dropped_leave_room_for_their_rounding() {
        let sign = |corner: u32, axis: u32| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        let corner = |corner: u32| DVec3::new(sign(corner, 0), sign(corner, 1), sign(corner, 2));
        let cube = (0..8).map(|at| (corner(at), &[][..]));
        let moved: (DVec3, &[(usize, DVec3)]) = (DVec3::splat(0.5), &[(0, DVec3::splat(0.499_999_999))]);
        let ever = vec![[0.0, 1.0]];
        let points = Points::new(cube.clone().chain([moved]), &ever);
        assert!(points.moved.is_empty(), "it never reaches farthest");
        for reach in [points.reach(&ever), points.reach_now(&[1.0])] {
            let most = reach.in_object_space().max.x;
            // Three roundings of numbers below 1.
            assert!(most > 1.0 + 1.5e-7 && most < 1.0 + 2.5e-7, "{most}");
        }
        let alone = Points::new(cube, &ever);
        assert_eq!(alone.reach(&ever).in_object_space().max, DVec3::ONE);
    }
}
