//! ROC's compute stages in plain Rust: their definition.

use crate::boxes::twin::{crosses_near, grown};
use crate::frustum::twin::{clip_from_bounds, footprint_widening, outside_frustum};
use shaders::types::{Bounds, CullView, OBJECT_ALWAYS_KEPT};

/// Which objects are tested by their box, and which count as visible without a test. Twin of `roc/select_boxes`.
pub fn select_boxes(bounds: &[Bounds], view: &CullView, drawn: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let one = |(bound, drawn): (&Bounds, &u32)| {
        if *drawn != 0 {
            return (0, 0);
        }
        if bound.flags & OBJECT_ALWAYS_KEPT != 0 {
            return (0, 1);
        }
        if outside_frustum(&clip_from_bounds(bound, view), footprint_widening(bound.flags, view)) {
            return (0, 0);
        }
        let reaches_near = crosses_near(&clip_from_bounds(&grown(bound, view), view));
        (u32::from(!reaches_near), u32::from(reaches_near))
    };
    bounds.iter().zip(drawn).map(one).unzip()
}
