//! The geometry-level bounding volume hierarchy: a binary tree over the boxes of objects, one object a leaf.
//!
//! "Our solution builds the geometry-level BVH for the entire scene in the offline process" (EOVC thesis, section III.1):
//! N objects give 2N - 1 nodes (its table 1), split by SAH, middle or equal counts (its table 4). Bounds are in `f64` world
//! space, in metres, so that scenes far from the origin lose nothing; who uploads them rounds them outward.
//!
//! | file | holds |
//! |---|---|
//! | `build` | from boxes to nodes: what is refused, the order of nodes, the bound on depth |
//! | `split` | where to cut a set of objects: SAH, middle, equal counts |
//! | `ploc` | the bottom-up builder of obvhs |
//! | `refit` | new bounds in the old tree; what the tree costs; when to build anew |
//! | `groups` | twin of the occludee group extraction (thesis, section III.3) |
//! | `rays` | twin of the ray traversal (thesis, section III.4) |
//! | `topology` | the shape of a tree while it is built |
//! | `validate` | what must hold of bounds, and in every tree |

mod build;
mod groups;
mod ploc;
mod rays;
mod refit;
mod split;
mod topology;
mod validate;

use crate::model::Aabb;
pub use groups::{extract_groups, extract_groups_from, NodeState};
pub use rays::hit_leaves;
pub use refit::REBUILD_FACTOR;

/// No node: the root's parent, and the leaf of an object that is not in the tree.
pub const NO_NODE: u32 = u32::MAX;

/// No tree is deeper: the root has depth 0, a leaf at most this. A depth-first traversal that stacks one sibling a level
/// needs this many entries.
///
/// It is a bound, not a hope: with N objects a tree is at most `2 * ceil(log2 N) + 8` deep, and never above 64, because a
/// set of objects that has used up what its size leaves of that depth is halved by count from there on. N < 2^31, so
/// halving alone needs at most 31 levels.
pub const DEPTH_LIMIT: u32 = 64;

/// How a set of objects is cut in two (thesis, table 4; the three names are those of Pharr et al., *Physically Based
/// Rendering*, section 4.3, which the cuts follow).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Split {
    /// Where the surface area heuristic is least: exact for up to 16 objects, over 16 bins an axis above (Wald 2007).
    #[default]
    Sah,
    /// In the middle of the centres' longest axis.
    Middle,
    /// In two halves of equal count along the centres' longest axis.
    EqualCount,
    /// No cut: nearest neighbours merged bottom-up, then optimised by reinsertion, both by obvhs (Meister & Bittner 2018,
    /// 2022). Where that gives more levels than [`DEPTH_LIMIT`], [`Split::Sah`] is used, with a warning.
    Ploc,
}

/// What to do with objects whose bounds are no box (thesis, figure 18: wrong bounds).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BadBounds {
    /// Build nothing and name the first such object.
    #[default]
    Refuse,
    /// Leave them out of the tree, in [`Bvh::unbounded`], with a warning. They must be taken for visible.
    SetAside,
}

/// How to build a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct BvhOptions {
    /// How a set of objects is cut in two.
    pub split: Split,
    /// What to do with bounds that are no box.
    pub bad_bounds: BadBounds,
}

/// Why there is no tree. Each message is one line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BvhError {
    /// An object's bounds are NaN, infinite or inverted.
    #[error("object {object}: its bounds are {fault} ({min} to {max}); correct them or set such objects aside")]
    BadBounds {
        /// Index of the object in the slice given.
        object: usize,
        /// "NaN", "infinite" or "inverted".
        fault: &'static str,
        /// Smallest corner as given.
        min: glam::DVec3,
        /// Largest corner as given.
        max: glam::DVec3,
    },
    /// More objects than nodes can be numbered for.
    #[error("{objects} objects are too many for one tree; at most {limit}")]
    TooMany {
        /// How many were given.
        objects: usize,
        /// How many there can be.
        limit: usize,
    },
}

/// One node: a box around all that is below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// The union of the bounds of the objects below, in metres, in world space. Exact: no rounding, no padding.
    pub bounds: Aabb,
    /// Of a leaf, its object; else the first child, whose neighbour in memory is the second.
    pub first_child_or_object: u32,
    /// How many objects are below; 1 says that this is a leaf, and there is no node with 0.
    pub objects_below: u32,
}

impl Node {
    /// Holds an object and has no children.
    pub fn is_leaf(&self) -> bool {
        self.objects_below == 1
    }

    /// The object of a leaf, as its index in the slice that the tree was built from.
    pub fn object(&self) -> Option<u32> {
        self.is_leaf().then_some(self.first_child_or_object)
    }

    /// Both children of a node that is not a leaf.
    pub fn children(&self) -> Option<[u32; 2]> {
        (!self.is_leaf()).then_some([self.first_child_or_object, self.first_child_or_object + 1])
    }
}

/// A tree over objects' bounds. The root is node 0; children are neighbours, come after their parent, and the first has an
/// odd number, so that the sibling of node `i > 0` is `((i - 1) ^ 1) + 1` (the layout of obvhs).
///
/// The same bounds in the same order always give the same tree.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    parents: Vec<u32>,
    leaf_of_object: Vec<u32>,
    unbounded: Vec<u32>,
    split: Split,
    depth: u32,
    built: refit::Expense,
}

impl Bvh {
    /// Builds a tree, refusing bounds that are no box. Points and flat boxes are boxes.
    ///
    /// # Errors
    /// [`BvhError::BadBounds`] names the first object whose bounds are NaN, infinite or inverted; [`BvhError::TooMany`] from
    /// 2^31 objects on.
    pub fn build(bounds: &[Aabb], split: Split) -> Result<Self, BvhError> {
        Self::build_with(bounds, BvhOptions { split, ..BvhOptions::default() })
    }

    /// Builds a tree over object bounds in metres, in world space. An object's number is its index in the slice.
    ///
    /// # Errors
    /// As [`Bvh::build`]; bad bounds only under [`BadBounds::Refuse`].
    pub fn build_with(bounds: &[Aabb], options: BvhOptions) -> Result<Self, BvhError> {
        let bvh = build::build(bounds, options)?;
        debug_assert_eq!(bvh.validate(), Ok(()));
        Ok(bvh)
    }

    /// All nodes, the root first; 2N - 1 for N objects in the tree, none for none.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The root; none without objects.
    pub fn root(&self) -> Option<u32> {
        (!self.nodes.is_empty()).then_some(0)
    }

    /// The parent of each node; [`NO_NODE`] for the root.
    pub fn parents(&self) -> &[u32] {
        &self.parents
    }

    /// The other child of a node's parent; none for the root.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn sibling(&self, node: u32) -> Option<u32> {
        assert!((node as usize) < self.nodes.len(), "node {node} of {}", self.nodes.len());
        (node > 0).then(|| ((node - 1) ^ 1) + 1)
    }

    /// The leaf of each object; [`NO_NODE`] for those in [`Bvh::unbounded`].
    pub fn leaf_of_object(&self) -> &[u32] {
        &self.leaf_of_object
    }

    /// Objects that are not in the tree because their bounds were no box, in ascending order. Nothing is known of where
    /// they are: take them for visible.
    pub fn unbounded(&self) -> &[u32] {
        &self.unbounded
    }

    /// How the tree was built. Differs from what was asked for only where [`Split::Ploc`] gave too deep a tree.
    pub fn split(&self) -> Split {
        self.split
    }

    /// How many steps it is from the root to the deepest leaf, at most [`DEPTH_LIMIT`]; 0 for one object or none.
    pub fn depth(&self) -> u32 {
        self.depth
    }
}
