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
