//! How far a predicted depth buffer is from the real one: a depth warped from the last frame against what is then drawn.

/// Errors of a predicted depth buffer, by texel. Nearer than real is dangerous: it may hide what shows. Farther is
/// conservative: it only hides less (Kim 2015, thesis, V.1, measures both apart).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthErrors {
    /// PSNR of all differences in dB; none if there are none.
    pub psnr_db: Option<f64>,
    /// The same over differences of depths that are too near.
    pub nearer_psnr_db: Option<f64>,
    /// The same over differences of depths that are too far, holes included.
    pub farther_psnr_db: Option<f64>,
    /// Texels that are too near by more than [`NOTICED`], in percent of all.
    pub nearer_percent: f64,
    /// Texels where something is, but nothing was predicted, in percent of all.
    pub hole_percent: f64,
}

/// Differences of depth below one percent are within what a source half a texel off gives on a slope.
pub const NOTICED: f32 = 0.01;

impl DepthErrors {
    /// Compares two buffers of reversed depth. `shown` maps a depth to 0..=1, the scale on which errors are taken: stored
    /// depth itself would hide all errors but those just before the eye.
    pub fn of(predicted: &[f32], truth: &[f32], shown: impl Fn(f32) -> f64) -> Self {
        let (mut nearer, mut farther, mut too_near, mut holes) = (0.0, 0.0, 0usize, 0usize);
        for (predicted, truth) in predicted.iter().zip(truth) {
            let squared = (shown(*predicted) - shown(*truth)).powi(2);
            if predicted > truth {
                nearer += squared;
            } else {
                farther += squared;
            }
            too_near += usize::from(*predicted > *truth * (1.0 + NOTICED));
            holes += usize::from(*predicted == 0.0 && *truth > 0.0);
        }
        let count = truth.len().max(1) as f64;
        let psnr = |sum: f64| (sum > 0.0).then(|| -10.0 * (sum / count).log10());
        let percent = |texels: usize| 100.0 * texels as f64 / count;
        DepthErrors {
            psnr_db: psnr(nearer + farther),
            nearer_psnr_db: psnr(nearer),
            farther_psnr_db: psnr(farther),
            nearer_percent: percent(too_near),
            hole_percent: percent(holes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_error_is_counted_apart() {
        let truth = [0.5f32, 0.5, 0.25, 0.0];
        let of = |predicted: &[f32]| DepthErrors::of(predicted, &truth, f64::from);
        let same = of(&truth);
        assert_eq!((same.psnr_db, same.nearer_percent, same.hole_percent), (None, 0.0, 0.0));
        let near = of(&[0.5, 0.7, 0.25, 0.0]);
        assert_eq!((near.nearer_percent, near.hole_percent, near.farther_psnr_db), (25.0, 0.0, None));
        assert!((near.nearer_psnr_db.unwrap() - 20.0).abs() < 1e-5, "0.2 in one of four texels is 0.01 on average");
        assert_eq!(near.psnr_db, near.nearer_psnr_db);
        let hole = of(&[0.5, 0.0, 0.25, 0.0]);
        assert_eq!((hole.nearer_percent, hole.hole_percent, hole.nearer_psnr_db), (0.0, 25.0, None));
        let ghost = of(&[0.5, 0.5, 0.25, 0.1]);
        assert_eq!((ghost.nearer_percent, ghost.hole_percent), (25.0, 0.0));
    }
}
