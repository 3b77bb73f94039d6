//! What an object really covers, against the footprint that its box promises: the property on which culling rests.

use crate::run::raster::prints::{centre, Print};
use crate::run::raster::Sight;
use crate::stress::Lab;
use anyhow::Result;
use scenes::Shot;
use shaders::types::{Bounds, CullView, ITEM_NONE};

pub use crate::run::raster::LEAST_HEIGHT_PX;

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
    let sight = Sight::of(&lab.world, &view, shot.seconds)?;
    let mut prints = sight.prints(&lab.scene);
    let mut seen = Covered::default();
    let images = truth.images();
    for (pixel, (item, depth)) in images.items.iter().zip(&images.depth).enumerate() {
        if *item != ITEM_NONE {
            let at = [pixel as u32 % images.width, pixel as u32 / images.width];
            seen.pixel(prints.of(*item, &shape), at, *depth, lab.gpu.snap_px());
        }
    }
    seen.objects = prints.all().filter(|print| !print.promised.crosses_near).count();
    Ok(seen)
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
        let centre = centre(at);
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
        if let Some(nearest) = print.nearest_at(at).filter(|nearest| depth > *nearest) {
            let text = format!(
                "{}: depth {depth:e} at {at:?} is nearer than {nearest:e} (its box: {:e}); primitive {:.4} px high, slack {slack:.2}",
                print.name, promised.nearest, print.height_px
            );
            let thin = print.is_thin(at, depth);
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
    use crate::stress::worlds::{mesh, shot};
    use culling::View;
    use glam::{DVec3, Vec3};
    use scenes::{Projection, Topology};

    const SIDE: u32 = 16;
    const SNAP_PX: f32 = 1.0 / 256.0;

    /// A triangle from column 6 to 10 and row 6 to 10, 4 to 8 m before a camera that sees 16 m; a pixel is a metre. Its lowest height is 3.58 pixels.
    fn print() -> Print {
        let corners = vec![Vec3::new(-2.0, -2.0, -4.0), Vec3::new(2.0, -2.0, -4.0), Vec3::new(0.0, 2.0, -8.0)];
        let mut maker = crate::stress::worlds::Maker::new("triangle");
        let triangle = maker.mesh(mesh("triangle", Topology::Triangles, corners, vec![0, 1, 2]));
        maker.place(triangle, glam::DAffine3::IDENTITY);
        let projection = Projection::Orthographic { half_height: 8.0, near: 0.0, far: 16.0 };
        let view = View::new(&shot(DVec3::ZERO, DVec3::NEG_Z, projection), [SIDE; 2], 0, SNAP_PX);
        let bounds = Bounds { centre_high: [0.0, 0.0, -6.0], half_extent: [2.0; 3], ..Bounds::default() };
        Print::new(bounds, &view, &maker.scene.meshes, &maker.scene.objects[0], &|_, _| ())
    }

    fn seen(pixels: &[([u32; 2], f32)]) -> Covered {
        let (print, mut seen) = (print(), Covered::default());
        pixels.iter().for_each(|(at, depth)| seen.pixel(&print, *at, *depth, SNAP_PX));
        seen
    }

    #[test]
    fn a_pixel_within_its_footprint_says_what_was_to_spare() {
        // Farther than the box's nearest depth, 0.75: by a quarter of its bits and more.
        let one = seen(&[([8, 8], 0.6)]);
        assert_eq!((one.pixels, one.outside.len(), one.too_near.len()), (1, 0, 0));
        assert_eq!((one.worst_outside_px, one.worst_slack, one.worst_shift), (0.0, [0.0; 6], 0.0));
        // The centre at 8.5 is 1.5 from column 10.
        assert!((one.spare_px - (1.5 + f64::from(SNAP_PX))).abs() < 1e-9, "{}", one.spare_px);
        let spare = i64::from(print().promised.nearest.to_bits()) - i64::from(0.6f32.to_bits());
        assert!(spare > 0);
        assert_eq!(one.spare_depths, Some(spare));
        // The least of several counts, in either order.
        let near = 0.7f32;
        let least = i64::from(print().promised.nearest.to_bits()) - i64::from(near.to_bits());
        for order in [[0.6, near], [near, 0.6]] {
            let two = seen(&order.map(|depth| ([7, 8], depth)));
            assert_eq!((two.pixels, two.spare_depths), (2, Some(least)));
        }
    }

    #[test]
    fn a_pixel_beside_its_footprint_is_outside_by_its_distance() {
        for (at, away) in [([11, 8], 1.5), ([8, 12], 2.5), ([3, 8], 2.5), ([8, 4], 1.5), ([12, 11], 2.5)] {
            let one = seen(&[(at, 0.6)]);
            assert!(one.outside.len() == 1 && one.outside[0].contains(&format!("pixel {at:?}")), "{:?}", one.outside);
            assert!((one.worst_outside_px - away).abs() < 1e-9, "{at:?}: {}", one.worst_outside_px);
            assert!((one.spare_px - (f64::from(SNAP_PX) - away)).abs() < 1e-9, "{at:?}: {}", one.spare_px);
        }
        let both = seen(&[([11, 8], 0.6), ([8, 12], 0.6), ([8, 8], 0.6)]);
        assert_eq!((both.pixels, both.outside.len()), (3, 2));
        assert!((both.worst_outside_px - 2.5).abs() < 1e-9);
    }

    #[test]
    fn a_pixel_nearer_than_its_box_is_told_with_its_slack() {
        let one = seen(&[([8, 8], 0.875)]);
        let [near] = one.too_near.as_slice() else { panic!("{:?}", one.too_near) };
        assert!(!near.thin && near.at == [8, 8] && one.spare_depths.is_some_and(|spare| spare < 0));
        // 1/8 nearer than 0.75, and the box's depths range over 1/4: half of a range, in steps of 1/256 pixel.
        assert!((near.slack - 128.0).abs() < 2.0, "{}", near.slack);
        assert!((near.height_px - 3.578).abs() < 1e-3, "{}", near.height_px);
        assert_eq!(one.worst_slack, [0.0, 0.0, 0.0, 0.0, near.slack, 0.0], "between 1 and 4 pixels high");
        assert_eq!(one.worst_shift, near.slack * near.height_px);
    }

    #[test]
    fn what_crosses_the_near_plane_promises_nothing() {
        let (mut print, mut seen) = (print(), Covered::default());
        print.promised.crosses_near = true;
        seen.pixel(&print, [15, 15], 1.0, SNAP_PX);
        assert_eq!((seen.pixels, seen.outside.len(), seen.too_near.len()), (0, 0, 0));
        // An empty footprint holds no pixel.
        print.promised.crosses_near = false;
        print.promised.empty = true;
        seen.pixel(&print, [8, 8], 0.6, SNAP_PX);
        assert_eq!((seen.pixels, seen.outside.len()), (1, 1));
    }

    #[test]
    fn joined_frames_add_up_and_keep_the_worst_of_both() {
        let near = |height_px| TooNear { at: [1, 2], thin: false, height_px, slack: 1.0, text: String::new() };
        let one = Covered {
            objects: 3,
            pixels: 40,
            outside: vec!["one".into()],
            too_near: vec![near(1.0)],
            worst_outside_px: 0.5,
            spare_px: 0.25,
            spare_depths: Some(9),
            worst_slack: [1.0, 0.0, 3.0, 0.0, 0.0, 6.0],
            worst_shift: 7.0,
        };
        let other = Covered {
            objects: 5,
            pixels: 80,
            outside: vec!["two".into()],
            too_near: vec![near(2.0)],
            worst_outside_px: 0.75,
            spare_px: 0.125,
            spare_depths: Some(4),
            worst_slack: [0.5, 2.0, 0.0, 4.0, 0.0, 5.0],
            worst_shift: 8.0,
        };
        for (first, second) in [(&one, &other), (&other, &one)] {
            let mut both = Covered::default();
            both.join(first.clone());
            assert_eq!(
                (both.objects, both.pixels, both.spare_depths),
                (first.objects, first.pixels, first.spare_depths)
            );
            both.join(second.clone());
            both.join(Covered::default());
            assert_eq!((both.objects, both.pixels), (8, 120));
            assert_eq!(both.outside.len() + both.too_near.len(), 4);
            assert_eq!((both.worst_outside_px, both.spare_px, both.spare_depths), (0.75, 0.125, Some(4)));
            assert_eq!((both.worst_slack, both.worst_shift), ([1.0, 2.0, 3.0, 4.0, 0.0, 6.0], 8.0));
        }
    }
}
