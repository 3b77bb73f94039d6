//! New bounds in the old tree, what a tree costs, and when to build it anew.

use super::validate::check;
use super::{Bvh, BvhError, NO_NODE};
use crate::model::Aabb;

/// How far the cost may grow before a new tree pays, as a factor; for [`Bvh::needs_rebuild`].
///
/// In the scene city-block a tree by [`Split::Middle`](super::Split::Middle) costs 1.49 times one by SAH, and the thesis
/// (table 4) finds frame times of the two at most 11 % apart: a tree worn down by less is not worth a new one.
pub const REBUILD_FACTOR: f64 = 1.5;

/// What a tree costs, in two measures.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Expense {
    /// See [`Bvh::cost`].
    cost: f64,
    /// The same without the division by the root's area: half the surface of all nodes, in square metres.
    half_area: f64,
}

impl Bvh {
    /// Gives each object new bounds, in metres, in world space, and leaves the tree's shape as it is. An object that was set
    /// aside stays outside until the tree is built anew.
    ///
    /// # Errors
    /// [`BvhError::BadBounds`] names the first object in the tree whose new bounds are no box; nothing has changed then.
    ///
    /// # Panics
    /// If there are not as many bounds as when the tree was built.
    pub fn refit(&mut self, bounds: &[Aabb]) -> Result<(), BvhError> {
        assert_eq!(bounds.len(), self.leaf_of_object.len(), "a tree is refitted to the objects that it was built from");
        for (object, bounds) in bounds.iter().enumerate() {
            if self.leaf_of_object[object] != NO_NODE {
                check(object, bounds)?;
            }
        }
        self.fit(bounds);
        debug_assert_eq!(self.validate(), Ok(()));
        Ok(())
    }

    /// Children come after their parents: from the last node to the first, a node's children are always done.
    pub(super) fn fit(&mut self, bounds: &[Aabb]) {
        for index in (0..self.nodes.len()).rev() {
            let node = self.nodes[index];
            let first = node.first_child_or_object as usize;
            self.nodes[index].bounds = if node.is_leaf() {
                bounds[first]
            } else {
                self.nodes[first].bounds.union(self.nodes[first + 1].bounds)
            };
        }
    }

    /// How many nodes a random ray through the root's box meets, on average, by the surface area heuristic: the sum over all
    /// nodes of a node's area over the root's (MacDonald & Booth 1990, every node at a cost of 1). From 1 to 2N - 1; 0 for an
    /// empty tree. Where the root has no area, as with objects on one line, each node counts as met.
    pub fn cost(&self) -> f64 {
        self.expense().cost
    }

    /// The tree has grown dearer than `factor` times what it was when built: by [`Bvh::cost`], or by the surface of all nodes
    /// in square metres, which sees what the first cannot: an object that flies away makes the root's box larger, and so
    /// each other node smaller beside it.
    ///
    /// One pass over the nodes is all it costs; a new tree takes the new cost for its measure. `factor` is above 1.
    pub fn needs_rebuild(&self, factor: f64) -> bool {
        let now = self.expense();
        now.cost > factor * self.built.cost || now.half_area > factor * self.built.half_area
    }

    pub(super) fn expense(&self) -> Expense {
        let Some(root) = self.nodes.first() else { return Expense::default() };
        // Areas are measured with the root's longest half side as unit, so they neither overflow nor vanish.
        let unit = root.bounds.half_extent().max_element();
        let root_area = scaled_area(&root.bounds, unit);
        if root_area > 0.0 {
            let sum: f64 = self.nodes.iter().map(|node| scaled_area(&node.bounds, unit)).sum();
            Expense { cost: sum / root_area, half_area: 4.0 * sum * unit * unit }
        } else {
            Expense { cost: self.nodes.len() as f64, half_area: 0.0 }
        }
    }
}

/// An eighth of a box's surface, in squares of a unit; 0 where the unit is 0.
fn scaled_area(bounds: &Aabb, unit: f64) -> f64 {
    if unit == 0.0 {
        return 0.0;
    }
    let half = bounds.half_extent() / unit;
    half.x * half.y + half.y * half.z + half.z * half.x
}
