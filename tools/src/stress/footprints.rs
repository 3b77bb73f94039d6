//! What an object really covers, against the footprint that its box promises: the property on which culling rests.

use crate::stress::Lab;
use anyhow::Result;
use culling::frustum::twin::clip_from_bounds;
use culling::hzb::fronts::Fronts;
use culling::hzb::twin::{footprint_of, Footprint};
use culling::View;
use glam::{DAffine3, DVec2, DVec3};
use scenes::{Mesh, Object, Shot};
use shaders::types::{Bounds, CullView, DEPTH_SLACK_PER_PIXEL, ITEM_NONE, OBJECT_WIDE_RASTER};

/// Primitives lower than this are outside the raster conditions that depths are promised for (`include/footprint.glsl`).
pub const LEAST_HEIGHT_PX: f64 = 0.125;

/// What was seen over many objects.
#[derive(Clone, Debug)]
pub struct Covered {
    /// Objects that own a pixel and do not cross the near plane: those that say something.
    pub objects: usize,
    /// Pixels looked at.
    pub pixels: usize,
    /// Pixels outside a footprint, or of an object whose footprint is empty.
    pub outside: Vec<String>,
    /// Pixels nearer than a footprint's nearest depth, or than the fronts of the box there.
    pub too_near: Vec<TooNear>,
    /// Farthest that a pixel's centre lay outside the rectangle of its object's vertices, pixels.
    pub worst_outside_px: f64,
    /// Least that was left of what a rectangle is grown by before a pixel's centre would lie outside, pixels; infinite if nothing
    /// says anything.
    pub spare_px: f64,
    /// Least that was left before a pixel would have been nearer than its footprint says, of primitives at
    /// least [`LEAST_HEIGHT_PX`] high: representable depths.
    pub spare_depths: Option<i64>,
    /// Most that a pixel came nearer than its box, in depth ranges of the box times the vertex grid, by height of
    /// the lowest triangle or length of the shortest line: less than 1/8, 1/4, 1/2, 1, 4 pixels, and higher.
    pub worst_slack: [f64; 6],
    /// Most of these times the height: how far the device has moved a triangle against its depths, in vertex grids.
    pub worst_shift: f64,
}

impl Default for Covered {
    fn default() -> Self {
        Covered {
            objects: 0,
            pixels: 0,
            outside: Vec::new(),
            too_near: Vec::new(),
            worst_outside_px: 0.0,
            spare_px: f64::INFINITY,
            spare_depths: None,
            worst_slack: [0.0; 6],
            worst_shift: 0.0,
        }
    }
}

/// A pixel that is nearer than its object's footprint says, or the fronts of its box.
#[derive(Clone, Debug)]
pub struct TooNear {
    /// Its column and row.
    pub at: [u32; 2],
    /// True if only a primitive lower than [`LEAST_HEIGHT_PX`] can have made it: outside the raster conditions.
    pub thin: bool,
    /// Height of its lowest triangle, or length of its shortest line, in pixels.
    pub height_px: f64,
    /// How much nearer than the box, in depth ranges of the box times the vertex grid.
    pub slack: f64,
    /// For people.
    pub text: String,
}

/// Draws a shot and holds every pixel against its object's footprint; `shape` may change bounds and view
/// first, to plant errors.
pub fn covered(lab: &mut Lab, shot: &Shot, shape: impl Fn(&mut Bounds, &mut CullView)) -> Result<Covered> {
    let truth = lab.truth(shot)?;
    let view = lab.look(shot, 0)?;
    let bounds = lab.world.read_bounds()?;
    let mut seen = Covered::default();
    let mut places = Vec::new();
    lab.scene.motion.transforms_at(shot.seconds, &mut places);
    let moved: std::collections::HashMap<u32, DAffine3> = places.into_iter().collect();
    let meshes = lab.scene.meshes_at(shot.seconds);
    let mut prints = std::collections::HashMap::new();
    let images = truth.images();
    for (pixel, (item, depth)) in images.items.iter().zip(&images.depth).enumerate() {
        if *item == ITEM_NONE {
            continue;
        }
        let print = prints.entry(*item).or_insert_with(|| {
            let index = lab.world.scene_object(*item as usize);
            let mut object = lab.scene.objects[index].clone();
            object.world_from_object = *moved.get(&(index as u32)).unwrap_or(&object.world_from_object);
            Print::new(bounds[*item as usize], &view, &meshes, &object, &shape)
        });
        let at = [pixel as u32 % images.width, pixel as u32 / images.width];
        seen.pixel(print, at, *depth, lab.gpu.snap_px());
    }
    seen.objects = prints.values().filter(|print| !print.promised.crosses_near).count();
    Ok(seen)
}

/// An object's footprint with what it is measured by.
struct Print {
    name: String,
    promised: Footprint,
    /// Valid unless it crosses the near plane.
    fronts: Fronts,
    /// Nearest depth of the box alone, without the slack for the vertex grid, and the slack of one grid step.
    bare_nearest: f32,
    range: f32,
    low: DVec2,
    high: DVec2,
    primitives: Vec<Primitive>,
    /// Of the lowest primitive.
    height_px: f64,
    /// What the rectangle is grown by, pixels.
    grow_px: f64,
}

impl Print {
    fn new(
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
}

/// Can only a primitive outside the raster conditions have made this pixel so near? One of them reaches it, and none of the others
/// that do is as near there, by the bound that they keep.
fn is_thin(primitives: &[Primitive], grow_px: f64, centre: DVec2, depth: f32) -> bool {
    let reach = primitives.iter().filter(|primitive| primitive.reaches(centre, grow_px));
    let (thin, lawful): (Vec<&Primitive>, Vec<_>) = reach.partition(|primitive| primitive.height_px < LEAST_HEIGHT_PX);
    !thin.is_empty() && lawful.iter().all(|primitive| primitive.nearest_drawn(centre, grow_px) < f64::from(depth))
}

/// A triangle, line or point on the screen, in f64.
struct Primitive {
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

    /// No pixel of a primitive within the raster conditions is nearer (`include/footprint.glsl`); a triangle's is near its plane there.
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

/// What an object draws.
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

impl Covered {
    fn pixel(&mut self, print: &Print, at: [u32; 2], depth: f32, snap_px: f32) {
        let promised = &print.promised;
        if promised.crosses_near {
            return;
        }
        self.pixels += 1;
        let inside = (0..2).all(|axis| (promised.first[axis]..=promised.last[axis]).contains(&at[axis]));
        if promised.empty || !inside {
            self.outside.push(format!("{}: pixel {at:?} is outside its footprint {promised:?}", print.name));
        }
        let centre = DVec2::new(f64::from(at[0]), f64::from(at[1])) + 0.5;
        let away = (print.low - centre).max(centre - print.high);
        self.worst_outside_px = self.worst_outside_px.max(away.x).max(away.y);
        self.spare_px = self.spare_px.min(print.grow_px - away.max_element());
        if print.height_px >= LEAST_HEIGHT_PX {
            let spare = i64::from(promised.nearest.to_bits()) - i64::from(depth.to_bits());
            self.spare_depths = Some(self.spare_depths.map_or(spare, |least| least.min(spare)));
        }
        let slack = f64::from(depth - print.bare_nearest) / f64::from(print.range * snap_px).max(1e-30);
        let bin = [0.125, 0.25, 0.5, 1.0, 4.0].iter().position(|height| print.height_px < *height).unwrap_or(5);
        if print.range > 1e-5 * print.bare_nearest {
            self.worst_slack[bin] = self.worst_slack[bin].max(slack);
            self.worst_shift = self.worst_shift.max(slack * print.height_px);
        }
        let nearest = print.fronts.nearest_between(at, at);
        if depth > nearest {
            let text = format!(
                "{}: depth {depth:e} at {at:?} is nearer than {nearest:e} (its box: {:e}); primitive {:.4} px high, slack {slack:.2}",
                print.name, promised.nearest, print.height_px
            );
            let thin = is_thin(&print.primitives, print.grow_px, centre, depth);
            self.too_near.push(TooNear { at, thin, height_px: print.height_px, slack, text });
        }
    }

    /// Adds what was seen elsewhere.
    pub fn join(&mut self, other: Covered) {
        self.objects += other.objects;
        self.pixels += other.pixels;
        self.outside.extend(other.outside);
        self.too_near.extend(other.too_near);
        self.worst_outside_px = self.worst_outside_px.max(other.worst_outside_px);
        self.spare_px = self.spare_px.min(other.spare_px);
        self.spare_depths = self.spare_depths.into_iter().chain(other.spare_depths).min();
        self.worst_shift = self.worst_shift.max(other.worst_shift);
        for (mine, theirs) in self.worst_slack.iter_mut().zip(other.worst_slack) {
            *mine = mine.max(theirs);
        }
    }
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
