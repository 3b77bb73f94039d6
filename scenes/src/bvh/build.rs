//! From boxes to nodes, top-down. No recursion: what is still to be cut lies on a stack.

use super::split::{self, Item};
use super::topology::Topology;
use super::validate::check;
use super::{ploc, refit, BadBounds, Bvh, BvhError, BvhOptions, Split, DEPTH_LIMIT, NO_NODE};
use crate::model::Aabb;

/// 2N - 1 nodes must have numbers below [`NO_NODE`].
const MOST_OBJECTS: usize = (NO_NODE / 2) as usize;

/// Levels that a tree may use beyond twice those of a balanced one.
const SPARE_LEVELS: u32 = 8;

pub(super) fn build(bounds: &[Aabb], options: BvhOptions) -> Result<Bvh, BvhError> {
    if bounds.len() > MOST_OBJECTS {
        return Err(BvhError::TooMany { objects: bounds.len(), limit: MOST_OBJECTS });
    }
    let (mut items, unbounded) = sort_out(bounds, options.bad_bounds)?;
    let (topology, split) = match options.split {
        Split::Ploc => match ploc::build(&items) {
            Some(topology) => (topology, Split::Ploc),
            None => {
                tracing::warn!("the PLOC tree over {} objects is too deep; SAH is used instead", items.len());
                (top_down(&mut items, Split::Sah), Split::Sah)
            }
        },
        split => (top_down(&mut items, split), split),
    };
    let mut leaf_of_object = vec![NO_NODE; bounds.len()];
    for (index, node) in topology.nodes.iter().enumerate() {
        if let Some(object) = node.object() {
            leaf_of_object[object as usize] = index as u32;
        }
    }
    let Topology { nodes, parents, depth } = topology;
    let built = refit::Expense::default();
    let mut bvh = Bvh { nodes, parents, leaf_of_object, unbounded, split, depth, built };
    bvh.fit(bounds);
    bvh.built = bvh.expense();
    Ok(bvh)
}

/// The objects that go into the tree, and those that do not.
fn sort_out(bounds: &[Aabb], bad_bounds: BadBounds) -> Result<(Vec<Item>, Vec<u32>), BvhError> {
    let mut items = Vec::with_capacity(bounds.len());
    let mut unbounded = Vec::new();
    for (object, bounds) in bounds.iter().enumerate() {
        match (check(object, bounds), bad_bounds) {
            (Ok(()), _) => items.push(Item { bounds: *bounds, object: object as u32 }),
            (Err(error), BadBounds::Refuse) => return Err(error),
            (Err(error), BadBounds::SetAside) => {
                if unbounded.is_empty() {
                    tracing::warn!("{error}");
                }
                unbounded.push(object as u32);
            }
        }
    }
    if !unbounded.is_empty() {
        tracing::warn!("{} objects without usable bounds stay outside the tree and count as visible", unbounded.len());
    }
    Ok((items, unbounded))
}

/// A set of objects that is yet to become the subtree of a node.
struct Task {
    node: u32,
    first: usize,
    end: usize,
    depth: u32,
}

fn top_down(items: &mut [Item], split: Split) -> Topology {
    let mut topology = Topology::with_root(items.len());
    let limit = depth_limit(items.len());
    let mut tasks = Vec::with_capacity(DEPTH_LIMIT as usize + 1);
    if !items.is_empty() {
        tasks.push(Task { node: 0, first: 0, end: items.len(), depth: 0 });
    }
    while let Some(Task { node, first, end, depth }) = tasks.pop() {
        let below = &mut items[first..end];
        if let [item] = below {
            topology.close(node, item.object, depth);
            continue;
        }
        // Keeps `depth + levels(count) <= limit` for both children: any cut adds one level and no objects, and where there
        // is none to spare, halves have one level less to come.
        let must_halve = depth + levels(below.len()) >= limit;
        let left = split::cut(below, if must_halve { Split::EqualCount } else { split });
        let child = topology.fork(node, [left, below.len() - left]);
        let middle = first + left;
        tasks.push(Task { node: child + 1, first: middle, end, depth: depth + 1 });
        tasks.push(Task { node: child, first, end: middle, depth: depth + 1 });
    }
    topology
}

/// Levels below a node over so many objects if each is halved: the binary logarithm, rounded up.
fn levels(objects: usize) -> u32 {
    objects.next_power_of_two().ilog2()
}

/// See [`DEPTH_LIMIT`].
pub(super) fn depth_limit(objects: usize) -> u32 {
    (2 * levels(objects) + SPARE_LEVELS).min(DEPTH_LIMIT)
}
