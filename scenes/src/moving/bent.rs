//! Bounds of deformed meshes. The box of a skinned mesh is the box around those of its joints; any other mesh is one part.
//!
//! **Derivation.** A vertex v is the mean `sum w M v` of the places that its joints give it, with weights w >= 0 that add up to 1 + d.
//! The box of a joint ([`Reach`] of the vertices that it carries in part, transformed) holds the places `M v` of these vertices. The
//! box around all joints' boxes is convex and holds every place `M v`, so it holds their means. That is so at any time, and also for
//! boxes that hold a joint's vertices within a span of time.
//!
//! **Rounding.** `world/skin_vertices` rounds M to f32, mixes j products (of an entry of M and a weight: a rounding each, and j - 1
//! sums), and multiplies by v (a product, three sums). With u = 2^-24 each term is off by a factor within (1 + u)^(j + 5). So along an
//! axis the whole is off by at most (j + 5) u of `sum w S`, S = |row of M| |v| + |shift|. The sum of weights is off by d, at most u /
//! 2, which adds that much: under (j + 6) u. The rest of (j + 6) u (1 + 2^-16) covers the rounding of this file in f64. Each joint's
//! box is widened by (j + 6) u of its own S: the mean of these boxes then has room for the mean of S. The loss of numbers below f32's
//! smallest normal one is added likewise. The object's transform comes after that, and rounds as it does for every mesh. A vertex that
//! morph targets displace is bent from where the device puts it: v is any point of its [`Points`], whose reach has room for the
//! rounding of displacements.

use super::carried::{chain, Hung};
use super::morphed::{displacements, Points, Weights};
use super::spread::Span;
use super::{spans, sweep, swept_whole, union, MovingBounds, Sweep, Swept, WeightTimes, ROUNDING, SPANS};
use crate::animation::{Attachment, NodeAnimation, Track};
use crate::bounds::{Reach, SMALLEST, TRANSFORM_ERROR};
use crate::model::{Aabb, Scene};
use crate::morph::{Deformed, Shapes};
use crate::skin::{Skin, JOINTS_A_VERTEX};
use glam::{DAffine3, DVec3};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// Relative error of bending: see the head of this file.
const BEND_ERROR: f64 = (JOINTS_A_VERTEX + 6) as f64 / 16_777_216.0 * (1.0 + 1.0 / 65_536.0);

/// The body of an object whose mesh is deformed.
#[derive(Clone, Debug)]
pub(super) struct Body {
    /// None if morph targets alone deform it.
    skin: Option<u32>,
    parts: Vec<Part>,
    weights: Weights,
    /// The middle of all its shapes, in object space. The origin with a skin.
    middle: DVec3,
    /// The reach of each part for all weights of the animation. Computed when it is first needed.
    ever: OnceLock<Vec<Reach>>,
}

/// Vertices that one joint carries some of; all of them where there is no skin.
#[derive(Clone, Debug)]
struct Part {
    joint: Option<usize>,
    points: Points,
}

/// The bodies of a scene's moving objects, in the order of `Motion::transforms_at`. Empty if no mesh is deformed. Objects with the same
/// mesh share a body: a file can have a million instances.
pub(super) fn bodies(scene: &Scene) -> Vec<Option<Arc<Body>>> {
    let crate::animation::Motion::Nodes(nodes) = &scene.motion else { return Vec::new() };
    if scene.deformed.is_empty() {
        return Vec::new();
    }
    let body = |deformed: &Deformed| {
        let skin = deformed.skin.map(|skin| &scene.skins[skin as usize]);
        (deformed.mesh, Arc::new(Body::new(nodes, skin, deformed)))
    };
    let of_mesh: BTreeMap<u32, Arc<Body>> = scene.deformed.iter().map(body).collect();
    nodes.objects().iter().map(|on| of_mesh.get(&scene.objects[on.object as usize].mesh).cloned()).collect()
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
    fn new(nodes: &NodeAnimation, skin: Option<&Skin>, deformed: &Deformed) -> Self {
        let (weights, moves) = (Weights::of(deformed), displacements(deformed));
        let ever = weights.ever(nodes);
        let points = |vertices: &mut dyn Iterator<Item = usize>| {
            let vertex = |at: usize| (deformed.rest[at].position.as_dvec3(), &moves[at][..]);
            Points::new(vertices.map(vertex), &ever)
        };
        let Some(skin) = skin else {
            let points = points(&mut (0..deformed.rest.len()));
            let middle = points.reach(&ever).in_object_space().centre();
            return Body {
                skin: None,
                parts: vec![Part { joint: None, points }],
                weights,
                middle,
                ever: OnceLock::new(),
            };
        };
        let mut carried: Vec<Vec<usize>> = vec![Vec::new(); skin.joint_count()];
        for (at, vertex) in deformed.rest.iter().enumerate() {
            vertex.influences().for_each(|(joint, _)| carried[joint as usize].push(at));
        }
        let some = carried.into_iter().enumerate().filter(|(_, vertices)| !vertices.is_empty());
        let part = |(joint, vertices): (usize, Vec<usize>)| Part {
            joint: Some(joint),
            points: points(&mut vertices.into_iter()),
        };
        Body {
            skin: deformed.skin,
            parts: some.map(part).collect(),
            weights,
            middle: DVec3::ZERO,
            ever: OnceLock::new(),
        }
    }

    /// Computes its bounds at one place and in one shape.
    pub(super) fn bounds(&self, world_from_object: &DAffine3, shapes: &Shapes) -> Aabb {
        let weights = self.weights.now(&shapes.weights);
        let places = self.skin.map(|skin| shapes.joints.of(skin));
        union(self.parts.iter().map(|part| {
            let reach = part.points.reach_now(&weights);
            match part.joint.zip(places) {
                Some((joint, places)) => part_bounds(&reach, world_from_object, &places[joint]),
                None => reach.transformed(world_from_object),
            }
        }))
    }

    /// Computes its boxes for the whole of a motion. Spends the work from `left`. Where that is not enough, weights may have any of
    /// their values in each span.
    pub(super) fn on_nodes(
        &self,
        nodes: &NodeAnimation,
        skins: &[Skin],
        on: &Attachment,
        (mode, left): (MovingBounds, &mut u64),
    ) -> Sweep {
        let turned = mode == MovingBounds::InPlace;
        let hung = self.hung(nodes, self.skin.map(|skin| &skins[skin as usize]), on);
        let mut times = self.weight_times(nodes);
        let ever = match left.checked_sub(self.steps(&hung, &times, mode)) {
            Some(rest) => {
                *left = rest;
                None
            }
            None => {
                // Nothing depends on the time of a weight's key.
                times.keys.clear();
                Some(self.ever(nodes))
            }
        };
        let swept = |part: usize, span: Span| {
            let (Part { joint, points }, hung) = (&self.parts[part], &hung[part]);
            let reach = match ever {
                Some(ever) => Cow::Borrowed(&ever[part]),
                None => points.reach(&self.weights.during(nodes, span)),
            };
            match joint {
                Some(_) => swept(&reach, hung, span, turned),
                None => swept_whole(&reach, hung, span, turned.then_some(self.middle)),
            }
        };
        sweep(&hung, (&times, mode), self.middle, swept)
    }

    /// Returns the reach of each part for all weights of the animation.
    fn ever(&self, nodes: &NodeAnimation) -> &[Reach] {
        self.ever.get_or_init(|| {
            let ranges = self.weights.ever(nodes);
            self.parts.iter().map(|part| part.points.reach(&ranges).into_owned()).collect()
        })
    }

    /// Counts the weights and displacements that all spans of a sweep look at: an upper bound.
    fn steps(&self, hung: &[Hung<'_>], times: &WeightTimes, mode: MovingBounds) -> u64 {
        let of_part = |(part, hung): (&Part, &Hung<'_>)| {
            let node_keys: usize = hung.chain.iter().map(|node| node.key_times().count()).sum();
            let node_ends: usize = hung.chain.iter().map(|node| node.track_ends().count()).sum();
            let cuts = if mode == MovingBounds::PerAnimation { node_ends + times.ends.len() } else { 0 };
            let spans = node_keys + times.keys.len() + (SPANS + 1) * (cuts + 1);
            let each = self.weights.0.len() as u64 + part.points.steps();
            (spans as u64).saturating_mul(each)
        };
        self.parts.iter().zip(hung).map(of_part).fold(0, u64::saturating_add)
    }

    /// Returns the times at which its weights change.
    fn weight_times(&self, nodes: &NodeAnimation) -> WeightTimes {
        let tracks: Vec<&Track<f64>> = self.weights.0.iter().map(|weight| &nodes.weights()[*weight as usize]).collect();
        let ends = tracks.iter().map(|track| track.duration_s()).flat_map(|(first, last)| [first, last]);
        // All weights of an animation channel share one list of times.
        let mut lists: Vec<&[f64]> = tracks.iter().map(|track| track.times()).collect();
        lists.dedup_by_key(|times| times.as_ptr());
        let mut keys: Vec<f64> = lists.into_iter().flatten().copied().collect();
        keys.sort_by(f64::total_cmp);
        keys.dedup();
        WeightTimes { keys, ends: ends.collect() }
    }

    /// Hangs each part on its joint's node, or on the object's node.
    fn hung<'a>(&self, nodes: &'a NodeAnimation, skin: Option<&Skin>, on: &Attachment) -> Vec<Hung<'a>> {
        let world_from_tree = on.world_from_tree;
        let above_anchor = chain(nodes, on.node).len();
        let hang = |part: &Part| match part.joint.zip(skin) {
            Some((joint, skin)) => {
                let joint = skin.joints()[joint];
                let chain = chain(nodes, joint.node);
                let carrier = chain.len() - above_anchor;
                Hung { node_from_part: joint.joint_from_rest, carrier, chain, world_from_tree }
            }
            None => {
                let chain = chain(nodes, on.node);
                Hung { node_from_part: on.node_from_object, carrier: 0, chain, world_from_tree }
            }
        };
        self.parts.iter().map(hang).collect()
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

/// Computes where the vertices of a joint can be in the world within a span. `reach` is that of the vertices at rest. See the head of
/// `moving.rs`; with `turned` they stay where the anchor is.
fn swept(reach: &Reach, part: &Hung<'_>, span: Span, turned: bool) -> Swept {
    let (below, above) = part.chain.split_at(part.carrier);
    let mut carried = part.begin(reach, DVec3::ZERO, false);
    carried.up(below, span, false);
    let (size, longer) = (carried.farthest, std::mem::replace(&mut carried.longer, 1.0));
    carried.up(above, span, turned);
    carried.up_to_world(part, turned);
    // An error along each of three axes.
    let error = 3f64.sqrt() * bend_error(size, longer, largest(reach).max_element());
    let rounding = ROUNDING * (part.chain.len() + 2) as f64 * carried.farthest;
    let by = carried.off + rounding + carried.longer * error + place_error(size + error, carried.longer);
    Swept { bounds: reach.placed(&carried.place).widened(DVec3::splat(by)), farthest: carried.farthest + rounding }
}

/// Computes a box, in object space, of all shapes that a mesh ever has. Weights may have any of their values at any time: with a step
/// for each of their keys, a small file could take hours.
pub(crate) fn always(nodes: &NodeAnimation, skin: Option<&Skin>, deformed: &Deformed) -> Aabb {
    let body = Body::new(nodes, skin, deformed);
    let ever = body.weights.ever(nodes);
    let reaches = body.parts.iter().map(|part| part.points.reach(&ever));
    let Some(skin) = skin else {
        return union(reaches.map(|reach| reach.in_object_space()));
    };
    let hung = body.hung(nodes, Some(skin), &Attachment::new(0, skin.anchor()));
    let boxes = hung.into_iter().zip(reaches).flat_map(|(hung, reach)| {
        let below = &hung.chain[..hung.carrier];
        let mut keys: Vec<f64> = below.iter().flat_map(|node| node.key_times()).collect();
        keys.sort_by(f64::total_cmp);
        keys.dedup();
        let spans = spans(&keys, f64::NEG_INFINITY, f64::INFINITY);
        spans.into_iter().map(|span| in_object(&reach, &hung, span)).collect::<Vec<_>>()
    });
    union(boxes)
}

/// Computes the box, in object space, of the vertices of a joint within a span. `reach` is that of the vertices at rest.
fn in_object(reach: &Reach, hung: &Hung<'_>, span: Span) -> Aabb {
    let below = &hung.chain[..hung.carrier];
    let mut carried = hung.begin(reach, DVec3::ZERO, false);
    carried.up(below, span, false);
    let error = bend_error(carried.farthest, carried.longer, largest(reach).max_element());
    let rounding = ROUNDING * (below.len() + 2) as f64 * carried.farthest;
    reach.placed(&carried.place).widened(DVec3::splat(carried.off + rounding + error))
}
