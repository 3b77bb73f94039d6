//! The footprint that an object's box promises, and the primitives that the object draws, in f64. They tell a broken bound from a
//! primitive outside the raster conditions.

use culling::frustum::twin::clip_from_bounds;
use culling::hzb::fronts::Fronts;
use culling::hzb::twin::{footprint_of, Footprint};
use culling::View;
use glam::{DVec2, DVec3};
use scenes::{Mesh, Object};
use shaders::types::{Bounds, CullView, DEPTH_SLACK_PER_PIXEL, OBJECT_WIDE_RASTER};

/// Primitives lower than this are outside the raster conditions that depths are promised for (`include/footprint.glsl`).
pub const LEAST_HEIGHT_PX: f64 = 0.125;

/// An object's footprint, with the data that it is checked against.
pub(crate) struct Print {
    pub(crate) name: String,
    pub(crate) promised: Footprint,
    /// Valid unless it crosses the near plane.
    pub(crate) fronts: Fronts,
    /// Nearest depth of the box alone, without the slack for the vertex grid, and the slack of one grid step.
    pub(crate) bare_nearest: f32,
    pub(crate) range: f32,
    pub(crate) low: DVec2,
    pub(crate) high: DVec2,
    primitives: Vec<Primitive>,
    /// Of the lowest primitive.
    pub(crate) height_px: f64,
    /// Growth of the rectangle, pixels.
    pub(crate) grow_px: f64,
}

impl Print {
    /// `shape` may change bounds and view first, to plant errors.
    pub(crate) fn new(
        mut bound: Bounds,
        view: &View,
        meshes: &[Mesh],
        object: &Object,
        shape: &impl Fn(&mut Bounds, &mut CullView),
    ) -> Self {
        let mut cull = view.cull();
        shape(&mut bound, &mut cull);
        let clip = clip_from_bounds(&bound, &cull);
        let promised = footprint_of(&clip, &cull, bound.flags);
        let bare_flags = bound.flags & !OBJECT_WIDE_RASTER;
        let unsnapped = footprint_of(&clip, &CullView { snap_px: 0.0, ..cull }, bare_flags);
        // The slack is linear in the grid, unless it was cut off at the near plane: a coarse grid tells the range.
        let coarser = footprint_of(&clip, &CullView { snap_px: 1e-3, ..cull }, bare_flags);
        let range = (coarser.nearest - unsnapped.nearest) / (DEPTH_SLACK_PER_PIXEL * 1e-3);
        let primitives = primitives(view, meshes, object);
        let low = primitives.iter().map(|primitive| primitive.low).fold(DVec2::INFINITY, DVec2::min);
        let high = primitives.iter().map(|primitive| primitive.high).fold(DVec2::NEG_INFINITY, DVec2::max);
        let height_px = primitives.iter().map(|primitive| primitive.height_px).fold(f64::INFINITY, f64::min);
        let wide = bound.flags & OBJECT_WIDE_RASTER != 0;
        let grow_px = f64::from(cull.snap_px) + if wide { 1.0 } else { 0.0 };
        Print {
            name: object.name.clone(),
            promised,
            fronts: Fronts::of(&clip, [promised.first, promised.last], promised.nearest, &cull, bound.flags),
            bare_nearest: unsnapped.nearest,
            range,
            low,
            high,
            primitives,
            height_px,
            grow_px,
        }
    }

    /// The nearest depth that the object's bounds allow for a pixel; none where nothing is promised of it.
    pub(crate) fn nearest_at(&self, at: [u32; 2]) -> Option<f32> {
        (!self.promised.crosses_near).then(|| self.fronts.nearest_between(at, at))
    }

    /// True if this pixel is nearer than the bounds allow, and only a primitive outside the raster conditions can have made it so near.
    pub(crate) fn is_thin(&self, at: [u32; 2], depth: f32) -> bool {
        let is_near = self.nearest_at(at).is_some_and(|nearest| depth > nearest);
        is_near && is_thin(&self.primitives, self.grow_px, centre(at), depth)
    }
}

/// The middle of a pixel.
pub(crate) fn centre(at: [u32; 2]) -> DVec2 {
    DVec2::new(f64::from(at[0]), f64::from(at[1])) + 0.5
}

/// True if only a primitive outside the raster conditions can have made this pixel so near: such a primitive reaches the pixel, and
/// every other primitive that reaches it is farther, by its own bound.
fn is_thin(primitives: &[Primitive], grow_px: f64, centre: DVec2, depth: f32) -> bool {
    let reach = primitives.iter().filter(|primitive| primitive.reaches(centre, grow_px));
    let (thin, lawful): (Vec<&Primitive>, Vec<_>) = reach.partition(|primitive| primitive.height_px < LEAST_HEIGHT_PX);
    !thin.is_empty() && lawful.iter().all(|primitive| primitive.nearest_drawn(centre, grow_px) < f64::from(depth))
}

/// A triangle, line or point on the screen, in f64.
pub(crate) struct Primitive {
    /// The shortest height of a triangle, the length of a line; of a point, 0.
    height_px: f64,
    low: DVec2,
    high: DVec2,
    nearest: f64,
    farthest: f64,
    /// Pixels, and depth.
    corners: Vec<DVec3>,
}

impl Primitive {
    /// `corners`: pixels, and depth.
    fn new(corners: &[DVec3]) -> Self {
        let nearest = corners.iter().map(|corner| corner.z).fold(f64::NEG_INFINITY, f64::max);
        let farthest = corners.iter().map(|corner| corner.z).fold(f64::INFINITY, f64::min);
        let places: Vec<DVec2> = corners.iter().map(|corner| corner.truncate()).collect();
        Primitive {
            height_px: height(&places),
            low: places.iter().copied().fold(DVec2::INFINITY, DVec2::min),
            high: places.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max),
            nearest,
            farthest,
            corners: corners.to_vec(),
        }
    }

    fn reaches(&self, centre: DVec2, grow_px: f64) -> bool {
        centre.cmpge(self.low - grow_px).all() && centre.cmple(self.high + grow_px).all()
    }

    /// Returns the nearest depth of a pixel of a primitive within the raster conditions (`include/footprint.glsl`). A triangle's depth
    /// is near its plane there.
    fn nearest_drawn(&self, centre: DVec2, grid_px: f64) -> f64 {
        let slack = (self.nearest - self.farthest) * f64::from(DEPTH_SLACK_PER_PIXEL) * grid_px;
        let nearest = match self.corners[..] {
            [a, b, c] => self.nearest.min(plane_at(a, b, c, centre)),
            _ => self.nearest,
        };
        nearest + slack
    }
}

fn plane_at(a: DVec3, b: DVec3, c: DVec3, at: DVec2) -> f64 {
    let (along, across, to) = ((b - a).truncate(), (c - a).truncate(), at - a.truncate());
    let area = along.perp_dot(across);
    a.z + (to.perp_dot(across) * (b.z - a.z) + along.perp_dot(to) * (c.z - a.z)) / area
}

/// Returns the primitives of an object.
fn primitives(view: &View, meshes: &[Mesh], object: &Object) -> Vec<Primitive> {
    let size = DVec3::new(f64::from(view.size[0]), f64::from(view.size[1]), 1.0);
    let vertex = |position: &glam::Vec3| {
        let relative: DVec3 = object.world_from_object.transform_point3(position.as_dvec3()) - view.pose.position;
        let clip = view.clip_from_relative() * relative.extend(1.0);
        let projected = clip.truncate() / clip.w;
        (projected.truncate() * 0.5 + 0.5).extend(projected.z) * size
    };
    let Mesh { positions, indices, topology, .. } = &meshes[object.mesh as usize];
    let corners: Vec<DVec3> = positions.iter().map(vertex).collect();
    let faces = indices.chunks([3, 2, 1][*topology as usize]);
    faces
        .map(|face| Primitive::new(&face.iter().map(|index| corners[*index as usize]).collect::<Vec<DVec3>>()))
        .collect()
}

/// The shortest height of a triangle, the length of a line; of a point, 0.
fn height(corners: &[DVec2]) -> f64 {
    let [a, b, c] = match corners {
        [a, b, c] => [a, b, c],
        [a, b] => return (*a - *b).length(),
        _ => return 0.0,
    };
    let longest = (*b - *a).length().max((*c - *b).length()).max((*a - *c).length());
    (*b - *a).perp_dot(*c - *a).abs() / longest.max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID_PX: f64 = 1.0 / 256.0;

    fn triangle(corners: [[f64; 3]; 3]) -> Primitive {
        Primitive::new(&corners.map(DVec3::from))
    }

    /// On edge at x = 10.5, from depth 0.1 to 0.2.
    fn on_edge() -> Primitive {
        triangle([[10.5, 4.0, 0.1], [10.501, 9.0, 0.2], [10.5, 12.0, 0.15]])
    }

    fn upright() -> Primitive {
        triangle([[8.0, 4.0, 0.1], [14.0, 4.0, 0.2], [8.0, 12.0, 0.15]])
    }

    #[test]
    fn only_a_low_primitive_that_reaches_the_pixel_excuses_it() {
        let at = DVec2::new(10.5, 8.5);
        assert!(is_thin(&[on_edge()], GRID_PX, at, 0.5));
        assert!(is_thin(&[upright(), on_edge()], GRID_PX, at, 0.5), "the other is not as near");
        assert!(!is_thin(&[upright()], GRID_PX, at, 0.5), "nothing low is there: a bound is broken");
        assert!(!is_thin(&[on_edge()], GRID_PX, at + DVec2::X, 0.5), "it does not reach so far");
        assert!(!is_thin(&[upright(), on_edge()], GRID_PX, at, 0.165), "the other may have made it");
        assert!(!is_thin(&[], GRID_PX, at, 0.5));
    }

    #[test]
    fn what_a_lawful_primitive_may_draw_beyond_its_corners_is_its_own() {
        let at = DVec2::new(10.5, 8.5);
        let slack = 0.1 * f64::from(DEPTH_SLACK_PER_PIXEL) * GRID_PX;
        let primitives = [upright(), on_edge()];
        // Its plane: 0.1 at (8, 4), 0.1 more in 6 pixels across, 0.05 in 8 down.
        let plane = 0.1 + 0.1 * 2.5 / 6.0 + 0.05 * 4.5 / 8.0;
        assert!(!is_thin(&primitives, GRID_PX, at, (plane + 0.9 * slack) as f32));
        assert!(is_thin(&primitives, GRID_PX, at, (plane + 1.1 * slack) as f32));
    }
}
