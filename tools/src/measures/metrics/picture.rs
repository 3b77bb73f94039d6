//! The measures that look at pixels: classes of difference, PSNR and SSIM.

use super::{FrameImages, MetricError};
use image::{Rgb, RgbImage};

/// What a pixel of a method's frame is, next to the same pixel of the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PixelClass {
    /// Same depth, object and colour.
    Same,
    /// Same depth bits, another object.
    Tied,
    /// Same depth bits and object, another colour.
    WrongColour,
    /// The depth differs.
    Differs,
}

/// Classes one pixel. Both frames have the same size.
pub(crate) fn class_of(truth: &FrameImages, method: &FrameImages, pixel: usize) -> PixelClass {
    if truth.depth[pixel].to_bits() != method.depth[pixel].to_bits() {
        PixelClass::Differs
    } else if truth.items[pixel] != method.items[pixel] {
        PixelClass::Tied
    } else if truth.colour[pixel] != method.colour[pixel] {
        PixelClass::WrongColour
    } else {
        PixelClass::Same
    }
}

/// How many pixels of each class a frame has.
pub(super) struct PixelCounts {
    pub differing: usize,
    pub tied: usize,
    pub wrong_colour: usize,
}

pub(super) fn compare_pixels(truth: &FrameImages, method: &FrameImages) -> PixelCounts {
    let mut counts = PixelCounts { differing: 0, tied: 0, wrong_colour: 0 };
    for pixel in 0..truth.depth.len() {
        match class_of(truth, method, pixel) {
            PixelClass::Same => {}
            PixelClass::Tied => counts.tied += 1,
            PixelClass::WrongColour => counts.wrong_colour += 1,
            PixelClass::Differs => counts.differing += 1,
        }
    }
    counts
}

/// How alike two pictures look, ties aside.
pub(super) struct Likeness {
    pub psnr_db: Option<f64>,
    pub ssim: f64,
}

pub(super) fn likeness(truth: &FrameImages, method: &FrameImages) -> Result<Likeness, MetricError> {
    let (wanted, found) = pictures(truth, method);
    let psnr_db = psnr_db(&wanted, &found);
    // Identical pictures need no windows: exactly 1, whatever the rounding, and at no cost for exact methods.
    let ssim = match psnr_db {
        None => 1.0,
        Some(_) => ssim(&wanted, &found)?,
    };
    Ok(Likeness { psnr_db, ssim })
}

/// PSNR between the pictures of two frames of one size over 8-bit RGB, ties aside; `None`: identical.
pub(super) fn psnr_between(one: &FrameImages, other: &FrameImages) -> Option<f64> {
    let (wanted, found) = pictures(one, other);
    psnr_db(&wanted, &found)
}

/// Ties are replaced by the truth's colours first, so that they cost nothing.
fn pictures(truth: &FrameImages, method: &FrameImages) -> (RgbImage, RgbImage) {
    let wanted = rgb_image(truth, |pixel| truth.colour[pixel]);
    let found = rgb_image(truth, |pixel| match class_of(truth, method, pixel) {
        PixelClass::Tied => truth.colour[pixel],
        _ => method.colour[pixel],
    });
    (wanted, found)
}

/// The size is that of `like`; alpha is dropped.
fn rgb_image(like: &FrameImages, colour_at: impl Fn(usize) -> [u8; 4]) -> RgbImage {
    RgbImage::from_fn(like.width, like.height, |x, y| {
        let [red, green, blue, _] = colour_at(y as usize * like.width as usize + x as usize);
        Rgb([red, green, blue])
    })
}

/// 10 log10(255^2 / MSE) over all three channels, `None` at MSE 0. The squared error is summed in integers: no rounding,
/// so a single channel that is one step off in the largest image is still noticed.
fn psnr_db(wanted: &RgbImage, found: &RgbImage) -> Option<f64> {
    let (wanted, found) = (wanted.as_raw(), found.as_raw());
    let squared_error: u64 = wanted.iter().zip(found).map(|(&a, &b)| u64::from(a.abs_diff(b)).pow(2)).sum();
    if squared_error == 0 {
        return None;
    }
    let mean = squared_error as f64 / wanted.len() as f64;
    Some(10.0 * (255.0f64.powi(2) / mean).log10())
}

fn ssim(wanted: &RgbImage, found: &RgbImage) -> Result<f64, MetricError> {
    let algorithm = image_compare::Algorithm::MSSIMSimple;
    let similarity = image_compare::rgb_similarity_structure(&algorithm, wanted, found)
        .map_err(|error| MetricError::Ssim(error.to_string()))?;
    // Rounding in the windows' weighted mean must not make different pictures look better than identical ones.
    Ok(similarity.score.min(1.0))
}
