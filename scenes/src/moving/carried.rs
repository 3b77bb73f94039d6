//! What hangs on animated nodes, carried up to the world while a span of time passes: where the span's middle puts it, and how far off other times are.

use super::longest;
use super::spread::{stretch, Span};
use crate::animation::{AnimatedNode, NodeAnimation};
use crate::bounds::Reach;
use glam::{DAffine3, DVec3};

/// A part of an object that hangs on a node.
pub(super) struct Hung<'a> {
    /// Its place on the lowest node.
    pub(super) node_from_part: DAffine3,
    /// The node and those above it, the root last.
    pub(super) chain: Vec<&'a AnimatedNode>,
    /// The first of the chain that carries the whole object: 0 where the part is the object, the anchor's place for a part that a joint carries.
    pub(super) carrier: usize,
    /// World from the space in which the nodes move.
    pub(super) world_from_tree: DAffine3,
}

/// It on its way up: see the head of `moving.rs`.
pub(super) struct Carried {
    /// Where the span's middle puts it.
    pub(super) place: DAffine3,
    corners: [DVec3; 8],
    /// How far from there it can be.
    pub(super) off: f64,
    /// How much longer all nodes so far make a vector, at most.
    pub(super) longer: f64,
    /// No point of it is ever farther from the origin; nor is the sum of the distances by which matrices move it, and of its own size as they stretch it.
    pub(super) farthest: f64,
}

impl Hung<'_> {
    /// Places the part on its node, relative to the point `from` of it. `reach` is that of the part. With `turned` the part is turned
    /// and scaled, not moved.
    pub(super) fn begin(&self, reach: &Reach, from: DVec3, turned: bool) -> Carried {
        let corners = reach.in_object_space().corners();
        let place = if turned { without_shift(self.node_from_part) } else { self.node_from_part };
        let longer = stretch(&self.node_from_part.matrix3);
        Carried {
            place,
            corners: corners.map(|corner| place.transform_point3(corner - from)),
            off: 0.0,
            longer,
            farthest: longer * longest(&corners) + self.node_from_part.translation.length(),
        }
    }

    /// World from whatever the root hangs on.
    fn world_from_root(&self) -> DAffine3 {
        self.world_from_tree * self.chain.last().map_or(DAffine3::IDENTITY, |root| root.world_from_root)
    }
}

impl Carried {
    /// Up some nodes.
    pub(super) fn up(&mut self, chain: &[&AnimatedNode], span: Span, turned: bool) {
        for node in chain {
            let spread = node.spread(span);
            let parent_from_node = node.parent_from_node(span.middle());
            let parent_from_node = if turned { without_shift(parent_from_node) } else { parent_from_node };
            let before = longest(&self.corners);
            self.corners = self.corners.map(|corner| parent_from_node.transform_point3(corner));
            self.off = spread.turn * (spread.scale * self.off + spread.scale_off * before)
                + spread.turn_off * spread.scale * before
                + if turned { 0.0 } else { spread.shift_off };
            self.longer *= spread.turn * spread.scale;
            self.farthest = spread.turn * spread.scale * self.farthest + spread.shift;
            self.place = parent_from_node * self.place;
        }
    }

    /// From the root to the world.
    pub(super) fn up_to_world(&mut self, hung: &Hung<'_>, turned: bool) {
        let world_from_root = hung.world_from_root();
        let fixed = stretch(&world_from_root.matrix3);
        (self.off, self.longer) = (fixed * self.off, fixed * self.longer);
        self.farthest = fixed * self.farthest + world_from_root.translation.length();
        self.place = if turned { without_shift(world_from_root) } else { world_from_root } * self.place;
    }
}

fn without_shift(place: DAffine3) -> DAffine3 {
    DAffine3::from_mat3(place.matrix3)
}

/// The node and those above it, the root last.
pub(super) fn chain(nodes: &NodeAnimation, node: usize) -> Vec<&AnimatedNode> {
    let mut chain = vec![&nodes.nodes()[node]];
    while let Some(parent) = chain[chain.len() - 1].parent {
        chain.push(&nodes.nodes()[parent]);
    }
    chain
}
