//! The frustum test in plain Rust, and the f64 oracle that bounds it from below.

use shaders::types::{
    Bounds, CullView, BLOCK_OBJECTS, CLIP_ERROR, OBJECT_ALWAYS_KEPT, OBJECT_WIDE_RASTER, SAMPLE_REACH_PX,
};

type Vec4 = glam::Vec4;
type Vec3 = glam::Vec3;

/// A box in clip space: centre, half-extent vectors and how far off each coordinate may be. Twin of `ClipBox`.
#[derive(Clone, Copy, Debug)]
pub struct ClipBox {
    /// Clip position of the centre.
    pub centre: Vec4,
    /// Half extents as clip vectors.
    pub axes: [Vec4; 3],
    /// Bound of each coordinate's error.
    pub error: Vec4,
}

/// Twin of `grid_px`.
pub fn grid_px(view: &CullView) -> f32 {
    if view.snap_px >= SAMPLE_REACH_PX {
        view.snap_px - SAMPLE_REACH_PX
    } else {
        view.snap_px
    }
}

/// Twin of `clip_from_bounds`.
pub fn clip_from_bounds(bounds: &Bounds, view: &CullView) -> ClipBox {
    let coarse = Vec3::from(bounds.centre_high) - Vec3::from(view.camera_high);
    let fine = Vec3::from(bounds.centre_low) - Vec3::from(view.camera_low);
    let (centre, half) = (coarse + fine, Vec3::from(bounds.half_extent));
    let clip = view.clip_from_relative.map(Vec4::from);
    let reach = centre.abs() + half;
    ClipBox {
        centre: clip[0] * centre.x + clip[1] * centre.y + clip[2] * centre.z + clip[3],
        axes: [clip[0] * half.x, clip[1] * half.y, clip[2] * half.z],
        error: CLIP_ERROR
            * (clip[0].abs() * reach.x + clip[1].abs() * reach.y + clip[2].abs() * reach.z + clip[3].abs()),
    }
}

/// Twin of `farthest_along`.
pub fn farthest_along(clip: &ClipBox, plane: Vec4) -> f32 {
    let axes: f32 = clip.axes.iter().map(|axis| plane.dot(*axis).abs()).sum();
    plane.dot(clip.centre) + axes + plane.abs().dot(clip.error)
}

/// Planes of the view volume: outside where the dot product with a clip position is below 0.
pub fn planes(widen: [f32; 2]) -> [Vec4; 6] {
    [
        Vec4::new(1.0, 0.0, 0.0, widen[0]),
        Vec4::new(-1.0, 0.0, 0.0, widen[0]),
        Vec4::new(0.0, 1.0, 0.0, widen[1]),
        Vec4::new(0.0, -1.0, 0.0, widen[1]),
        Vec4::new(0.0, 0.0, 1.0, 0.0),
        Vec4::new(0.0, 0.0, -1.0, 1.0),
    ]
}

/// How far footprints reach beyond geometry: one pixel for lines and points.
pub fn footprint_widening(flags: u32, view: &CullView) -> [f32; 2] {
    if flags & OBJECT_WIDE_RASTER == 0 {
        return [1.0; 2];
    }
    [1.0 + 2.0 / view.width_px as f32, 1.0 + 2.0 / view.height_px as f32]
}

/// Twin of `outside_frustum`.
pub fn outside_frustum(clip: &ClipBox, widen: [f32; 2]) -> bool {
    planes(widen).iter().any(|plane| farthest_along(clip, *plane) < 0.0)
}

/// True if all that a box may hold is smaller on the screen than is asked for. Twin of `too_small`.
pub fn too_small(clip: &ClipBox, view: &CullView) -> bool {
    let arms: [f32; 4] =
        std::array::from_fn(|i| clip.axes[0][i].abs() + clip.axes[1][i].abs() + clip.axes[2][i].abs() + clip.error[i]);
    let w_low = clip.centre[3] - arms[3];
    let across = |axis: usize, size: u32| {
        (arms[axis] + (clip.centre[axis] / clip.centre[3]).abs() * arms[3]) / w_low * size as f32
    };
    w_low > 0.0 && across(0, view.width_px).max(across(1, view.height_px)) < view.detail_px
}

/// True if nothing in a box is to be drawn, whatever hides it. Twin of `left_out`.
pub fn left_out(clip: &ClipBox, flags: u32, view: &CullView) -> bool {
    outside_frustum(clip, footprint_widening(flags, view)) || too_small(clip, view)
}

/// Which blocks of objects are in view, ascending. Twin of `frustum/test_blocks`.
pub fn test_blocks(blocks: &[Bounds], view: &CullView) -> Vec<u32> {
    let in_view = |block: &Bounds| {
        let always = block.flags & OBJECT_ALWAYS_KEPT != 0;
        always || !outside_frustum(&clip_from_bounds(block, view), footprint_widening(block.flags, view))
    };
    (0..blocks.len() as u32).filter(|block| in_view(&blocks[*block as usize])).collect()
}

/// Which objects are kept: 1 or 0 each; those of other blocks than these are not. Twin of `frustum/test_bounds`.
pub fn test_bounds(bounds: &[Bounds], blocks: &[u32], view: &CullView) -> Vec<u32> {
    let kept = |bound: &Bounds| {
        let always = bound.flags & OBJECT_ALWAYS_KEPT != 0;
        always || !left_out(&clip_from_bounds(bound, view), bound.flags, view)
    };
    let in_view = |object: usize| blocks.contains(&(object as u32 / BLOCK_OBJECTS));
    bounds.iter().enumerate().map(|(object, bound)| u32::from(in_view(object) && kept(bound))).collect()
}

/// How far inside the view volume a box reaches, in f64 and without rounding: the least over the planes of the largest
/// plane value in the box, divided by what such values consist of. Below 0 the box is outside some plane. The GPU keeps
/// the box from -[`KEPT_BAND`] up and culls it below -[`ROUNDING_BAND`]; between them its own rounding decides.
pub fn oracle_margin(bounds: &Bounds, view: &CullView) -> f64 {
    let vec =
        |high: [f32; 3], low: [f32; 3]| glam::DVec3::from(high.map(f64::from)) + glam::DVec3::from(low.map(f64::from));
    let centre = vec(bounds.centre_high, bounds.centre_low) - vec(view.camera_high, view.camera_low);
    let half = glam::DVec3::from(bounds.half_extent.map(f64::from));
    let clip = view.clip_from_relative.map(|column| glam::DVec4::from(column.map(f64::from)));
    let widen = footprint_widening(bounds.flags, view);
    let margin = |plane: Vec4| {
        let plane = plane.as_dvec4();
        let along = [plane.dot(clip[0]), plane.dot(clip[1]), plane.dot(clip[2])];
        let value: f64 = plane.dot(clip[3])
            + (0..3).map(|axis| along[axis] * centre[axis] + along[axis].abs() * half[axis]).sum::<f64>();
        let reach = centre.abs() + half;
        let size: f64 = plane.abs().dot(clip[3].abs())
            + (0..3).map(|axis| plane.abs().dot(clip[axis].abs()) * reach[axis]).sum::<f64>();
        value / size.max(f64::MIN_POSITIVE)
    };
    planes(widen).into_iter().map(margin).fold(f64::INFINITY, f64::min)
}

/// Where f32 and f64 may disagree, as a share of the plane value's parts: the error bound itself plus the rounding of the
/// dot products (8u), see `include/cull.glsl`.
pub const ROUNDING_BAND: f64 = CLIP_ERROR as f64 + 8.0 / 16_777_216.0;

/// How far outside a box is kept for certain: the error bound less the rounding of the dot products.
pub const KEPT_BAND: f64 = CLIP_ERROR as f64 - 8.0 / 16_777_216.0;
