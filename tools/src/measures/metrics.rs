//! How far a method's frame is from the truth: its visible set and its picture against those of `none`, which draws
//! everything. Words as in the papers: the *visible set* (REF) is the objects that own at least one pixel of the item
//! buffer, and the translucent ones that leave a fragment in front of it; a *false negative* is in REF but not drawn, a *false positive* drawn but not in REF; a *tie* is a pixel of
//! equal depth won by another object, counted apart and never an error.
//!
//! Everything here is arithmetic on read-back images: no GPU, so that the harness itself can be tested with planted
//! errors (`metrics/tests.rs`).

mod aggregate;
mod depth;
mod picture;
#[cfg(test)]
mod tests;

pub use aggregate::MethodErrors;
pub use depth::{DepthErrors, NOTICED};
pub(crate) use picture::{class_of, PixelClass};

use std::borrow::Cow;

/// The item buffer's value where no object was drawn.
pub const NO_ITEM: u32 = u32::MAX;

/// What one frame left in its targets, read back. All three images are row-major, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameImages {
    /// Width in pixels, > 0.
    pub width: u32,
    /// Height in pixels, > 0.
    pub height: u32,
    /// RGBA, 8 bits a channel.
    pub colour: Vec<[u8; 4]>,
    /// Reversed depth: 1 near, 0 far.
    pub depth: Vec<f32>,
    /// The index of the object that owns the pixel, or [`NO_ITEM`].
    pub items: Vec<u32>,
    /// Translucent objects that leave a fragment in front of all that hides: visible, though they own no pixel. Of the truth alone.
    pub seen_through: Vec<u32>,
}

impl FrameImages {
    /// Every visible object, most of them many times: who owns each pixel, and what is seen through.
    pub fn visible_items(&self) -> Cow<'_, [u32]> {
        match self.seen_through.is_empty() {
            true => Cow::Borrowed(&self.items),
            false => Cow::Owned([&self.items[..], &self.seen_through].concat()),
        }
    }
}

/// Why two frames cannot be compared. Each is a defect of the harness or of a shader, not an error of culling.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MetricError {
    /// An image is empty or has another number of pixels than its size says.
    #[error("the {image} image of the {frame} frame has {found} pixels, but its size is {width}x{height}")]
    Size {
        /// `truth` or `method`.
        frame: &'static str,
        /// `colour`, `depth` or `item`.
        image: &'static str,
        /// Pixels in the image.
        found: usize,
        /// Width of the frame.
        width: u32,
        /// Height of the frame.
        height: u32,
    },
    /// The two frames differ in size.
    #[error("the method's frame is {}x{} pixels, the truth's {}x{}: render both at one size", method.0, method.1, truth.0, truth.1)]
    Sizes {
        /// Width and height of the method's frame.
        method: (u32, u32),
        /// Width and height of the truth.
        truth: (u32, u32),
    },
    /// A depth is not a number.
    #[error("the {frame} frame's depth is NaN at pixel ({x}, {y}): look for a division by zero in the transform")]
    NanDepth {
        /// `truth` or `method`.
        frame: &'static str,
        /// Column of the first such pixel.
        x: u32,
        /// Row of the first such pixel.
        y: u32,
    },
    /// The item buffer names an object that the scene does not have.
    #[error("the {frame} frame's item buffer names object {item}, but the scene has {objects} objects")]
    UnknownItem {
        /// `truth` or `method`.
        frame: &'static str,
        /// The index found.
        item: u32,
        /// Objects in the scene.
        objects: usize,
    },
    /// The draw list does not have one entry for each object.
    #[error("the draw list has {found} entries, but the scene has {objects} objects")]
    DrawListLength {
        /// Entries in the list.
        found: usize,
        /// Objects in the scene.
        objects: usize,
    },
    /// An object owns a pixel of the method's frame although the draw list denies that it was drawn.
    #[error(
        "object {item} owns a pixel of the method's frame but is not in its draw list: the list is not what was drawn"
    )]
    NotInDrawList {
        /// The object.
        item: u32,
    },
    /// The images could not be compared for likeness.
    #[error("SSIM failed: {0}")]
    Ssim(String),
}

/// The frame of `none` and the visible set in it: what every method is held to.
#[derive(Clone, Debug)]
pub struct Truth {
    images: FrameImages,
    /// One bit per object: owns at least one pixel.
    visible: Vec<u64>,
    visible_count: usize,
    object_count: usize,
}

impl Truth {
    /// Takes the frame that `none` drew of a scene with `object_count` objects.
    pub fn new(images: FrameImages, object_count: usize) -> Result<Self, MetricError> {
        check_images(&images, object_count, "truth")?;
        let mut visible = vec![0u64; object_count.div_ceil(64)];
        for &item in images.visible_items().iter().filter(|&&item| item != NO_ITEM) {
            visible[item as usize / 64] |= 1 << (item % 64);
        }
        let visible_count = visible.iter().map(|word| word.count_ones() as usize).sum();
        Ok(Self { images, visible, visible_count, object_count })
    }

    /// The frame itself.
    pub fn images(&self) -> &FrameImages {
        &self.images
    }

    /// Objects in the scene.
    pub fn object_count(&self) -> usize {
        self.object_count
    }

    /// Size of the visible set.
    pub fn visible_count(&self) -> usize {
        self.visible_count
    }

    /// Does the object own at least one pixel? False for an index beyond the scene.
    pub fn is_visible(&self, object: usize) -> bool {
        let word = self.visible.get(object / 64).copied().unwrap_or(0);
        word >> (object % 64) & 1 == 1
    }

    /// The visible set in object order: what `ref` draws.
    pub fn visible_objects(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.object_count).filter(|&object| self.is_visible(object))
    }
}

/// One frame of a method against the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameError {
    /// Objects in the scene (N).
    pub objects: usize,
    /// Objects in the visible set.
    pub ref_visible: usize,
    /// Objects drawn.
    pub drawn: usize,
    /// Objects not drawn (C).
    pub culled: usize,
    /// Objects in the visible set that were not drawn. Decided by the draw list alone: an object all of whose pixels
    /// are ties still counts.
    pub false_negatives: usize,
    /// Objects drawn that are not in the visible set.
    pub false_positives: usize,
    /// Pixels whose depth differs in any bit.
    pub differing_pixels: usize,
    /// Pixels of equal depth that show another object.
    pub tied_pixels: usize,
    /// Pixels of equal depth and object but another colour. No method may have any: it means that a pass computes
    /// something else, not that it culls something else.
    pub wrong_colour_pixels: usize,
    /// Peak signal-to-noise ratio over 8-bit RGB once ties carry the truth's colours; `None`: identical.
    pub psnr_db: Option<f64>,
    /// Structural similarity after the same replacement, the least of the three channels: mean over blocks of 8 x 8
    /// pixels (`image-compare`). Blocks at the right and bottom border are as small as what is left there, and so is
    /// the only block of a smaller image. Identical: exactly 1.
    pub ssim: f64,
    /// C/N; 0 for a scene without objects.
    pub culled_over_total: f64,
    /// C/R: objects culled over those that REF culls, (N - drawn) / (N - visible). 1 if REF culls none. False
    /// negatives count as culled, so only without them is it at most 1.
    pub culled_over_ref: f64,
    /// False negatives in percent of the visible set; 0 if nothing is visible.
    pub object_error_percent: f64,
}

impl FrameError {
    /// Returns the frame with its missing objects and differing pixels excused, as if it showed the truth there.
    pub fn without_faults(self) -> Self {
        FrameError {
            false_negatives: 0,
            differing_pixels: 0,
            object_error_percent: 0.0,
            psnr_db: None,
            ssim: 1.0,
            ..self
        }
    }
}

/// Compares what a method drew with the truth. `drawn` has one entry per object: was it in any of the frame's lists?
pub fn compare(truth: &Truth, method: &FrameImages, drawn: &[bool]) -> Result<FrameError, MetricError> {
    check_images(method, truth.object_count, "method")?;
    check_same_scene(truth, method, drawn)?;
    let objects = ObjectCounts::of(truth, drawn);
    let pixels = picture::compare_pixels(&truth.images, method);
    let likeness = picture::likeness(&truth.images, method)?;
    Ok(FrameError {
        objects: truth.object_count,
        ref_visible: truth.visible_count,
        drawn: objects.drawn,
        culled: truth.object_count - objects.drawn,
        false_negatives: objects.false_negatives,
        false_positives: objects.false_positives,
        differing_pixels: pixels.differing,
        tied_pixels: pixels.tied,
        wrong_colour_pixels: pixels.wrong_colour,
        psnr_db: likeness.psnr_db,
        ssim: likeness.ssim,
        culled_over_total: share_or(truth.object_count - objects.drawn, truth.object_count, 0.0),
        culled_over_ref: share_or(truth.object_count - objects.drawn, truth.object_count - truth.visible_count, 1.0),
        object_error_percent: 100.0 * share_or(objects.false_negatives, truth.visible_count, 0.0),
    })
}

/// PSNR in dB between the pictures that two methods made of one frame, over 8-bit RGB, once ties carry the colours of the
/// first; `None`: identical.
pub fn psnr_between(one: &FrameImages, other: &FrameImages) -> Result<Option<f64>, MetricError> {
    let size = |images: &FrameImages| (images.width, images.height);
    if size(one) != size(other) {
        return Err(MetricError::Sizes { method: size(other), truth: size(one) });
    }
    Ok(picture::psnr_between(one, other))
}

/// `part / whole`, or `empty` where the whole is nothing.
fn share_or(part: usize, whole: usize, empty: f64) -> f64 {
    if whole == 0 {
        empty
    } else {
        part as f64 / whole as f64
    }
}

struct ObjectCounts {
    drawn: usize,
    false_negatives: usize,
    false_positives: usize,
}

impl ObjectCounts {
    fn of(truth: &Truth, drawn: &[bool]) -> Self {
        let mut counts = Self { drawn: 0, false_negatives: 0, false_positives: 0 };
        for (object, &drawn) in drawn.iter().enumerate() {
            let visible = truth.is_visible(object);
            counts.drawn += usize::from(drawn);
            counts.false_negatives += usize::from(visible && !drawn);
            counts.false_positives += usize::from(drawn && !visible);
        }
        counts
    }
}

fn check_images(images: &FrameImages, objects: usize, frame: &'static str) -> Result<(), MetricError> {
    let (width, height) = (images.width, images.height);
    let pixels = width as usize * height as usize;
    let lengths = [("colour", images.colour.len()), ("depth", images.depth.len()), ("item", images.items.len())];
    for (image, found) in lengths {
        if found != pixels || pixels == 0 {
            return Err(MetricError::Size { frame, image, found, width, height });
        }
    }
    if let Some(pixel) = images.depth.iter().position(|depth| depth.is_nan()) {
        let (x, y) = (pixel % width as usize, pixel / width as usize);
        let (x, y) = (x as u32, y as u32);
        return Err(MetricError::NanDepth { frame, x, y });
    }
    let unknown = |&&item: &&u32| item != NO_ITEM && item as usize >= objects;
    match images.items.iter().chain(&images.seen_through).find(unknown) {
        Some(&item) => Err(MetricError::UnknownItem { frame, item, objects }),
        None => Ok(()),
    }
}

fn check_same_scene(truth: &Truth, method: &FrameImages, drawn: &[bool]) -> Result<(), MetricError> {
    let size = |images: &FrameImages| (images.width, images.height);
    if size(method) != size(&truth.images) {
        return Err(MetricError::Sizes { method: size(method), truth: size(&truth.images) });
    }
    if drawn.len() != truth.object_count {
        return Err(MetricError::DrawListLength { found: drawn.len(), objects: truth.object_count });
    }
    let undrawn = |&&item: &&u32| item != NO_ITEM && !drawn[item as usize];
    match method.items.iter().find(undrawn) {
        Some(&item) => Err(MetricError::NotInDrawList { item }),
        None => Ok(()),
    }
}
