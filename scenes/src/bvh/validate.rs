//! What must hold of bounds before a tree is built, and in every tree.

use super::{Bvh, BvhError, DEPTH_LIMIT, NO_NODE};
use crate::model::Aabb;

/// Are these bounds a box?
pub(super) fn check(object: usize, bounds: &Aabb) -> Result<(), BvhError> {
    if bounds.is_valid() {
        return Ok(());
    }
    let Aabb { min, max } = *bounds;
    let fault = if min.is_nan() || max.is_nan() {
        "NaN"
    } else if min.cmpgt(max).any() {
        "inverted"
    } else {
        "infinite"
    };
    Err(BvhError::BadBounds { object, fault, min, max })
}

impl Bvh {
    /// Checks the tree: N objects in 2N - 1 nodes, each object in exactly one leaf or set aside, children after their parents
    /// and in pairs, parents and siblings that agree, counts that add up, bounds that are the union of the children's, and the
    /// depth. Debug builds do so after each build and refit.
    ///
    /// # Errors
    /// The first fault, in one line that names the node or object.
    pub fn validate(&self) -> Result<(), String> {
        self.validate_objects()?;
        let mut depths = vec![0u32; self.nodes.len()];
        let mut deepest = 0;
        for index in 0..self.nodes.len() {
            self.validate_place(index)?;
            self.validate_below(index)?;
            if index > 0 {
                depths[index] = depths[self.parents[index] as usize] + 1;
                deepest = deepest.max(depths[index]);
            }
        }
        if deepest != self.depth || deepest > DEPTH_LIMIT {
            return Err(format!("the tree is {deepest} deep, recorded as {}, at most {DEPTH_LIMIT}", self.depth));
        }
        Ok(())
    }

    fn validate_objects(&self) -> Result<(), String> {
        let inside = self.leaf_of_object.iter().filter(|leaf| **leaf != NO_NODE).count();
        let expected = (2 * inside).saturating_sub(1);
        if self.nodes.len() != expected || self.parents.len() != expected {
            let (nodes, parents) = (self.nodes.len(), self.parents.len());
            return Err(format!("{inside} objects: {nodes} nodes and {parents} parents, not {expected}"));
        }
        for (object, leaf) in self.leaf_of_object.iter().enumerate() {
            let aside = self.unbounded.binary_search(&(object as u32)).is_ok();
            let in_leaf = self.nodes.get(*leaf as usize).is_some_and(|node| node.object() == Some(object as u32));
            if aside == in_leaf {
                return Err(format!("object {object}: leaf {leaf}, set aside: {aside}"));
            }
        }
        if self.unbounded.len() + inside != self.leaf_of_object.len() {
            return Err(format!(
                "{} objects are set aside, not {}",
                self.unbounded.len(),
                self.leaf_of_object.len() - inside
            ));
        }
        Ok(())
    }

    fn validate_place(&self, index: usize) -> Result<(), String> {
        let parent = self.parents[index];
        if index == 0 {
            return if parent == NO_NODE { Ok(()) } else { Err(format!("the root has the parent {parent}")) };
        }
        let children = self.nodes.get(parent as usize).and_then(|parent| parent.children());
        let pair = [index as u32, ((index as u32 - 1) ^ 1) + 1];
        let is_pair = children.is_some_and(|children| children.contains(&pair[0]) && children.contains(&pair[1]));
        if parent as usize >= index || !is_pair {
            return Err(format!("node {index} has the parent {parent}, whose children are {children:?}"));
        }
        Ok(())
    }

    fn validate_below(&self, index: usize) -> Result<(), String> {
        let node = &self.nodes[index];
        let Some([first, second]) = node.children() else {
            let object = node.first_child_or_object;
            let leaf = self.leaf_of_object.get(object as usize);
            if leaf != Some(&(index as u32)) || !node.bounds.is_valid() {
                return Err(format!(
                    "leaf {index} with {:?} holds object {object}, whose leaf is {leaf:?}",
                    node.bounds
                ));
            }
            return Ok(());
        };
        if first as usize <= index || first % 2 == 0 || second as usize >= self.nodes.len() {
            return Err(format!("node {index} of {} has the children {first} and {second}", self.nodes.len()));
        }
        let [first, second] = [first, second].map(|child| &self.nodes[child as usize]);
        let below = u64::from(first.objects_below) + u64::from(second.objects_below);
        if u64::from(node.objects_below) != below {
            return Err(format!("node {index} has {} objects below, its children have {below}", node.objects_below));
        }
        if node.bounds != first.bounds.union(second.bounds) {
            return Err(format!("node {index} has {:?}, not the union of its children's bounds", node.bounds));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::Split;
    use crate::model::Aabb;
    use glam::DVec3;

    type Plant<'a> = (&'a str, &'a dyn Fn(&mut Bvh));

    fn row() -> Bvh {
        let boxes: Vec<Aabb> =
            (0..6).map(|x| DVec3::splat(f64::from(x))).map(|at| Aabb { min: at, max: at + 0.5 }).collect();
        Bvh::build(&boxes, Split::Sah).unwrap()
    }

    #[test]
    fn each_planted_fault_is_found() {
        assert_eq!(row().validate(), Ok(()));
        let leaf = row().leaf_of_object[3] as usize;
        let plants: [Plant; 10] = [
            ("a box that lets a child out", &|bvh| bvh.nodes[0].bounds.max.y -= 0.1),
            ("a box too large", &|bvh| bvh.nodes[0].bounds.max.y += 0.1),
            ("a broken leaf box", &|bvh| bvh.nodes[leaf].bounds.min.x = f64::NAN),
            ("an object twice", &|bvh| bvh.nodes[leaf].first_child_or_object = 2),
            ("a wrong leaf", &|bvh| bvh.leaf_of_object.swap(1, 2)),
            ("a wrong parent", &|bvh| bvh.parents[10] = 0),
            ("a root with a parent", &|bvh| bvh.parents[0] = 0),
            ("a wrong count", &|bvh| bvh.nodes[0].objects_below += 1),
            ("a node too many", &|bvh| bvh.nodes.push(bvh.nodes[leaf])),
            ("a wrong depth", &|bvh| bvh.depth += 1),
        ];
        for (name, plant) in plants {
            let mut bvh = row();
            plant(&mut bvh);
            assert!(bvh.validate().is_err(), "{name} was not found");
        }
    }
}
