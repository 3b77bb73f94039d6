//! The bottom-up builder of obvhs: PLOC (Meister & Bittner 2018) and parallel reinsertion (Meister & Bittner 2022).
//!
//! obvhs works in `f32`, so it sees the scene moved to the origin and scaled to unit size. Only its topology is taken:
//! bounds come from the objects, in `f64`.

use super::split::Item;
use super::topology::Topology;
use super::DEPTH_LIMIT;
use crate::model::Aabb;
use glam::DVec3;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

/// Share of nodes that a pass of reinsertion takes up, as in the medium preset of obvhs.
const REINSERTED: f32 = 0.05;
/// Passes that look one neighbour far only, as in the medium preset of obvhs.
const NARROW_PASSES: usize = 3;

/// None if the tree is deeper than [`DEPTH_LIMIT`].
pub(super) fn build(items: &[Item]) -> Option<Topology> {
    let boxes = unit_boxes(items);
    let order = (0..items.len() as u32).collect();
    let mut tree = PlocBuilder::with_capacity(items.len()).build(
        PlocSearchDistance::Medium,
        &boxes,
        order,
        SortPrecision::U64,
        NARROW_PASSES,
    );
    ReinsertionOptimizer::default().run(&mut tree, REINSERTED, None);
    take_over(&tree, items)
}

/// How far a box is moved at most, of half the scene's longest side: sixteen steps of `f32` just below 1.
const JITTER: f64 = 1.0 / (1 << 20) as f64;

/// Boxes within about -1..=1, for obvhs, each moved a little.
///
/// PLOC merges mutual nearest neighbours. Where distances tie, as in a heap of equal boxes or a row of points, it may find
/// one such pair a pass, and makes a chain in quadratic time: 100,000 objects at a point took minutes. Moved, nothing ties.
fn unit_boxes(items: &[Item]) -> Vec<obvhs::aabb::Aabb> {
    let all = items.iter().fold(Aabb::EMPTY, |all, item| all.union(item.bounds));
    let centre = all.centre();
    // Objects at one point have no size to divide by.
    let unit = all.half_extent().max_element().max(f64::MIN_POSITIVE);
    let unit_box = |(index, item): (usize, &Item)| {
        let jitter = DVec3::from([0, 1, 2].map(|axis| JITTER * scatter(3 * index as u64 + axis)));
        let point = |point: DVec3| ((point - centre) / unit + jitter).as_vec3a();
        obvhs::aabb::Aabb::new(point(item.bounds.min), point(item.bounds.max))
    };
    items.iter().enumerate().map(unit_box).collect()
}

/// A number in -1..1 that looks random but is the same on each run (SplitMix64, Steele et al. 2014).
fn scatter(index: u64) -> f64 {
    let mut bits = (index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) as i64) as f64 / -(i64::MIN as f64)
}

/// Numbers the nodes anew in the order of a depth-first walk, so that children come after parents.
fn take_over(tree: &Bvh2, items: &[Item]) -> Option<Topology> {
    let below = objects_below(tree);
    let mut topology = Topology::with_root(items.len());
    let mut pairs = if items.is_empty() { Vec::new() } else { vec![(0, 0, 0)] };
    while let Some((theirs, ours, depth)) = pairs.pop() {
        if depth > DEPTH_LIMIT {
            return None;
        }
        let node = &tree.nodes[theirs as usize];
        if node.is_leaf() {
            let item = tree.primitive_indices[node.first_index as usize];
            topology.close(ours, items[item as usize].object, depth);
            continue;
        }
        let first = node.first_index;
        let child = topology.fork(ours, [first, first + 1].map(|child| below[child as usize]));
        pairs.push((first + 1, child + 1, depth + 1));
        pairs.push((first, child, depth + 1));
    }
    Some(topology)
}

/// For each node of obvhs, which need not come after its parent.
fn objects_below(tree: &Bvh2) -> Vec<usize> {
    let mut order = Vec::with_capacity(tree.nodes.len());
    let mut open = if tree.nodes.is_empty() { Vec::new() } else { vec![0u32] };
    while let Some(node) = open.pop() {
        order.push(node as usize);
        let node = &tree.nodes[node as usize];
        if !node.is_leaf() {
            open.extend([node.first_index, node.first_index + 1]);
        }
    }
    let mut below = vec![1; tree.nodes.len()];
    for index in order.into_iter().rev() {
        let node = &tree.nodes[index];
        if !node.is_leaf() {
            let first = node.first_index as usize;
            below[index] = below[first] + below[first + 1];
        }
    }
    below
}
