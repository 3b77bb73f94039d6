//! Bounds of what a skeleton bends: the box around those of its joints.
//!
//! **Derivation.** A vertex v is the mean `sum w M v` of where its joints put it, with weights w >= 0 that add up to 1 + d. What some joint puts
//! somewhere, each of the vertices that it has a part in, lies in that joint's box ([`Reach`] of these vertices, transformed). The box around all
//! joints' boxes is convex and holds every place `M v`, so it holds their means. That is so at any time, and also for boxes that hold
//! a joint's vertices while a span of time passes.
//!
//! **Rounding.** `world/skin_vertices` rounds M and w to f32, mixes four products (of an entry of M and a weight: four roundings, three of them
//! sums), and multiplies by v (a product, three sums). With u = 2^-24 each term is off by a factor within (1 + u)^9, so that along an axis the whole is off
//! by at most 9u of `sum w S`, S = |row of M| |v| + |shift|, and d, at most u / 2, adds that much of it: under 10u, and the rest of 10u
//! (1 + 2^-16) covers what is rounded here in f64. As a mean of S is no larger than what the same mean of boxes wider by 10u S allows for,
//! each joint's box is widened by its own S. What numbers below f32's smallest normal one lose is added likewise. The object's transform comes after
//! that, and rounds as it does for every mesh.

use super::carried::{chain, Hung};
use super::spread::Span;
use super::{spans, sweep, union, MovingBounds, Sweep, Swept, ROUNDING};
use crate::animation::NodeAnimation;
use crate::bounds::{Reach, SMALLEST, TRANSFORM_ERROR};
use crate::model::{Aabb, Scene};
use crate::skin::{RestVertex, Skin};
use glam::{DAffine3, DVec3};

/// What bending rounds, see the head.
const BEND_ERROR: f64 = 10.0 / 16_777_216.0 * (1.0 + 1.0 / 65_536.0);

/// What an object consists of that a skeleton bends.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) skin: u32,
    /// Joints that carry something, and what, at rest.
    parts: Vec<(usize, Reach)>,
}

/// The bodies of a scene's moving objects, in the order of `Motion::transforms_at`. Empty if there are none.
pub(super) fn bodies(scene: &Scene) -> Vec<Option<Body>> {
    if scene.skinned.is_empty() {
        return Vec::new();
    }
    let body = |object: u32| {
        let at = scene.skinned.binary_search_by_key(&object, |skinned| skinned.object).ok()?;
        let skinned = &scene.skinned[at];
        Some(Body { skin: skinned.skin, parts: parts(&skinned.rest, scene.skins[skinned.skin as usize].joint_count()) })
    };
    scene.motion.dynamic_objects().into_iter().map(body).collect()
}

/// The vertices that each joint has a part in.
fn parts(rest: &[RestVertex], joints: usize) -> Vec<(usize, Reach)> {
    let mut reaches: Vec<Option<Reach>> = vec![None; joints];
    for vertex in rest {
        let carrying = vertex.joints.iter().zip(vertex.weights).filter(|(_, weight)| *weight > 0.0);
        for (joint, _) in carrying {
            reaches[*joint as usize].get_or_insert(Reach::NOTHING).take(vertex.position.as_dvec3());
        }
    }
    let some = reaches.into_iter().enumerate();
    some.filter_map(|(joint, reach)| Some((joint, reach?.with_largest()))).collect()
}

/// How far bending can put a vertex from where it belongs, along an axis: of a size S (see the head), by a matrix that makes nothing more than
/// `longer` times as long, of coordinates that are no larger than `largest`.
fn bend_error(size: f64, longer: f64, largest: f64) -> f64 {
    BEND_ERROR * size + SMALLEST * 16.0 * (3.0 * largest + 3.0 * longer + size + 1.0)
}

/// How far the object's transform, which makes nothing more than `longer` times as long, can put a vertex from where it belongs, which is up to
/// `size` from its origin.
fn place_error(size: f64, longer: f64) -> f64 {
    TRANSFORM_ERROR * longer * size + SMALLEST * (3.0 * longer + 3.0 * size + 6.0)
}

/// Largest magnitude of each coordinate.
fn largest(reach: &Reach) -> DVec3 {
    DVec3::from_array(reach.largest)
}

impl Body {
    /// Its bounds where it is, with its joints where they are.
    pub(super) fn bounds(&self, world_from_object: &DAffine3, places: &[DAffine3]) -> Aabb {
        union(self.parts.iter().map(|(joint, reach)| part_bounds(reach, world_from_object, &places[*joint])))
    }

    /// Its boxes for the whole of a motion.
    pub(super) fn on_nodes(&self, nodes: &NodeAnimation, skin: &Skin, mode: MovingBounds) -> Sweep {
        let turned = mode == MovingBounds::InPlace;
        let hung: Vec<Hung<'_>> = self.hung(nodes, skin);
        sweep(&hung, mode, DVec3::ZERO, |part, span| swept(part, span, turned))
    }

    /// Each part on its joint's node.
    fn hung<'a>(&'a self, nodes: &'a NodeAnimation, skin: &Skin) -> Vec<Hung<'a>> {
        let above_anchor = chain(nodes, skin.anchor()).len();
        let on_joint = |(joint, reach): &'a (usize, Reach)| {
            let joint = skin.joints()[*joint];
            let chain = chain(nodes, joint.node);
            Hung { reach, node_from_part: joint.joint_from_rest, carrier: chain.len() - above_anchor, chain }
        };
        self.parts.iter().map(on_joint).collect()
    }
}

/// The bounds of what a joint carries, in world space.
fn part_bounds(reach: &Reach, world_from_object: &DAffine3, object_from_rest: &DAffine3) -> Aabb {
    let rows = object_from_rest.matrix3.transpose();
    let sum = |row: DVec3| row.abs().dot(largest(reach));
    let size = DVec3::new(sum(rows.x_axis), sum(rows.y_axis), sum(rows.z_axis)) + object_from_rest.translation.abs();
    let (longer, most) =
        (rows.x_axis.length() + rows.y_axis.length() + rows.z_axis.length(), largest(reach).max_element());
    let error = size.map(|size| bend_error(size, longer, most));
    let place = *world_from_object * *object_from_rest;
    let world_rows = world_from_object.matrix3.transpose();
    reach.padded(&place, |axis, _| {
        let row = world_rows.col(axis).abs();
        let placed = TRANSFORM_ERROR * row.dot(size + error)
            + SMALLEST * (row.element_sum() + (size + error).element_sum() + 6.0);
        let shift = world_from_object.translation[axis].abs() + place.translation[axis].abs();
        row.dot(error) + placed + 2.0 * f64::EPSILON * shift
    })
}

/// Where what a joint carries can be in the world while a span passes. See the head of `moving.rs`; what is `turned` stays where the anchor is.
fn swept(part: &Hung<'_>, span: Span, turned: bool) -> Swept {
    let (below, above) = part.chain.split_at(part.carrier);
    let mut carried = part.begin(DVec3::ZERO, false);
    carried.up(below, span, false);
    let (size, longer) = (carried.farthest, std::mem::replace(&mut carried.longer, 1.0));
    carried.up(above, span, turned);
    carried.up_to_world(part, turned);
    // An error along each of three axes.
    let error = 3f64.sqrt() * bend_error(size, longer, largest(part.reach).max_element());
    let rounding = ROUNDING * (part.chain.len() + 2) as f64 * carried.farthest;
    let by = carried.off + rounding + carried.longer * error + place_error(size + error, carried.longer);
    Swept { bounds: part.reach.placed(&carried.place).widened(DVec3::splat(by)), farthest: carried.farthest + rounding }
}

/// A box, in the object's space, of all that joints ever make of some vertices.
pub(crate) fn bent_always(nodes: &NodeAnimation, skin: &Skin, rest: &[RestVertex]) -> Aabb {
    let body = Body { skin: 0, parts: parts(rest, skin.joint_count()) };
    let boxes = body.hung(nodes, skin).into_iter().flat_map(|part| {
        let below = part.chain[..part.carrier].to_vec();
        let mut keys: Vec<f64> = below.iter().flat_map(|node| node.key_times()).collect();
        keys.sort_by(f64::total_cmp);
        keys.dedup();
        let in_object = |span: Span| {
            let mut carried = part.begin(DVec3::ZERO, false);
            carried.up(&below, span, false);
            let error = bend_error(carried.farthest, carried.longer, largest(part.reach).max_element());
            let rounding = ROUNDING * (below.len() + 2) as f64 * carried.farthest;
            part.reach.placed(&carried.place).widened(DVec3::splat(carried.off + rounding + error))
        };
        spans(&keys, f64::NEG_INFINITY, f64::INFINITY).into_iter().map(in_object).collect::<Vec<_>>()
    });
    union(boxes)
}
