//! Twin of the occludee group extraction (thesis, section III.3 and figure 3).

use super::{Bvh, NO_NODE};

/// The flag on a node after the extraction. As numbers, what the GPU writes: a buffer of zeros is all [`NodeState::Nil`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum NodeState {
    /// Below a group: known only through it. The thesis's "nil".
    #[default]
    Nil = 0,
    /// Holds an effective occluder, which is this leaf or lies below. The thesis's "v".
    Visible = 1,
    /// Holds no effective occluder, but its sibling does: a batch of occludees to be tested as one box. The thesis's "g".
    Group = 2,
}

/// Marks each node, from one flag per object that says whether it is an effective occluder. Flags of objects that are not in
/// the tree, see [`Bvh::unbounded`], mark nothing.
///
/// The leaves are divided without rest: each is an occluder, or below exactly one group (or that group itself). Without an
/// occluder in the tree the root is the one group. An empty tree has no nodes and no groups.
///
/// # Panics
/// If there is not one flag for each object that the tree was built from.
pub fn extract_groups(bvh: &Bvh, occluders: &[bool]) -> Vec<NodeState> {
    assert_eq!(occluders.len(), bvh.leaf_of_object().len(), "one flag for each object");
    let objects = occluders.iter().enumerate().filter(|(_, occluder)| **occluder);
    extract_groups_from(bvh, objects.map(|(object, _)| object as u32))
}

/// As [`extract_groups`], from the occluders themselves, visited in the order given. The result does not depend on it, nor on
/// how often an object is named: a node ends visible exactly if an occluder is below it, a group exactly if it does not but
/// its sibling does.
///
/// One detail goes beyond the words of the thesis, which stops where a node is "not nil": a node that an earlier traversal
/// left as a group, for being a sibling, turns visible when a later one comes through it. Else an occluder would lie inside
/// a group, or not, by the order of traversals.
///
/// # Panics
/// If there is no such object.
pub fn extract_groups_from(bvh: &Bvh, occluders: impl IntoIterator<Item = u32>) -> Vec<NodeState> {
    let mut states = vec![NodeState::Nil; bvh.nodes().len()];
    for object in occluders {
        let leaf = bvh.leaf_of_object()[object as usize];
        if leaf != NO_NODE {
            mark_path(bvh, leaf, &mut states);
        }
    }
    if states.first() == Some(&NodeState::Nil) {
        states[0] = NodeState::Group;
    }
    states
}

/// From an effective occluder up to the root, or to where another traversal has been.
fn mark_path(bvh: &Bvh, leaf: u32, states: &mut [NodeState]) {
    let mut node = leaf;
    while node != NO_NODE && states[node as usize] != NodeState::Visible {
        states[node as usize] = NodeState::Visible;
        if let Some(sibling) = bvh.sibling(node) {
            let sibling = &mut states[sibling as usize];
            if *sibling != NodeState::Visible {
                *sibling = NodeState::Group;
            }
        }
        node = bvh.parents()[node as usize];
    }
}
