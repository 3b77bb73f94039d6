//! The word of exact methods, with the condition it is given under.
//!
//! A face seen on edge may still own a pixel, as vertices are snapped to a grid. Its plane then stands upright on the screen, and the device
//! takes the pixel's depth from it part of a grid step outside the face: that depth can be nearer than all else in the
//! picture, and no bound on a box holds it (`include/footprint.glsl`). So depths are promised of primitives of
//! [`LEAST_HEIGHT_PX`](super::footprints::LEAST_HEIGHT_PX) and higher, and what is wrong only at pixels that lower ones have made is counted on its own.

use super::footprints::covered;
use super::lab::{error_of, Lab, Take};
use crate::measures::metrics::{FrameError, FrameImages, Truth, NO_ITEM};
use anyhow::Result;
use scenes::Shot;
use std::collections::HashSet;

/// What a frame did against the truth, and how many of the truth's pixels it has not because they are outside the raster
/// conditions. If these explain all that is wrong, the error counts neither them nor the objects that were seen there alone;
/// if they do not, it counts everything, and they are none.
///
/// # Errors
/// The device's.
pub fn judged(lab: &mut Lab, shot: &Shot, truth: &Truth, take: &Take) -> Result<(FrameError, u64)> {
    let error = error_of(truth, take)?;
    if error.false_negatives + error.differing_pixels == 0 || error.wrong_colour_pixels > 0 {
        return Ok((error, 0));
    }
    let wrong = wrong_pixels(truth.images(), take);
    let thin: HashSet<usize> = thin_pixels(lab, shot)?.into_iter().collect();
    if wrong.iter().all(|pixel| thin.contains(pixel)) {
        return Ok((FrameError { false_negatives: 0, differing_pixels: 0, ..error }, wrong.len() as u64));
    }
    Ok((error, 0))
}

/// Pixels of another depth than in the truth, and all pixels of objects that were not drawn.
fn wrong_pixels(truth: &FrameImages, take: &Take) -> Vec<usize> {
    let lost = |item: u32| item != NO_ITEM && !take.drawn.objects[item as usize];
    let differs = |pixel: usize| truth.depth[pixel].to_bits() != take.images.depth[pixel].to_bits();
    (0..truth.depth.len()).filter(|&pixel| differs(pixel) || lost(truth.items[pixel])).collect()
}

fn thin_pixels(lab: &mut Lab, shot: &Shot) -> Result<Vec<usize>> {
    let seen = covered(lab, shot, |_, _| ())?;
    let width = lab.size[0] as usize;
    let thin = seen.too_near.iter().filter(|near| near.thin);
    Ok(thin.map(|near| near.at[1] as usize * width + near.at[0] as usize).collect())
}
