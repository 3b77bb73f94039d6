//! How sure a ratio of times is.

use crate::stats::{median, percentile};
use crate::stress::Random;
use serde::Serialize;

/// Resamples drawn. 2.5 % of them are 50, so that the ends stand on more than single draws.
const RESAMPLES: usize = 2000;

/// A ratio of medians with its 95 % bootstrap interval (Efron & Tibshirani 1993, percentile method). None where a time is
/// missing or 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The ratio.
    pub ratio: Option<f64>,
    /// 2.5 % of the resamples are below it.
    pub low: Option<f64>,
    /// 2.5 % of the resamples are above it.
    pub high: Option<f64>,
}

/// The median of `b` over that of `a`, frames in milliseconds. Runs of the same number of frames are resampled frame by frame,
/// in pairs: a frame that is slow in both, because of what it shows, is then no noise. Others are resampled apart. The seed is fixed:
/// the same files give the same interval.
///
/// What differs from run to run but not from frame to frame (another machine load throughout) is not in the interval.
pub fn ratio_interval(a: &[f64], b: &[f64]) -> Interval {
    let ratio_of = |a: &[f64], b: &[f64]| match (median(a), median(b)) {
        (Some(a), Some(b)) if a > 0.0 => Some(b / a),
        _ => None,
    };
    let mut random = Random::new(0x5167_7417);
    let mut drawn = Vec::with_capacity(RESAMPLES);
    if a.is_empty() || b.is_empty() {
        return Interval { ratio: None, low: None, high: None };
    }
    for _ in 0..RESAMPLES {
        let at: Vec<usize> = a.iter().map(|_| random.below(a.len())).collect();
        let of_a: Vec<f64> = at.iter().map(|at| a[*at]).collect();
        let of_b: Vec<f64> = if a.len() == b.len() {
            at.iter().map(|at| b[*at]).collect()
        } else {
            b.iter().map(|_| b[random.below(b.len())]).collect()
        };
        drawn.extend(ratio_of(&of_a, &of_b));
    }
    Interval { ratio: ratio_of(a, b), low: percentile(&drawn, 2.5), high: percentile(&drawn, 97.5) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noisy(seed: u64, count: usize, middle: f64) -> Vec<f64> {
        let mut random = Random::new(seed);
        (0..count).map(|_| middle * random.range(0.8, 1.2)).collect()
    }

    #[test]
    fn the_interval_holds_the_true_ratio_and_not_a_wrong_one() {
        let twice = ratio_interval(&noisy(1, 60, 10.0), &noisy(2, 60, 20.0));
        let (low, high) = (twice.low.unwrap(), twice.high.unwrap());
        assert!(low < 2.0 && 2.0 < high && low > 1.5 && high < 2.6, "{twice:?}");
        let same = ratio_interval(&noisy(3, 60, 10.0), &noisy(4, 60, 10.0));
        assert!(same.low.unwrap() < 1.0 && same.high.unwrap() > 1.0, "{same:?}");
    }

    #[test]
    fn more_frames_make_it_narrower() {
        let width = |count| {
            let interval = ratio_interval(&noisy(5, count, 10.0), &noisy(6, count, 12.0));
            interval.high.unwrap() - interval.low.unwrap()
        };
        assert!(width(400) < 0.5 * width(16), "{} and {}", width(400), width(16));
    }

    #[test]
    fn frames_are_paired() {
        // Frames differ tenfold from each other, but B is 1.1 A in each.
        let a: Vec<f64> = (0..40).map(|frame| 1.0 + f64::from(frame)).collect();
        let b: Vec<f64> = a.iter().map(|ms| 1.1 * ms).collect();
        let paired = ratio_interval(&a, &b);
        assert!(paired.high.unwrap() - paired.low.unwrap() < 1e-9, "{paired:?}");
        let apart = ratio_interval(&a, &b[..39]);
        assert!(apart.high.unwrap() - apart.low.unwrap() > 0.1, "{apart:?}");
    }

    #[test]
    fn what_is_missing_has_no_interval_and_the_same_files_give_the_same() {
        let none = Interval { ratio: None, low: None, high: None };
        assert_eq!(ratio_interval(&[], &[1.0]), none);
        assert_eq!(ratio_interval(&[0.0, 0.0], &[1.0, 1.0]), none);
        assert_eq!(
            ratio_interval(&[1.0, 2.0, 4.0], &[3.0, 1.0, 2.0]),
            ratio_interval(&[1.0, 2.0, 4.0], &[3.0, 1.0, 2.0])
        );
    }
}
