//! ROC's compute stages in plain Rust: their definition.

use super::Cuts;
use crate::boxes::twin::{crosses_near, grown};
use crate::frustum::twin::{clip_from_bounds, left_out};
use crate::pack::twin as pack;
use glam::Vec3;
use shaders::types::*;

/// What becomes of an object: SELECT_*. What `include/select.glsl` does.
pub fn selection(bound: &Bounds, seen: u32, view: &CullView) -> u32 {
    if seen != 0 {
        return SELECT_SEEN;
    }
    if bound.flags & OBJECT_ALWAYS_KEPT != 0 {
        return SELECT_SHOWN;
    }
    if left_out(&clip_from_bounds(bound, view), bound.flags, view) {
        return SELECT_NONE;
    }
    let reaches_near = crosses_near(&clip_from_bounds(&grown(bound, view), view));
    if reaches_near {
        SELECT_SHOWN
    } else {
        SELECT_TESTED
    }
}

/// Which objects are tested by their box, and which count as visible without a test. Twin of `roc/select_boxes`.
pub fn select_boxes(bounds: &[Bounds], view: &CullView, drawn: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let one = |(bound, drawn): (&Bounds, &u32)| {
        let selected = selection(bound, *drawn, view);
        (u32::from(selected == SELECT_TESTED), u32::from(selected == SELECT_SHOWN))
    };
    bounds.iter().zip(drawn).map(one).unzip()
}

/// What becomes of each object, at what depth its box begins, and at what depth the farthest of those in view does. Twin of
/// `roc/measure_boxes`.
pub fn measure_boxes(
    bounds: &[Bounds],
    view: &CullView,
    depth_plane: [f32; 4],
    seen: &[u32],
) -> (Vec<u32>, Vec<f32>, f32) {
    let (mut selected, mut depths, mut farthest) = (Vec::new(), Vec::new(), 0.0f32);
    for (bound, seen) in bounds.iter().zip(seen) {
        let selects = selection(bound, *seen, view);
        let is_kept = bound.flags & OBJECT_ALWAYS_KEPT != 0;
        let depth = if is_kept { 0.0 } else { depth_of(bound, view, depth_plane) };
        let in_view = match selects {
            SELECT_SEEN => !left_out(&clip_from_bounds(bound, view), bound.flags, view),
            other => other != SELECT_NONE,
        };
        if in_view {
            farthest = farthest.max(depth);
        }
        selected.push(selects);
        depths.push(depth);
    }
    (selected, depths, farthest)
}

/// Where a box begins along the view. Twin of `begin_of_box`.
pub fn depth_of(bound: &Bounds, view: &CullView, [x, y, z, w]: [f32; 4]) -> f32 {
    let coarse = Vec3::from(bound.centre_high) - Vec3::from(view.camera_high);
    let centre = coarse + (Vec3::from(bound.centre_low) - Vec3::from(view.camera_low));
    let half = Vec3::from(bound.half_extent);
    let middle = x * centre.x + y * centre.y + z * centre.z + w;
    let begin = middle - (x.abs() * half.x + y.abs() * half.y + z.abs() * half.z);
    if begin > 0.0 {
        begin
    } else {
        0.0
    }
}

/// The place of each object, which is its depth range and what becomes of it, and how many objects each list has in each
/// chunk: first the lists of what was seen, by range, then those of all others. Twin of `roc/assign_ranges`.
pub fn assign_ranges(selected: &[u32], depths: &[f32], farthest: f32, cuts: &Cuts) -> (Vec<u32>, Vec<Vec<u32>>) {
    let outermost = cuts.outermost.unwrap_or(farthest);
    let place = |(selected, depth): (&u32, &f32)| {
        let range = range_of(*depth, outermost, cuts.ranges, cuts.share);
        match *selected {
            SELECT_NONE => SELECT_NONE,
            SELECT_TESTED if cuts.show_beyond && *depth > outermost => range << PLACE_RANGE_SHIFT | SELECT_SHOWN,
            selected => range << PLACE_RANGE_SHIFT | selected,
        }
    };
    let places: Vec<u32> = selected.iter().zip(depths).map(place).collect();
    let counts = (0..2 * cuts.ranges).map(|list| pack::count_flags(&in_list(&places, list, cuts.ranges)));
    let counts = counts.collect();
    (places, counts)
}

/// The range of a depth. Twin of `range_of`.
pub fn range_of(depth: f32, outermost: f32, ranges: u32, share: f32) -> u32 {
    let (mut range, mut end) = (ranges - 1, outermost * share);
    while range > 0 && depth <= end {
        range -= 1;
        end *= share;
    }
    range
}

/// Which objects are in a list.
fn in_list(places: &[u32], list: u32, ranges: u32) -> Vec<u32> {
    let is_in = |place: &u32| {
        let (range, selected) = (place >> PLACE_RANGE_SHIFT, place & PLACE_SELECTION_MASK);
        selected != SELECT_NONE && list == range + if selected == SELECT_SEEN { 0 } else { ranges }
    };
    places.iter().map(|place| u32::from(is_in(place))).collect()
}

/// The commands of each list, in object order. What is tested draws nothing yet. Twin of `roc/list_ranges`.
pub fn list_ranges(places: &[u32], ranges: u32, object_meshes: &[u32], meshes: &[MeshRange]) -> Vec<Vec<DrawCommand>> {
    let list = |list| {
        let mut commands = pack::write_commands(&in_list(places, list, ranges), object_meshes, meshes);
        for command in &mut commands {
            let is_tested = places[command.first_instance as usize] & PLACE_SELECTION_MASK == SELECT_TESTED;
            command.instance_count = u32::from(!is_tested);
        }
        commands
    };
    (0..2 * ranges).map(list).collect()
}
