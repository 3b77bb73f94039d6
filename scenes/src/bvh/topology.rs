//! The shape of a tree while it is built.

use super::{Node, NO_NODE};
use crate::model::Aabb;

/// Nodes without bounds, parents before children.
pub(super) struct Topology {
    pub(super) nodes: Vec<Node>,
    pub(super) parents: Vec<u32>,
    pub(super) depth: u32,
}

impl Topology {
    /// A root with so many objects below it, not yet linked to anything.
    pub(super) fn with_root(objects: usize) -> Self {
        let mut nodes = Vec::with_capacity((2 * objects).saturating_sub(1));
        let mut parents = Vec::with_capacity(nodes.capacity());
        if objects > 0 {
            nodes.push(open_node(objects));
            parents.push(NO_NODE);
        }
        Topology { nodes, parents, depth: 0 }
    }

    /// Makes a node a leaf.
    pub(super) fn close(&mut self, node: u32, object: u32, depth: u32) {
        self.nodes[node as usize].first_child_or_object = object;
        self.depth = self.depth.max(depth);
    }

    /// Gives a node two children and returns the first.
    pub(super) fn fork(&mut self, node: u32, objects_below: [usize; 2]) -> u32 {
        let first = self.nodes.len() as u32;
        self.nodes[node as usize].first_child_or_object = first;
        self.nodes.extend(objects_below.map(open_node));
        self.parents.extend([node; 2]);
        first
    }
}

fn open_node(objects: usize) -> Node {
    Node { bounds: Aabb::EMPTY, first_child_or_object: NO_NODE, objects_below: objects as u32 }
}
