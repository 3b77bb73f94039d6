//! EOVC's compute stages in plain Rust: their definition. The hierarchy's own twins (groups by the thesis' words, rays) are in
//! `scenes::bvh`.

use crate::boxes::twin::{crosses_near, grown};
use crate::frustum::twin::{clip_from_bounds, left_out};
use scenes::bvh::{Bvh, NO_NODE};
use shaders::types::{CullView, TreeNode, ITEM_NONE, OBJECT_ALWAYS_KEPT, RAY_OBJECTS};

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

/// The occludee groups, ascending: nodes that are not marked below one that is, or the root if nothing is. Twin of
/// `eovc/extract_groups`.
pub fn extract_groups(nodes: &[TreeNode], marked: &[u32]) -> Vec<u32> {
    let is_group = |node: &u32| {
        let parent = nodes[*node as usize].parent;
        marked[*node as usize] == 0 && (parent == NO_NODE || marked[parent as usize] != 0)
    };
    (0..nodes.len() as u32).filter(is_group).collect()
}

/// What becomes of groups before they are rasterised, as nodes and objects, all ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Culled {
    /// Groups whose boxes are rasterised.
    pub groups: Vec<u32>,
    /// Groups of one object, as nodes.
    pub singles: Vec<u32>,
    /// Objects that count as visible without a test.
    pub hits: Vec<u32>,
}

/// Drops groups outside the view volume and opens some. `seen_into` says for each node whether a pixel of a recent frame saw
/// into it; none for the thesis' own groups. Twin of `eovc/cull_groups`.
pub fn cull_groups(
    nodes: &[TreeNode],
    groups: &[u32],
    view: &CullView,
    nothing_hides: bool,
    seen_into: Option<&[bool]>,
) -> Culled {
    let mut culled = Culled::default();
    let mut left = groups.to_vec();
    while let Some(index) = left.pop() {
        let node = &nodes[index as usize];
        let (clip, flags) = (clip_from_bounds(&node.bounds, view), node.bounds.flags);
        let kept = flags & OBJECT_ALWAYS_KEPT != 0;
        if !kept && left_out(&clip, flags, view) {
            continue;
        }
        let shows = kept || nothing_hides || crosses_near(&clip_from_bounds(&grown(&node.bounds, view), view));
        let opens =
            shows || node.object_count > RAY_OBJECTS || seen_into.is_some_and(|seen_into| seen_into[index as usize]);
        match (node.is_leaf != 0, opens) {
            (true, _) if shows => culled.hits.push(node.first_child),
            (true, _) => culled.singles.push(index),
            (false, true) => left.extend([node.first_child, node.first_child + 1]),
            (false, false) => culled.groups.push(index),
        }
    }
    [&mut culled.groups, &mut culled.singles, &mut culled.hits].into_iter().for_each(|list| list.sort_unstable());
    culled
}

/// What the rays hit and was not drawn. Twin of `eovc/select_occludees`.
pub fn select_occludees(hits: &[u32], drawn: &[u32]) -> Vec<u32> {
    hits.iter().zip(drawn).map(|(hit, drawn)| u32::from(*hit != 0 && *drawn == 0)).collect()
}

/// Whoever owns a pixel. Twin of `eovc/filter_occluders`.
pub fn filter_occluders(owners: &[u32], object_count: usize) -> Vec<u32> {
    let mut occluders = vec![0; object_count];
    owners.iter().filter(|owner| **owner != ITEM_NONE).for_each(|owner| occluders[*owner as usize] = 1);
    occluders
}
