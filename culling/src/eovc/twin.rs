//! EOVC's compute stages in plain Rust: their definition. The hierarchy's own twins (groups by the thesis' words, rays) are in
//! `scenes::bvh`.

use crate::boxes::twin::{crosses_near, grown};
use crate::frustum::twin::{clip_from_bounds, footprint_widening, outside_frustum};
use crate::hzb::twin::footprint_of;
use scenes::bvh::{Bvh, NO_NODE};
use shaders::types::{CullView, TreeNode};

/// Twin of the constant in `eovc/extract_groups`.
const TRUST_IN_HIDDEN: u32 = 16;

/// 1 for each node on a way from an effective occluder to the root. Twin of `eovc/mark_paths`.
pub fn mark_paths(bvh: &Bvh, occluders: &[u32]) -> Vec<u32> {
    let mut marked = vec![0; bvh.nodes().len()];
    for object in (0..occluders.len()).filter(|object| occluders[*object] != 0) {
        let mut node = bvh.leaf_of_object()[object];
        while node != NO_NODE && marked[node as usize] == 0 {
            marked[node as usize] = 1;
            node = bvh.parents()[node as usize];
        }
    }
    marked
}

/// What `eovc/extract_groups` knows of earlier frames.
#[derive(Clone, Copy, Debug)]
pub struct Coherence<'a> {
    /// The last frame in which each node was tested.
    pub tested: &'a [u32],
    /// The last frame in which a pixel saw into each node.
    pub touched: &'a [u32],
    /// This frame.
    pub frame: u32,
    /// Pixels that a group may cover of which nothing is known.
    pub most_pixels: u32,
}

/// The groups and single objects (as nodes) whose boxes are rasterised, and the objects hit without a test, all ascending.
/// `coherence` is none for the thesis' own groups. Twin of `eovc/extract_groups`.
pub fn extract_groups(
    nodes: &[TreeNode],
    marked: &[u32],
    view: &CullView,
    coherence: Option<Coherence<'_>>,
) -> [Vec<u32>; 3] {
    let [mut groups, mut singles, mut hits] = [const { Vec::new() }; 3];
    let is_group = |node: usize| {
        let parent = nodes[node].parent;
        marked[node] == 0 && (parent == NO_NODE || marked[parent as usize] != 0)
    };
    let mut left: Vec<u32> = (0..nodes.len()).filter(|node| is_group(*node)).map(|node| node as u32).collect();
    while let Some(index) = left.pop() {
        let node = &nodes[index as usize];
        let (clip, flags) = (clip_from_bounds(&node.bounds, view), node.bounds.flags);
        if outside_frustum(&clip, footprint_widening(flags, view)) {
            continue;
        }
        let reaches_near = crosses_near(&clip_from_bounds(&grown(&node.bounds, view), view));
        let opens = |known: Coherence<'_>| {
            let footprint = footprint_of(&clip, view, flags);
            let pixels = |axis: usize| footprint.last[axis] - footprint.first[axis] + 1;
            let last_frame = known.frame - 1;
            let trust = if known.tested[index as usize] == last_frame { TRUST_IN_HIDDEN } else { 1 };
            known.touched[index as usize] == last_frame || pixels(0) * pixels(1) > known.most_pixels * trust
        };
        match (reaches_near, node.is_leaf != 0) {
            (true, true) => hits.push(node.first_child),
            (false, true) => singles.push(index),
            (false, false) if !coherence.is_some_and(opens) => groups.push(index),
            _ => left.extend([node.first_child, node.first_child + 1]),
        }
    }
    [groups, singles, hits].map(|mut list| {
        list.sort_unstable();
        list
    })
}

/// What the rays hit and was not drawn. Twin of `eovc/select_occludees`.
pub fn select_occludees(hits: &[u32], drawn: &[u32]) -> Vec<u32> {
    hits.iter().zip(drawn).map(|(hit, drawn)| u32::from(*hit != 0 && *drawn == 0)).collect()
}

/// Marks the way from each node touched in `frame` to the root. Twin of `eovc/touch_paths`.
pub fn touch_paths(nodes: &[TreeNode], touched: &mut [u32], frame: u32) {
    for node in (0..nodes.len()).filter(|node| touched[*node] == frame).collect::<Vec<_>>() {
        let mut above = nodes[node].parent;
        while above != NO_NODE && touched[above as usize] != frame {
            touched[above as usize] = frame;
            above = nodes[above as usize].parent;
        }
    }
}
