//! The hierarchy of `eovc` on the host, and what is remembered of each node.

use super::place::Place;
use super::recording::{Numbered, Recording};
use super::several::SeveralBoxes;
use crate::tree::{split, Tree};
use crate::{Result, Setup, TestedBoxes, View, World};
use glam::DVec3;
use scenes::bvh::NO_NODE;
use scenes::Aabb;
use shaders::types::{Bounds, CullView};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// What is remembered of a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct State {
    /// The last visit found it visible.
    pub(super) visible: bool,
    /// The frame of that visit; 0: none yet.
    pub(super) visited: u64,
    /// The frame from which on it was found hidden.
    pub(super) hidden_since: u64,
    /// The frame of the last, or of the next test of what is visible: as the method counts.
    pub(super) test: u64,
    /// It is drawn as a whole, though it is no leaf.
    pub(super) whole: bool,
}

impl State {
    /// The frame before found the node visible.
    fn was_visible(&self, frame: u64) -> bool {
        self.visible && self.visited + 1 == frame
    }

    /// Frames in a row for which the node has been hidden; 0 if that is not known.
    fn hidden_for(&self, frame: u64) -> u64 {
        if self.visited == 0 || self.visible {
            return 0;
        }
        frame - self.hidden_since
    }

    /// Notes that a frame looks at the node and has seen nothing of it yet.
    fn visit(&mut self, frame: u64) {
        if self.visited == 0 || self.visible {
            self.hidden_since = frame;
        }
        self.visible = false;
        self.visited = frame;
    }
}

/// The square of the least distance of a box to a point.
pub(super) fn distance(bounds: &Aabb, eye: DVec3) -> f64 {
    (bounds.min - eye).max(eye - bounds.max).max(DVec3::ZERO).length_squared()
}

/// The tree, what is known of its nodes, and the queue that brings them near to far.
pub(super) struct Hierarchy {
    pub(super) tree: Tree,
    /// Of leaves; none if each is asked about by the box that it has as a node.
    several: Option<SeveralBoxes>,
    states: Vec<State>,
    pub(super) frame: u64,
    unbounded: Vec<u32>,
    builds: u32,
    queue: BinaryHeap<Reverse<(u64, u32)>>,
    eye: DVec3,
    pub(super) view: CullView,
}

impl Hierarchy {
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self> {
        let tree = Tree::new(setup.gpu, setup.world, split(setup.options))?;
        let unbounded = tree.unbounded().iter().enumerate().filter(|(_, unbounded)| **unbounded != 0);
        Ok(Hierarchy {
            unbounded: unbounded.map(|(object, _)| object as u32).collect(),
            states: vec![State::default(); tree.len()],
            several: SeveralBoxes::new(setup)?,
            frame: 0,
            builds: tree.builds(),
            queue: BinaryHeap::new(),
            eye: DVec3::ZERO,
            view: CullView::default(),
            tree,
        })
    }

    /// Begins a frame. True if the tree is as it was; else nothing is remembered of its nodes.
    pub(super) fn begin(&mut self, world: &World, view: &View) -> Result<bool> {
        self.tree.follow(world)?;
        self.several.as_mut().map_or(Ok(()), |several| several.follow(world))?;
        let same = self.tree.builds() == self.builds;
        if !same {
            self.builds = self.tree.builds();
            self.forget();
        }
        self.frame += 1;
        self.eye = view.pose.position;
        self.view = view.cull();
        self.queue.clear();
        if !self.tree.is_empty() {
            self.push(0);
        }
        Ok(same)
    }

    /// Forgets what was seen.
    pub(super) fn forget(&mut self) {
        self.states.fill(State::default());
        self.frame = 0;
    }

    /// Objects that are not in the tree, or whose bounds cannot be tested: always drawn.
    pub(super) fn unbounded(&self) -> &[u32] {
        &self.unbounded
    }

    pub(super) fn state(&self, node: u32) -> &State {
        &self.states[node as usize]
    }

    pub(super) fn state_mut(&mut self, node: u32) -> &mut State {
        &mut self.states[node as usize]
    }

    /// The last frame looked at the node and found it visible.
    pub(super) fn was_visible(&self, node: u32) -> bool {
        self.state(node).was_visible(self.frame)
    }

    /// Frames in a row for which the node has been hidden; 0 if that is not known.
    pub(super) fn hidden_for(&self, node: u32) -> u64 {
        self.state(node).hidden_for(self.frame)
    }

    pub(super) fn place(&self, node: u32) -> Place {
        let own = Place::of(&self.tree.host_nodes()[node as usize].bounds, &self.view);
        match (own, self.of_leaf(node)) {
            (Place::Outside, _) | (_, None) => own,
            (_, Some((several, object))) => several.place(object, &self.view),
        }
    }

    /// The boxes of the object of a leaf.
    fn of_leaf(&self, node: u32) -> Option<(&SeveralBoxes, u32)> {
        Some((self.several.as_ref()?, self.object(node)?))
    }

    /// What the numbers of boxes mean.
    pub(super) fn numbered(&self, world: &World) -> Numbered {
        let boxes = self.several.as_ref().map_or_else(|| world.bounds(), SeveralBoxes::on_device);
        Numbered { nodes: Some(self.tree.nodes()), boxes }
    }

    /// The numbers of the boxes that a node is asked about by: its own, or those of its object, which come after all nodes'.
    pub(super) fn asked(&self, node: u32) -> Range<u32> {
        let nodes = self.tree.len() as u32;
        self.of_leaf(node).map_or(node..node + 1, |(several, object)| {
            let boxes = several.of(object);
            nodes + boxes.start..nodes + boxes.end
        })
    }

    /// The boxes that a node is asked about by, as the device has them.
    pub(super) fn asked_bounds(&self, node: u32) -> impl Iterator<Item = &Bounds> + '_ {
        self.asked(node).map(|number| match (&self.several, (number as usize).checked_sub(self.tree.len())) {
            (Some(several), Some(of_object)) => several.bounds(of_object as u32),
            _ => &self.tree.host_nodes()[number as usize].bounds,
        })
    }

    /// The object of a leaf, unless it is drawn anyway.
    pub(super) fn object(&self, node: u32) -> Option<u32> {
        self.tree.host().nodes()[node as usize].object().filter(|object| self.tree.unbounded()[*object as usize] == 0)
    }

    pub(super) fn children(&self, node: u32) -> Option<[u32; 2]> {
        self.tree.host().nodes()[node as usize].children()
    }

    /// The nearest node of the queue.
    pub(super) fn pop(&mut self) -> Option<u32> {
        self.queue.pop().map(|Reverse((_, node))| node)
    }

    pub(super) fn push(&mut self, node: u32) {
        let near = distance(&self.tree.host().nodes()[node as usize].bounds, self.eye);
        // Numbers of 0 and more have the order of their bits.
        self.queue.push(Reverse((near.to_bits(), node)));
    }

    /// Notes that the node was looked at and nothing of it has been seen yet.
    pub(super) fn visit(&mut self, node: u32) {
        let frame = self.frame;
        self.state_mut(node).visit(frame);
    }

    /// A visible node makes those above it visible: the hierarchy is opened as far in the next frame.
    pub(super) fn pull_up(&mut self, node: u32) {
        let mut node = node;
        while node != NO_NODE {
            let frame = self.frame;
            let state = self.state_mut(node);
            if state.visible && state.visited == frame {
                return;
            }
            state.visible = true;
            state.visited = frame;
            node = self.tree.host().parents()[node as usize];
        }
    }

    /// Draws a leaf; of another node the children are looked at in their turn.
    pub(super) fn open(&mut self, node: u32, frame: &mut Recording<'_>) -> Result<()> {
        match self.children(node) {
            Some(children) => children.into_iter().for_each(|child| self.push(child)),
            None => self.object(node).into_iter().try_for_each(|object| frame.draw(object))?,
        }
        Ok(())
    }

    /// Boxes by number, for pictures.
    pub(super) fn shown(&self, boxes: &[u32]) -> TestedBoxes {
        let mut shown = TestedBoxes::default();
        for number in boxes {
            match (self.tree.host().nodes().get(*number as usize), &self.several) {
                (Some(node), _) if !node.is_leaf() => shown.groups.push(node.bounds),
                (Some(leaf), _) => shown.singles.push(leaf.bounds),
                (None, several) => {
                    let of_object = *number - self.tree.len() as u32;
                    shown.singles.extend(several.iter().map(|several| several.aabb(of_object)));
                }
            }
        }
        shown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_to_a_box_is_squared_and_zero_inside() {
        let bounds = Aabb { min: DVec3::new(1.0, -2.0, 3.0), max: DVec3::new(2.0, 2.0, 5.0) };
        assert_eq!(distance(&bounds, DVec3::new(1.5, 0.0, 4.0)), 0.0);
        assert_eq!(distance(&bounds, DVec3::new(-1.0, 0.0, 4.0)), 4.0);
        assert_eq!(distance(&bounds, DVec3::new(5.0, 6.0, 17.0)), 9.0 + 16.0 + 144.0);
    }

    #[test]
    fn only_the_frame_before_tells_of_a_visible_node() {
        let state = State { visible: true, visited: 7, ..State::default() };
        assert!(state.was_visible(8));
        assert!(!state.was_visible(9), "it was out of view in frame 8");
        assert!(!State { visible: false, ..state }.was_visible(8));
    }

    #[test]
    fn a_node_is_hidden_from_the_frame_on_that_first_finds_it_so() {
        let mut state = State::default();
        assert_eq!(state.hidden_for(5), 0, "it was never looked at");
        let hidden = [5, 6, 9].map(|frame| {
            state.visit(frame);
            state.hidden_for(frame)
        });
        assert_eq!(hidden, [0, 1, 4]);
        state.visible = true;
        assert_eq!(state.hidden_for(10), 0);
        state.visit(12);
        assert_eq!((state.hidden_for(12), state.hidden_for(14)), (0, 2), "counted anew after it showed");
    }
}
