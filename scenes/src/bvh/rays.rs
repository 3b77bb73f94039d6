//! Twin of the ray traversal (thesis, section III.4): which leaves of a subtree does a ray meet?

use super::Bvh;
use crate::model::Aabb;
use glam::DVec3;
use std::ops::RangeInclusive;

/// All leaves at or below a node whose boxes the ray meets, as node numbers in ascending order. Not the nearest only: each
/// object on the ray is a potential occludee (thesis, section III.4).
///
/// The ray is `origin + t * direction` in world space, in metres, for the `t` of the range, both ends included and either sign;
/// `direction` has any length. Boxes include their surfaces. The answer errs on the side of a hit: no box that the exact ray
/// meets is left out, whatever the rounding. A direction of zero asks which boxes hold the origin; a ray with a NaN meets
/// everything; an empty range nothing.
///
/// # Panics
/// If there is no such node.
pub fn hit_leaves(bvh: &Bvh, root: u32, origin: DVec3, direction: DVec3, range: RangeInclusive<f64>) -> Vec<u32> {
    assert!((root as usize) < bvh.nodes().len(), "node {root} of {}", bvh.nodes().len());
    let mut hits = Vec::new();
    let mut open = vec![root];
    while let Some(index) = open.pop() {
        let node = &bvh.nodes()[index as usize];
        if !may_meet(&node.bounds, origin, direction, &range) {
            continue;
        }
        match node.children() {
            Some([first, second]) => open.extend([second, first]),
            None => hits.push(index),
        }
    }
    hits.sort_unstable();
    hits
}

/// A slab's distance carries two roundings, of the difference and of the quotient: the exact one is within a factor of
/// (1 +- u)^2 of it, u = 2^-53, which 4u covers. It is a power of two, so the widening itself is exact but for its last sum.
const SLAB_ERROR: f64 = 2.0 * f64::EPSILON;

/// Does the ray meet the box? If it does exactly, yes; else no, but for a few roundings.
///
/// A larger box never turns a yes into a no: each step is monotonic. So a leaf is found if its own box answers yes.
fn may_meet(bounds: &Aabb, origin: DVec3, direction: DVec3, range: &RangeInclusive<f64>) -> bool {
    let (mut near, mut far) = (*range.start(), *range.end());
    for axis in 0..3 {
        let (origin, direction) = (origin[axis], direction[axis]);
        let (min, max) = (bounds.min[axis], bounds.max[axis]);
        if direction == 0.0 {
            if origin < min || max < origin {
                return false;
            }
            continue;
        }
        let (enter, leave) = if direction > 0.0 { (min, max) } else { (max, min) };
        let (enter, leave) = ((enter - origin) / direction, (leave - origin) / direction);
        // Below the smallest normal number a quotient's error is absolute. A distance beyond f64 gives infinity minus
        // infinity, NaN, which `max` and `min` pass over: nothing is known of this side then, and nothing concluded.
        near = near.max(enter - enter.abs() * SLAB_ERROR - f64::MIN_POSITIVE);
        far = far.min(leave + leave.abs() * SLAB_ERROR + f64::MIN_POSITIVE);
    }
    near <= far
}
