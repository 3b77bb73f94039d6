//! Where a walk down the hierarchy asks: `chc` everywhere, `nohc` where its model says that it pays.

use super::costs::Costs;
use super::hierarchy::Hierarchy;
use super::multi::persistence;
use crate::frustum::twin::clip_from_bounds;
use crate::World;
use shaders::types::CullView;

/// The chance that what is visible is so in the next frame: the limit of p(t).
const STAYS_VISIBLE: f64 = 0.99;

/// Where to ask.
pub(super) enum Policy {
    /// About every hidden node and every visible leaf: `chc`.
    Always,
    /// Where it pays: what the device takes, and the triangles below each node.
    ByCost(Costs, Vec<f64>),
}

impl Policy {
    /// Where it pays on a device of these costs.
    pub(super) fn by_cost(costs: Costs, nodes: &Hierarchy, world: &World) -> Policy {
        Policy::ByCost(costs, triangles_below(nodes, world))
    }

    /// The tree was built anew.
    pub(super) fn rebuilt(&mut self, nodes: &Hierarchy, world: &World) {
        if let Policy::ByCost(_, triangles) = self {
            *triangles = triangles_below(nodes, world);
        }
    }

    /// Is a query of the node worth while?
    pub(super) fn asks(&self, nodes: &mut Hierarchy, node: u32, was_visible: bool) -> bool {
        let Policy::ByCost(costs, triangles) = self else { return true };
        let flat = &nodes.tree.host_nodes()[node as usize];
        let query = costs.query_ms(nodes.asked_bounds(node).map(|bounds| pixels(bounds, &nodes.view)).sum());
        let drawing = costs.draw_ms(f64::from(flat.object_count), triangles[node as usize]);
        let now = nodes.frame;
        let hidden = if was_visible {
            1.0 - STAYS_VISIBLE.powf((now - nodes.state(node).test) as f64)
        } else {
            persistence(nodes.hidden_for(node))
        };
        let asks = query < hidden * drawing;
        if asks || !was_visible {
            nodes.state_mut(node).test = now;
        }
        asks
    }

    /// The fitted constants.
    pub(super) fn lines(&self) -> Vec<String> {
        match self {
            Policy::Always => Vec::new(),
            Policy::ByCost(costs, _) => vec![format!("costs on this device: {costs}")],
        }
    }
}

fn triangles_below(nodes: &Hierarchy, world: &World) -> Vec<f64> {
    let tree = nodes.tree.host().nodes();
    let mut below = vec![0.0; tree.len()];
    // Children come after their parents.
    for (index, node) in tree.iter().enumerate().rev() {
        below[index] = match (node.object(), node.children()) {
            (Some(object), _) => f64::from(world.index_count(object)) / 3.0,
            (None, Some([first, second])) => below[first as usize] + below[second as usize],
            (None, None) => 0.0,
        };
    }
    below
}

/// Pixels of the rectangle around a box in front of the near plane.
fn pixels(bounds: &shaders::types::Bounds, view: &CullView) -> f64 {
    let clip = clip_from_bounds(bounds, view);
    let spread = |axis: usize| clip.axes.iter().map(|one| one[axis].abs()).sum::<f32>();
    let w = (clip.centre.w - spread(3)).max(f32::MIN_POSITIVE);
    let side = |axis: usize, size: u32| {
        let [low, high] = [-1.0, 1.0].map(|sign| ((clip.centre[axis] + sign * spread(axis)) / w).clamp(-1.0, 1.0));
        f64::from(0.5 * (high - low) * size as f32).max(1.0)
    };
    side(0, view.width_px) * side(1, view.height_px)
}
