//! The raster conditions: exact methods promise depths under them. One rule for `bench` and `stress`.
//!
//! A face seen on edge may still own a pixel, as vertices are snapped to a grid. Its plane then stands upright on the screen, and the
//! device takes the pixel's depth from the plane, part of a grid step outside the face. That depth can be nearer than everything else
//! in the picture, and no bound on a box holds it (`include/footprint.glsl`). So depths are promised of primitives of
//! [`LEAST_HEIGHT_PX`] and higher. A pixel is *thin* if it is nearer than the bounds of its object allow, and only a lower primitive
//! can have made it so near. Errors at thin pixels alone are counted apart.

pub(crate) mod prints;

pub use prints::LEAST_HEIGHT_PX;

use crate::measures::metrics::{FrameError, FrameImages, Truth, NO_ITEM};
use anyhow::Result;
use culling::{View, World};
use engine::DepthFormat;
use glam::DAffine3;
use prints::Print;
use scenes::{Mesh, Scene};
use shaders::types::{Bounds, CullView};
use std::borrow::Cow;
use std::collections::HashMap;

/// A frame's view of a world: the data of the rule, apart from the pictures and the scene.
pub struct Sight {
    /// Indexed by world object.
    bounds: Vec<Bounds>,
    /// The scene's object of each world object.
    scene_objects: Vec<usize>,
    view: View,
    seconds: f64,
}

impl Sight {
    /// Reads the data of a world at its current time, `seconds`.
    ///
    /// # Errors
    /// An error of the device.
    pub fn of(world: &World, view: &View, seconds: f64) -> Result<Self> {
        let bounds = world.read_bounds()?;
        let scene_objects = (0..bounds.len()).map(|object| world.scene_object(object)).collect();
        Ok(Sight { bounds, scene_objects, view: *view, seconds })
    }

    /// Footprints of objects, each made when it is asked for.
    pub(crate) fn prints<'a>(&'a self, scene: &'a Scene) -> Prints<'a> {
        let mut places = Vec::new();
        scene.motion.transforms_at(self.seconds, &mut places);
        Prints {
            sight: self,
            scene,
            meshes: scene.meshes_at(self.seconds),
            moved: places.into_iter().collect(),
            made: HashMap::new(),
        }
    }
}

/// Footprints of a frame's objects.
pub(crate) struct Prints<'a> {
    sight: &'a Sight,
    scene: &'a Scene,
    meshes: Cow<'a, [Mesh]>,
    moved: HashMap<u32, DAffine3>,
    made: HashMap<u32, Print>,
}

impl Prints<'_> {
    /// The footprint of a world object; `shape` may change its bounds and the view first, to plant errors.
    pub(crate) fn of(&mut self, item: u32, shape: &impl Fn(&mut Bounds, &mut CullView)) -> &Print {
        self.made.entry(item).or_insert_with(|| {
            let index = self.sight.scene_objects[item as usize];
            let mut object = self.scene.objects[index].clone();
            object.world_from_object = *self.moved.get(&(index as u32)).unwrap_or(&object.world_from_object);
            Print::new(self.sight.bounds[item as usize], &self.sight.view, &self.meshes, &object, shape)
        })
    }

    /// All footprints that were made.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Print> {
        self.made.values()
    }
}

/// True if depths are promised, so that a pixel can be outside the raster conditions. Bounds are derived for one sample a pixel and the
/// default depth format.
pub fn is_promised(samples: u32, depth: DepthFormat) -> bool {
    samples == 1 && depth == DepthFormat::default()
}

/// True if a frame has an error that [`judged`] could excuse: a depth differs from the truth, or a visible object is not drawn. Cheap.
pub fn is_wrong(truth: &Truth, images: &FrameImages, drawn: &[bool]) -> bool {
    let (true_depth, depth): (&[u32], &[u32]) =
        (bytemuck::cast_slice(&truth.images().depth), bytemuck::cast_slice(&images.depth));
    true_depth != depth || truth.visible_objects().any(|object| !drawn[object])
}

/// Returns the error of a frame, and the number of its thin pixels. If thin pixels explain every error, the error counts neither them
/// nor the objects that are visible only there, and the picture counts as the truth's. If they do not, the error counts everything, and
/// the number is 0. For frames for which [`is_promised`] is true.
pub fn judged(
    scene: &Scene,
    sight: &Sight,
    truth: &Truth,
    (images, drawn): (&FrameImages, &[bool]),
    error: FrameError,
) -> (FrameError, u64) {
    if error.false_negatives + error.differing_pixels == 0 || error.wrong_colour_pixels > 0 {
        return (error, 0);
    }
    let wrong = wrong_pixels(truth.images(), images, drawn);
    // A lost object that owns no pixel (a translucent one) cannot be excused by a pixel.
    let mut owners = vec![false; drawn.len()];
    truth.images().items.iter().filter(|item| **item != NO_ITEM).for_each(|item| owners[*item as usize] = true);
    let excusable = truth.visible_objects().all(|object| drawn[object] || owners[object]);
    let mut prints = sight.prints(scene);
    let mut is_thin = |pixel: usize| {
        let TruePixel { item, depth, at } = true_pixel(truth.images(), pixel);
        item != NO_ITEM && prints.of(item, &|_, _| ()).is_thin(at, depth)
    };
    match excusable && wrong.iter().all(|pixel| is_thin(*pixel)) {
        true => (error.without_faults(), wrong.len() as u64),
        false => (error, 0),
    }
}

/// Pixels of another depth than in the truth, and all pixels of objects that were not drawn.
fn wrong_pixels(truth: &FrameImages, images: &FrameImages, drawn: &[bool]) -> Vec<usize> {
    let lost = |item: u32| item != NO_ITEM && !drawn[item as usize];
    let differs = |pixel: usize| truth.depth[pixel].to_bits() != images.depth[pixel].to_bits();
    (0..truth.depth.len()).filter(|&pixel| differs(pixel) || lost(truth.items[pixel])).collect()
}

struct TruePixel {
    item: u32,
    depth: f32,
    /// Column and row.
    at: [u32; 2],
}

fn true_pixel(images: &FrameImages, pixel: usize) -> TruePixel {
    let at = [pixel as u32 % images.width, pixel as u32 / images.width];
    TruePixel { item: images.items[pixel], depth: images.depth[pixel], at }
}

#[cfg(test)]
mod tests;
