//! The stages of warping-based occlusion culling in plain Rust: their definition.

use crate::boxes::twin::{crosses_near, grown};
use crate::frustum::twin::{clip_from_bounds, ClipBox};
use glam::Vec4;
use shaders::types::{Bounds, CullView, DrawCommand, OBJECT_ALWAYS_KEPT};

/// 1 for each object that is among `objects` and not among `excluded`. Twin of `woc/exclude_objects`.
pub fn exclude_objects(objects: &[u32], excluded: &[u32]) -> Vec<u32> {
    objects.iter().zip(excluded).map(|(object, excluded)| u32::from(*object != 0 && *excluded == 0)).collect()
}

/// Where objects were and are.
#[derive(Clone, Copy, Debug)]
pub struct Ways<'a> {
    /// World bounds in the last frame.
    pub before: &'a [Bounds],
    /// World bounds now.
    pub now: &'a [Bounds],
    /// The last view, and this one.
    pub views: [&'a CullView; 2],
}

fn corner_of(clip: &ClipBox, corner: u32) -> Vec4 {
    let signed = |axis: usize| if corner >> axis & 1 == 1 { clip.axes[axis] } else { -clip.axes[axis] };
    clip.centre + signed(0) + signed(1) + signed(2)
}

/// A corner moved farther than `threshold` in the canonical view volume, seen by an eye that only steps and does not turn, or lies
/// behind the eye. Twin of `is_rapid`.
pub fn is_rapid(ways: &Ways<'_>, object: usize, threshold: f32) -> bool {
    if ways.now[object].flags & OBJECT_ALWAYS_KEPT != 0 {
        return false;
    }
    let [last, this] = ways.views;
    let turned = CullView { camera_high: last.camera_high, camera_low: last.camera_low, ..*this };
    let from = clip_from_bounds(&ways.before[object], &turned);
    let to = clip_from_bounds(&ways.now[object], this);
    (0..8).any(|corner| {
        let (start, end) = (corner_of(&from, corner), corner_of(&to, corner));
        let way = end.truncate() / end.w - start.truncate() / start.w;
        let is_slow = start.w > 0.0 && end.w > 0.0 && way.length_squared() <= threshold * threshold;
        !is_slow
    })
}

/// Flags the rapid ones of the objects that `commands` drew and that are in view. Twin of `woc/find_rapid`.
pub fn find_rapid(commands: &[DrawCommand], kept: &[u32], ways: &Ways<'_>, threshold: f32, rapid: &mut [u32]) {
    for command in commands.iter().filter(|command| command.instance_count != 0) {
        let object = command.first_instance as usize;
        if kept[object] != 0 && is_rapid(ways, object, threshold) {
            rapid[object] = 1;
        }
    }
}

/// Adds the rapid objects to the visible ones; gives the visible ones that are not rapid. Twin of `woc/leave_rapid`.
pub fn leave_rapid(rapid: &[u32], visible: &mut [u32]) -> Vec<u32> {
    let remaining =
        rapid.iter().zip(&*visible).map(|(rapid, visible)| if *rapid == 0 { *visible } else { 0 }).collect();
    visible.iter_mut().zip(rapid).for_each(|(visible, rapid)| *visible |= rapid);
    remaining
}

/// Takes the candidates whose box can be rasterised out of what is to be drawn; gives them, in order. Twin of
/// `woc/hold_candidates`.
pub fn hold_candidates(candidates: &[u32], bounds: &[Bounds], view: &CullView, shown: &mut [u32]) -> Vec<u32> {
    let has_box = |bound: &Bounds| {
        bound.flags & OBJECT_ALWAYS_KEPT == 0 && !crosses_near(&clip_from_bounds(&grown(bound, view), view))
    };
    let held = |object: &&u32| shown[**object as usize] != 0 && has_box(&bounds[**object as usize]);
    let held: Vec<u32> = candidates.iter().filter(held).copied().collect();
    held.iter().for_each(|object| shown[*object as usize] = 0);
    held
}
