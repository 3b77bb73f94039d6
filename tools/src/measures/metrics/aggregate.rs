//! All frames of a method in one row of the results.

use super::{share_or, FrameError};
use crate::measures::stats;

/// The errors of a method over all its frames, under the names they have in `results.json`.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodErrors {
    /// Frames compared, > 0.
    pub frames: usize,
    /// Sum over frames.
    pub false_negatives: usize,
    /// Frames with at least one false negative.
    pub false_negative_frames: usize,
    /// Sum over frames.
    pub false_positives: usize,
    /// False negatives in percent of the visible objects, both summed over frames.
    pub object_error_percent: f64,
    /// Mean over frames.
    pub differing_pixels_mean: f64,
    /// Mean over frames.
    pub tied_pixels_mean: f64,
    /// Sum over frames; anything but 0 is a defect of the harness or a shader.
    pub wrong_colour_pixels: usize,
    /// Mean of the decibels over the frames that are *not* identical (an identical frame's would be infinite); `None`:
    /// all frames are identical. Read it beside `differing_pixels_mean`, which counts all frames.
    pub psnr_mean_db: Option<f64>,
    /// The least over all frames; `None`: all frames are identical.
    pub psnr_worst_db: Option<f64>,
    /// Mean over frames.
    pub ssim_mean: f64,
    /// Mean over frames.
    pub drawn_mean: f64,
    /// Mean over frames of the visible set's size.
    pub ref_visible_mean: f64,
    /// C/N: objects culled over all objects, both summed over frames.
    pub culled_over_total: f64,
    /// C/R: objects culled over those that REF culls, both summed over frames, so that a frame in which REF culls a
    /// handful weighs a handful; 1 if REF culls none in any frame.
    pub culled_over_ref: f64,
}

impl MethodErrors {
    /// Sums up the frames; `None` if there are none.
    pub fn from_frames(frames: &[FrameError]) -> Option<Self> {
        let sum = |of: fn(&FrameError) -> usize| frames.iter().map(of).sum::<usize>();
        let mean = |of: fn(&FrameError) -> f64| stats::mean(&frames.iter().map(of).collect::<Vec<_>>());
        let psnr: Vec<f64> = frames.iter().filter_map(|f| f.psnr_db).collect();
        let culled = sum(|f| f.culled);
        let false_negatives = sum(|f| f.false_negatives);
        Some(Self {
            frames: frames.len(),
            false_negatives,
            false_negative_frames: sum(|f| usize::from(f.false_negatives > 0)),
            false_positives: sum(|f| f.false_positives),
            object_error_percent: 100.0 * share_or(false_negatives, sum(|f| f.ref_visible), 0.0),
            differing_pixels_mean: mean(|f| f.differing_pixels as f64)?,
            tied_pixels_mean: mean(|f| f.tied_pixels as f64)?,
            wrong_colour_pixels: sum(|f| f.wrong_colour_pixels),
            psnr_mean_db: stats::mean(&psnr),
            psnr_worst_db: psnr.iter().copied().reduce(f64::min),
            ssim_mean: mean(|f| f.ssim)?,
            drawn_mean: mean(|f| f.drawn as f64)?,
            ref_visible_mean: mean(|f| f.ref_visible as f64)?,
            culled_over_total: share_or(culled, sum(|f| f.objects), 0.0),
            culled_over_ref: share_or(culled, sum(|f| f.objects - f.ref_visible), 1.0),
        })
    }
}
