//! What `include/box.glsl` does, in plain Rust.

use crate::frustum::twin::{clip_from_bounds, farthest_along, grid_px, ClipBox};
use glam::{Vec3, Vec4};
use shaders::types::{Bounds, CullView, BOX_PAD_SNAPS, DEPTH_ROUNDING, OBJECT_WIDE_RASTER};

/// The least number of pixels that a step of one unit across the view moves a point at w = 1.
pub fn pixels_per_unit(view: &CullView) -> f32 {
    let row = |row: usize| Vec3::from(std::array::from_fn(|column| view.clip_from_relative[column][row]));
    0.5 * (view.width_px as f32 * row(0).length()).min(view.height_px as f32 * row(1).length())
}

/// The box grown to cover all that its contents can.
pub fn grown(bounds: &Bounds, view: &CullView) -> Bounds {
    let growth = growth(&clip_from_bounds(bounds, view), view, bounds.flags);
    Bounds { half_extent: bounds.half_extent.map(|half| half + growth), ..*bounds }
}

/// How much a box must grow on every side. Twin of `growth`.
pub fn growth(clip: &ClipBox, view: &CullView, flags: u32) -> f32 {
    let w_max = clip.centre.w + clip.axes.iter().map(|axis| axis.w.abs()).sum::<f32>() + clip.error.w;
    let wide = if flags & OBJECT_WIDE_RASTER != 0 { 1.0 } else { 0.0 };
    let pad = 2.0 * (BOX_PAD_SNAPS * grid_px(view) + wide) * w_max / pixels_per_unit(view);
    pad + depth_growth(clip, view, w_max)
}

/// How far a box must reach out for the rounding of its own faces' depth. Twin of `depth_growth`.
pub fn depth_growth(clip: &ClipBox, view: &CullView, w_max: f32) -> f32 {
    let spread = clip.axes.iter().map(|axis| axis.abs()).sum::<Vec4>() + clip.error;
    let nearest = ((clip.centre.z + spread.z) / (clip.centre.w - spread.w).max(1.0e-30)).min(1.0);
    let farthest = ((clip.centre.z - spread.z) / w_max).max(0.0);
    let row = |row: usize| Vec3::from(std::array::from_fn(|column| view.clip_from_relative[column][row]));
    DEPTH_ROUNDING * nearest * w_max / (row(2) - farthest * row(3)).length().max(1.0e-30)
}

/// True if the box reaches in front of the near plane or behind the eye.
pub fn crosses_near(clip: &ClipBox) -> bool {
    farthest_along(clip, Vec4::new(0.0, 0.0, 1.0, -1.0)) > 0.0
        || farthest_along(clip, Vec4::new(0.0, 0.0, 0.0, -1.0)) >= 0.0
}
