//! How far a predicted depth buffer is from the real one: a depth warped from the last frame against what is then drawn.

use super::MetricError;
use image::{GrayImage, Luma};

/// Errors of a predicted depth buffer, by texel. Nearer than real is dangerous: it may hide what shows. Farther is
/// conservative: it only hides less (Kim 2015, thesis, V.1 and figure 8, measures both apart, as error and overestimation).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthErrors {
    /// PSNR of all differences in dB; none if there are none.
    pub psnr_db: Option<f64>,
    /// Structural similarity of the two as pictures of 256 greys: mean over blocks of 8 x 8 texels (`image-compare`). Equal
    /// depths: exactly 1.
    pub ssim: f64,
    /// The same over differences of depths that are too near.
    pub nearer_psnr_db: Option<f64>,
    /// The same over differences of depths that are too far, holes included.
    pub farther_psnr_db: Option<f64>,
    /// Texels that are too near by more than [`NOTICED`], in percent of all.
    pub nearer_percent: f64,
    /// Texels that are too far by more than [`NOTICED`], holes included, in percent of all.
    pub farther_percent: f64,
    /// Texels where something is, but nothing was predicted, in percent of all.
    pub hole_percent: f64,
}

/// Differences of depth below one percent are within what a source half a texel off gives on a slope.
pub const NOTICED: f32 = 0.01;

impl DepthErrors {
    /// Compares two buffers of reversed depth, row by row in pictures of `width` texels. `shown` maps a depth to 0..=1, the
    /// scale on which PSNR and SSIM are taken: stored depth itself would hide all errors but those just before the eye.
    ///
    /// # Errors
    /// Buffers that are not two pictures of this width and of one height.
    pub fn of(
        predicted: &[f32],
        truth: &[f32],
        width: u32,
        shown: impl Fn(f32) -> f64 + Copy,
    ) -> Result<Self, MetricError> {
        let (mut nearer, mut farther) = (0.0, 0.0);
        for (predicted, truth) in predicted.iter().zip(truth) {
            let squared = (shown(*predicted) - shown(*truth)).powi(2);
            *(if predicted > truth { &mut nearer } else { &mut farther }) += squared;
        }
        let count = truth.len().max(1) as f64;
        let psnr = |sum: f64| (sum > 0.0).then(|| -10.0 * (sum / count).log10());
        let percent = |is: fn(f32, f32) -> bool| {
            let texels = predicted.iter().zip(truth).filter(|(predicted, truth)| is(**predicted, **truth));
            100.0 * texels.count() as f64 / count
        };
        Ok(DepthErrors {
            psnr_db: psnr(nearer + farther),
            ssim: if predicted == truth { 1.0 } else { ssim(predicted, truth, width, shown)? },
            nearer_psnr_db: psnr(nearer),
            farther_psnr_db: psnr(farther),
            nearer_percent: percent(|predicted, truth| predicted > truth * (1.0 + NOTICED)),
            farther_percent: percent(|predicted, truth| predicted * (1.0 + NOTICED) < truth),
            hole_percent: percent(|predicted, truth| predicted == 0.0 && truth > 0.0),
        })
    }
}

fn ssim(predicted: &[f32], truth: &[f32], width: u32, shown: impl Fn(f32) -> f64 + Copy) -> Result<f64, MetricError> {
    let (predicted, truth) = (grey_image(predicted, width, shown), grey_image(truth, width, shown));
    let algorithm = image_compare::Algorithm::MSSIMSimple;
    let similarity = image_compare::gray_similarity_structure(&algorithm, &truth, &predicted)
        .map_err(|error| MetricError::Ssim(error.to_string()))?;
    // Rounding in the windows' weighted mean must not make different pictures look better than identical ones.
    Ok(similarity.score.min(1.0))
}

fn grey_image(depth: &[f32], width: u32, shown: impl Fn(f32) -> f64) -> GrayImage {
    let height = depth.len() as u32 / width.max(1);
    GrayImage::from_fn(width, height, |x, y| Luma([(255.0 * shown(depth[(y * width + x) as usize])).round() as u8]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_error_is_counted_apart() {
        let truth = [0.5f32, 0.5, 0.25, 0.0];
        let of = |predicted: &[f32]| DepthErrors::of(predicted, &truth, 2, f64::from).unwrap();
        let percents = |errors: DepthErrors| [errors.nearer_percent, errors.farther_percent, errors.hole_percent];
        let same = of(&truth);
        assert_eq!((same.psnr_db, same.ssim, percents(same)), (None, 1.0, [0.0; 3]));
        let near = of(&[0.5, 0.7, 0.25, 0.0]);
        assert_eq!((percents(near), near.farther_psnr_db), ([25.0, 0.0, 0.0], None));
        assert!((near.nearer_psnr_db.unwrap() - 20.0).abs() < 1e-5, "0.2 in one of four texels is 0.01 on average");
        assert_eq!(near.psnr_db, near.nearer_psnr_db);
        let far = of(&[0.5, 0.3, 0.25, 0.0]);
        assert_eq!((percents(far), far.nearer_psnr_db), ([0.0, 25.0, 0.0], None));
        assert!((far.farther_psnr_db.unwrap() - 20.0).abs() < 1e-5);
        let hole = of(&[0.5, 0.0, 0.25, 0.0]);
        assert_eq!((percents(hole), hole.nearer_psnr_db), ([0.0, 25.0, 25.0], None));
        let ghost = of(&[0.5, 0.5, 0.25, 0.1]);
        assert_eq!(percents(ghost), [25.0, 0.0, 0.0]);
        let unnoticed = of(&[0.5 * (1.0 + NOTICED / 2.0), 0.5 * (1.0 - NOTICED / 2.0), 0.25, 0.0]);
        assert_eq!(percents(unnoticed), [0.0; 3]);
    }

    #[test]
    fn errors_that_disagree_keep_to_their_own_figures() {
        let truth = [0.5f32, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.0];
        // One texel is too near by much and two by little, one is too far, and two are holes.
        let predicted = [0.75f32, 0.625, 0.625, 0.25, 0.0, 0.0, 0.5, 0.5, 0.5, 0.0];
        let found = DepthErrors::of(&predicted, &truth, 5, f64::from).unwrap();
        assert_eq!([found.nearer_percent, found.farther_percent, found.hole_percent], [30.0, 30.0, 20.0]);
        let db = |sum: f64| -10.0 * (sum / 10.0).log10();
        let expected = [0.09375 + 0.5625, 0.09375, 0.5625].map(db);
        let [all, nearer, farther] = [found.psnr_db, found.nearer_psnr_db, found.farther_psnr_db].map(Option::unwrap);
        for (found, expected) in [all, nearer, farther].into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
        // The scale decides how much an error weighs: on this one nothing is left of it.
        assert_eq!(DepthErrors::of(&predicted, &truth, 5, |_| 0.25).unwrap().psnr_db, None);
    }

    #[test]
    fn likeness_is_the_mean_of_blocks() {
        // Four blocks side by side, of which the second is spoilt: the others are alike.
        let (width, block) = (32, 8..16);
        let truth: Vec<f32> = (0..width * 8).map(|texel| 0.25 + (texel % 5) as f32 / 8.0).collect();
        let spoilt = |texel: usize| if block.contains(&(texel % width)) { 0.25 } else { truth[texel] };
        let predicted: Vec<f32> = (0..truth.len()).map(spoilt).collect();
        let of = |predicted: &[f32], truth: &[f32], width| DepthErrors::of(predicted, truth, width, f64::from).unwrap();
        let alone = |depth: &[f32]| depth.chunks(width).flat_map(|row| row[block.clone()].to_vec()).collect::<Vec<_>>();
        let one = of(&alone(&predicted), &alone(&truth), 8).ssim;
        assert!(one < 0.5, "{one}");
        let all = of(&predicted, &truth, width as u32).ssim;
        assert!((all - (3.0 + one) / 4.0).abs() < 1e-12, "{all}, one block {one}");
    }

    #[test]
    fn buffers_of_two_sizes_are_refused() {
        let error = DepthErrors::of(&[0.5; 8], &[0.4; 4], 4, f64::from).unwrap_err();
        assert!(matches!(error, MetricError::Ssim(_)), "{error}");
    }
}
