//! Where a walk down the hierarchy asks: `chc` everywhere, `nohc` where its model says that it pays.

use super::costs::Costs;
use super::hierarchy::{Hierarchy, State};
use super::multi::persistence;
use crate::frustum::twin::clip_from_bounds;
use crate::World;
use scenes::bvh::Bvh;
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
        Policy::ByCost(costs, triangles_below(nodes.tree.host(), |object| world.index_count(object)))
    }

    /// The tree was built anew.
    pub(super) fn rebuilt(&mut self, nodes: &Hierarchy, world: &World) {
        if let Policy::ByCost(_, triangles) = self {
            *triangles = triangles_below(nodes.tree.host(), |object| world.index_count(object));
        }
    }

    /// Is a query of the node worth while?
    pub(super) fn asks(&self, nodes: &mut Hierarchy, node: u32, was_visible: bool) -> bool {
        let Policy::ByCost(costs, triangles) = self else { return true };
        let flat = &nodes.tree.host_nodes()[node as usize];
        let query = costs.query_ms(nodes.asked_bounds(node).map(|bounds| pixels(bounds, &nodes.view)).sum());
        let drawing = costs.draw_ms(f64::from(flat.object_count), triangles[node as usize]);
        let now = nodes.frame;
        let hidden =
            if was_visible { chance_of_hiding(nodes.state(node), now) } else { persistence(nodes.hidden_for(node)) };
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

/// The chance that a visible node has been hidden since its last test.
fn chance_of_hiding(state: &State, now: u64) -> f64 {
    1.0 - STAYS_VISIBLE.powf((now - state.test) as f64)
}

/// Triangles of the objects below each node, by node.
fn triangles_below(bvh: &Bvh, index_count: impl Fn(u32) -> u32) -> Vec<f64> {
    let tree = bvh.nodes();
    let mut below = vec![0.0; tree.len()];
    // Children come after their parents.
    for (index, node) in tree.iter().enumerate().rev() {
        below[index] = match (node.object(), node.children()) {
            (Some(object), _) => f64::from(index_count(object)) / 3.0,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View;
    use glam::{DQuat, DVec3};
    use scenes::bvh::Split;
    use scenes::{Aabb, Pose, Projection, Shot};
    use shaders::types::Bounds;

    #[test]
    fn a_node_has_a_third_as_many_triangles_as_the_objects_below_it_have_indices() {
        let cube = |x: f64| Aabb { min: DVec3::new(x, 0.0, 0.0), max: DVec3::new(x + 1.0, 1.0, 1.0) };
        let bounds: Vec<_> = (0..9).map(|index| cube(10.0 * f64::from(index))).collect();
        let bvh = Bvh::build(&bounds, Split::Sah).unwrap();
        // 1 triangle, 2, 4, ... by object: each sum tells which objects it is of.
        let below = triangles_below(&bvh, |object| 3 << object);
        assert_eq!(below[0], 511.0);
        let mut leaves: Vec<(u32, f64)> = Vec::new();
        for (node, triangles) in bvh.nodes().iter().zip(&below) {
            if let Some(object) = node.object() {
                leaves.push((object, *triangles));
            }
            if let Some(children) = node.children() {
                assert_eq!(*triangles, children.iter().map(|child| below[*child as usize]).sum::<f64>());
            }
        }
        leaves.sort_by_key(|(object, _)| *object);
        assert_eq!(leaves, (0..9).map(|object| (object, f64::from(1 << object))).collect::<Vec<_>>());
    }

    #[test]
    fn the_longer_ago_its_test_the_likelier_a_visible_node_has_been_hidden() {
        let state = State { test: 20, ..State::default() };
        assert_eq!(chance_of_hiding(&state, 20), 0.0);
        // 1 - 0.99^2 has two roundings of numbers up to 1.
        assert!((chance_of_hiding(&state, 22) - 0.0199).abs() < 1e-15);
    }

    /// Pixels of a box in a picture of 200 x 100: at a distance of d the view is 4 d wide and 2 d high.
    fn pixels_of(centre: [f32; 3], half_extent: [f32; 3]) -> f64 {
        let projection = Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_2, near: 0.5, far: Some(100.0) };
        let pose = Pose { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        let view = View::new(&Shot { pose, projection, seconds: 0.0 }, [200, 100], 0, 0.0);
        pixels(&Bounds { centre_high: centre, half_extent, ..Bounds::default() }, &view.cull())
    }

    #[test]
    fn a_box_covers_the_pixels_of_its_rectangle_within_the_picture() {
        // Fewer than 20 roundings of 2^-24, of numbers at most 16 times as large as their difference.
        let is_near = |one: f64, other: f64| (one / other - 1.0).abs() < 20.0 * 16.0 / f64::from(1 << 24);
        // Its near face lies at a distance of 9.
        let front = pixels_of([0.0, 0.0, -10.0], [2.0, 1.0, 1.0]);
        assert!(is_near(front, 200.0 / 9.0 * (100.0 / 9.0)), "{front}");
        let half_outside = pixels_of([18.0, 0.0, -10.0], [4.0, 1.0, 1.0]);
        assert!(is_near(half_outside, front), "{half_outside}");
        assert_eq!(pixels_of([0.0, 0.0, -1.0], [2.0, 2.0, 1.0]), 20_000.0, "a box around the eye fills the picture");
        assert_eq!(pixels_of([0.0, 0.0, -90.0], [0.001; 3]), 1.0, "no box covers less than a pixel");
    }
}
