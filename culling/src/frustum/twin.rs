//! The frustum test in plain Rust, and the f64 oracle that bounds it from below.

use shaders::types::{
    Bounds, CullView, LocalBox, Object, BLOCK_OBJECTS, CLIP_ERROR, OBJECT_ALWAYS_KEPT, OBJECT_WIDE_RASTER,
    ORIENTED_ERROR, SAMPLE_REACH_PX, SHAPE_BOX, SHAPE_ORIENTED, SHAPE_SPHERE, SPHERE_ERROR,
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

/// An object as other tests than that of its world box take it.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// Its world box.
    pub bounds: &'a Bounds,
    /// Where it is, and how it is turned.
    pub object: &'a Object,
    /// The box of its mesh.
    pub local: &'a LocalBox,
}

/// The length of a vector of any size. Twin of `length_of`.
fn length_of(vector: Vec3) -> f32 {
    let largest = vector.abs().max_element();
    if largest > 0.0 {
        largest * (vector / largest).length()
    } else {
        0.0
    }
}

/// Twin of `sphere_reach`.
pub fn sphere_reach(half_extent: [f32; 3], plane: Vec4, view: &CullView) -> f32 {
    let row = [0, 1, 2].map(|column: usize| plane.dot(Vec4::from(view.clip_from_relative[column])));
    length_of(half_extent.into()) * length_of(row.into()) * (1.0 + SPHERE_ERROR)
}

/// The box of a mesh as its object turns it. Twin of `clip_from_local`.
pub fn clip_from_local(object: &Object, local: &LocalBox, view: &CullView) -> ClipBox {
    let coarse = Vec3::from(object.origin_high) - Vec3::from(view.camera_high);
    let origin = coarse + (Vec3::from(object.origin_low) - Vec3::from(view.camera_low));
    let columns = [object.column_x, object.column_y, object.column_z].map(Vec3::from);
    let clip = view.clip_from_relative.map(Vec4::from);
    let turned = |by: [f32; 3]| columns[0] * by[0] + columns[1] * by[1] + columns[2] * by[2];
    let along = |vector: Vec3| clip[0] * vector.x + clip[1] * vector.y + clip[2] * vector.z;
    let size = Vec3::from(local.centre).abs() + Vec3::from(local.half_extent);
    let reach = origin.abs() + columns[0].abs() * size.x + columns[1].abs() * size.y + columns[2].abs() * size.z;
    let sizes = clip[0].abs() * reach.x + clip[1].abs() * reach.y + clip[2].abs() * reach.z + clip[3].abs();
    ClipBox {
        centre: along(turned(local.centre) + origin) + clip[3],
        axes: std::array::from_fn(|axis| along(columns[axis] * local.half_extent[axis])),
        error: ORIENTED_ERROR * sizes,
    }
}

/// True if a box is outside one of the planes, and how many it was tested against. Twin of `outside_by_planes`.
fn outside_by_planes(clip: &ClipBox, widen: [f32; 2]) -> (bool, u32) {
    let failed = planes(widen).iter().position(|plane| farthest_along(clip, *plane) < 0.0);
    (failed.is_some(), failed.map_or(6, |plane| plane as u32 + 1))
}

/// True if what an object is tested by is outside the view volume, and against how many planes it was tested. Twin of `shape_outside`.
pub fn shape_outside(shape: u32, of: &Shape<'_>, view: &CullView) -> (bool, u32) {
    let widen = footprint_widening(of.bounds.flags, view);
    if shape == SHAPE_ORIENTED {
        return outside_by_planes(&clip_from_local(of.object, of.local, view), widen);
    }
    let clip = clip_from_bounds(of.bounds, view);
    if shape == SHAPE_BOX {
        return outside_by_planes(&clip, widen);
    }
    let reach = |plane: Vec4| sphere_reach(of.bounds.half_extent, plane, view) + plane.abs().dot(clip.error);
    let failed = planes(widen).iter().position(|plane| plane.dot(clip.centre) + reach(*plane) < 0.0);
    let inside = planes(widen).iter().all(|plane| reach(*plane) - plane.dot(clip.centre) <= 0.0);
    let tested = failed.map_or(6, |plane| plane as u32 + 1);
    if shape == SHAPE_SPHERE || failed.is_some() || inside {
        return (failed.is_some(), tested);
    }
    let (outside, by_box) = outside_by_planes(&clip, widen);
    (outside, tested + by_box)
}

/// Which objects are kept by a test of this shape: 1 or 0 each; those of other blocks than these are not. Twin of
/// `frustum/test_shapes`.
pub fn test_shapes(shape: u32, objects: &[Shape<'_>], blocks: &[u32], view: &CullView) -> Vec<u32> {
    let kept = |of: &Shape<'_>| {
        let always = of.bounds.flags & OBJECT_ALWAYS_KEPT != 0;
        let small = || too_small(&clip_from_bounds(of.bounds, view), view);
        always || !(shape_outside(shape, of, view).0 || small())
    };
    let in_view = |object: usize| blocks.contains(&(object as u32 / BLOCK_OBJECTS));
    objects.iter().enumerate().map(|(object, of)| u32::from(in_view(object) && kept(of))).collect()
}

/// Against how many planes the objects of some blocks are tested. Twin of `frustum/count_planes`.
pub fn count_planes(shape: u32, objects: &[Shape<'_>], blocks: &[u32], view: &CullView) -> u32 {
    let tested = |(object, of): (usize, &Shape<'_>)| {
        let looked_at = blocks.contains(&(object as u32 / BLOCK_OBJECTS));
        let always = of.bounds.flags & OBJECT_ALWAYS_KEPT != 0;
        if looked_at && !always {
            shape_outside(shape, of, view).1
        } else {
            0
        }
    };
    objects.iter().enumerate().map(tested).sum()
}

/// How far inside the view volume what an object is tested by reaches, in f64 and without rounding, as [`oracle_margin`] says of its
/// world box. The GPU keeps it from -[`SHAPE_KEPT_BAND`] up and culls it below -[`SHAPE_ROUNDING_BAND`]. Of spheres and boxes together:
/// the box decides, as it lies in the sphere.
pub fn shape_margin(shape: u32, of: &Shape<'_>, view: &CullView) -> f64 {
    let sum =
        |high: [f32; 3], low: [f32; 3]| glam::DVec3::from(high.map(f64::from)) + glam::DVec3::from(low.map(f64::from));
    let camera = sum(view.camera_high, view.camera_low);
    let clip = view.clip_from_relative.map(|column| glam::DVec4::from(column.map(f64::from)));
    let (middle, axes, size) = match shape {
        SHAPE_ORIENTED => {
            let columns = [of.object.column_x, of.object.column_y, of.object.column_z];
            let columns = columns.map(|column| glam::DVec3::from(column.map(f64::from)));
            let (centre, half) = (of.local.centre.map(f64::from), of.local.half_extent.map(f64::from));
            let origin = sum(of.object.origin_high, of.object.origin_low) - camera;
            let middle = origin + columns[0] * centre[0] + columns[1] * centre[1] + columns[2] * centre[2];
            let reach = (0..3).map(|axis| columns[axis].abs() * (centre[axis].abs() + half[axis]));
            let axes = std::array::from_fn(|axis| columns[axis] * half[axis]);
            (middle, axes, origin.abs() + reach.sum::<glam::DVec3>())
        }
        _ => {
            let middle = sum(of.bounds.centre_high, of.bounds.centre_low) - camera;
            let half = of.bounds.half_extent.map(f64::from);
            let axes = [glam::DVec3::X * half[0], glam::DVec3::Y * half[1], glam::DVec3::Z * half[2]];
            (middle, axes, middle.abs() + glam::DVec3::from(half))
        }
    };
    let margin = |plane: &Vec4| {
        let plane = plane.as_dvec4();
        let row = glam::DVec3::new(plane.dot(clip[0]), plane.dot(clip[1]), plane.dot(clip[2]));
        let parts = (0..3).map(|axis| plane.abs().dot(clip[axis].abs()) * size[axis]).sum::<f64>();
        let parts = parts + plane.abs().dot(clip[3].abs());
        let sphere = axes.iter().map(|axis| axis.length_squared()).sum::<f64>().sqrt() * row.length();
        let (reach, parts) = match shape {
            SHAPE_SPHERE => (sphere, parts + sphere),
            _ => (axes.iter().map(|axis| row.dot(*axis).abs()).sum(), parts),
        };
        (row.dot(middle) + plane.dot(clip[3]) + reach) / parts.max(f64::MIN_POSITIVE)
    };
    planes(footprint_widening(of.bounds.flags, view)).iter().map(margin).fold(f64::INFINITY, f64::min)
}

/// What of an error bound roundings may use up, and what they may add to it, see `include/shape.glsl`: a box's 32u less 12u (8u of
/// the dot products, 3u of a sphere's row, rounded up), and an oriented box's 64u with 16u, or a sphere's 64u of its reach with 35u.
pub const SHAPE_KEPT_BAND: f64 = 20.0 / 16_777_216.0;

/// See [`SHAPE_KEPT_BAND`].
pub const SHAPE_ROUNDING_BAND: f64 = 99.0 / 16_777_216.0;

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
