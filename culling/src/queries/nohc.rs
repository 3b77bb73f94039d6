//! `nohc`: near-optimal hierarchical culling (Guthe et al. 2006, as Kim 2015, V uses it). It walks as [`super::chc`] does, but asks
//! only where a query costs less than what it saves on the average, by a model of costs that is fitted to the device at start-up.
//!
//! - Of a hidden node: query if C(query) < p C(drawing all below it). Else all in view below it is drawn, and the node is taken for
//!   one thing from then on. The chance p that it is still hidden is the persistence of visibility that CHC++ found (Guthe et al.
//!   have one of their own from the pixels that are covered, which a host that reads no picture back does not know).
//! - Of a visible leaf, or of what is taken for one: query once C(query) < (1 - 0.99^k) C(drawing it), k frames after the last.
//!
//! No frame is left out before a still camera: what is visible comes due for a query while nothing else changes, and which frames
//! ran decides what the next view begins with.

use super::chc;
use super::costs::Costs;
use super::hierarchy::Hierarchy;
use super::multi::persistence;
use super::{MIN_PIXELS_OPTION, WINDOW_OPTION};
use crate::frustum::twin::clip_from_bounds;
use crate::tree::SPLIT_OPTION;
use crate::{Method, OptionInfo, Result, Setup, World};
use shaders::types::CullView;

/// Queries under way at once, and the hierarchy's split.
pub const OPTIONS: &[OptionInfo] = &[crate::world::DETAIL_OPTION, MIN_PIXELS_OPTION, WINDOW_OPTION, SPLIT_OPTION];

/// The chance that what is visible is so in the next frame: the limit of p(t).
const STAYS_VISIBLE: f64 = 0.99;

/// Where to ask.
pub(super) enum Policy {
    /// About every hidden node and every visible leaf: `chc`.
    Always,
    /// Where it pays: what the device takes, and the triangles below each node.
    ByCost(Costs, Vec<f64>),
}

/// Makes the method; measures the device, once in a program's run.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let costs = Costs::of(setup.gpu)?;
    tracing::info!("nohc: {costs}");
    let policy = Policy::ByCost(costs, triangles_below(&Hierarchy::new(setup)?, setup.world));
    chc::walking(setup, "nohc", policy)
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

impl Policy {
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
        let query = costs.query_ms(pixels(&flat.bounds, &nodes.view));
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
