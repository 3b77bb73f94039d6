//! How near a box can be at each place of the picture, by the planes of its faces, in plain Rust: twin of `include/fronts.glsl`, where the
//! derivation is.

use crate::frustum::twin::{grid_px, ClipBox};
use glam::Vec2;
use shaders::types::{CullView, DEPTH_SLACK_PER_PIXEL, OBJECT_WIDE_RASTER, ROUNDING};

/// Depths that bound a box from in front, affine over the picture, one a pair of its faces.
#[derive(Clone, Copy, Debug)]
pub struct Fronts {
    middle_px: Vec2,
    pad_px: Vec2,
    gradient: [Vec2; 3],
    base: [f32; 3],
    nearest: f32,
}

/// Corners of a box on the screen, and how far off each may be.
struct Corners {
    place: [Vec2; 8],
    depth: [f32; 8],
    slack_px: Vec2,
    depth_error: f32,
    reach_px: Vec2,
    nearest: f32,
    farthest: f32,
}

impl Corners {
    fn of(clip: &ClipBox, size: Vec2, middle_px: Vec2, mut reach_px: Vec2) -> Self {
        let (mut place, mut depth) = ([Vec2::ZERO; 8], [0.0f32; 8]);
        let (mut slack_px, mut depth_error) = (Vec2::ZERO, 0.0f32);
        let (mut nearest, mut farthest) = (0.0f32, 1.0f32);
        let error = clip.error;
        for corner in 0..8 {
            let side = |axis: usize| if corner >> axis & 1 == 1 { clip.axes[axis] } else { -clip.axes[axis] };
            let position = clip.centre + side(0) + side(1) + side(2);
            let w_low = position.w - error.w;
            let projected = Vec2::new(position.x, position.y) / position.w;
            let slack = (Vec2::new(error.x, error.y) + projected.abs() * error.w) / w_low + ROUNDING * projected.abs();
            place[corner] = (projected * 0.5 + 0.5) * size - middle_px;
            depth[corner] = position.z / position.w;
            slack_px = slack_px.max((0.5 * slack + ROUNDING) * size);
            depth_error = depth_error.max((position.z + error.z) / w_low * (1.0 + ROUNDING) - depth[corner]);
            reach_px = reach_px.max(place[corner].abs());
            nearest = nearest.max(depth[corner]);
            farthest = farthest.min(depth[corner]);
        }
        Corners { place, depth, slack_px, depth_error, reach_px, nearest, farthest }
    }

    /// How depth changes along a face: that of one axis, at one of its two ends.
    fn gradient(&self, axis: usize, side: usize) -> Vec2 {
        let (along, across) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let origin = side << axis;
        let (one, other) =
            (self.place[origin | along] - self.place[origin], self.place[origin | across] - self.place[origin]);
        let (deeper, other_deeper) =
            (self.depth[origin | along] - self.depth[origin], self.depth[origin | across] - self.depth[origin]);
        Vec2::new(deeper * other.y - other_deeper * one.y, one.x * other_deeper - other.x * deeper)
            / (one.x * other.y - one.y * other.x)
    }
}

impl Fronts {
    /// Of a box that does not cross the near plane; of its footprint, the first and the last pixel and the nearest depth. Twin of `fronts_of`.
    pub fn of(clip: &ClipBox, pixels: [[u32; 2]; 2], nearest_of_box: f32, view: &CullView, flags: u32) -> Self {
        let size = Vec2::new(view.width_px as f32, view.height_px as f32);
        let wide = if flags & OBJECT_WIDE_RASTER != 0 { 1.0 } else { 0.0 };
        let [first, last] = pixels.map(|pixel| Vec2::new(pixel[0] as f32, pixel[1] as f32));
        let middle_px = 0.5 * (first + last);
        let pad_px = Vec2::splat(view.snap_px + wide) + ROUNDING * size;
        let corners = Corners::of(clip, size, middle_px, 0.5 * (last - first) + 1.0 + pad_px);
        let Corners { nearest, farthest, depth_error, slack_px, reach_px, .. } = corners;
        let off_plane =
            (nearest + depth_error - farthest.min(nearest)) * DEPTH_SLACK_PER_PIXEL * (grid_px(view) + wide);
        let mut fronts =
            Fronts { middle_px, pad_px, gradient: [Vec2::ZERO; 3], base: [nearest_of_box; 3], nearest: nearest_of_box };
        for (axis, side) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
            let gradient = corners.gradient(axis, side);
            let above = |corner: usize| corners.depth[corner] - gradient.dot(corners.place[corner]);
            let base = (0..8).map(above).fold(-3.0e38, f32::max);
            let steep = gradient.abs().dot(reach_px);
            let base =
                base + (gradient.abs().dot(slack_px) + depth_error + off_plane + 4.0 * ROUNDING * (steep + nearest));
            if steep < 3.0e38 && base < fronts.base[axis] {
                (fronts.gradient[axis], fronts.base[axis]) = (gradient, base);
            }
        }
        fronts
    }

    /// Depth that nothing of the box exceeds at the pixels from `first` to `last`. Twin of `nearest_of_fronts`.
    pub fn nearest_between(&self, first: [u32; 2], last: [u32; 2]) -> f32 {
        let [first, last] = [first, last].map(|pixel| Vec2::new(pixel[0] as f32, pixel[1] as f32));
        let low = first - self.pad_px - self.middle_px;
        let high = last + 1.0 + self.pad_px - self.middle_px;
        self.gradient.iter().zip(self.base).fold(self.nearest, |nearest, (gradient, base)| {
            let farther = (*gradient * low).max(*gradient * high);
            nearest.min(base + (farther.x + farther.y))
        })
    }
}
