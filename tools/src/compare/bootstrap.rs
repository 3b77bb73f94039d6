//! How sure a ratio of two series of times is.

use crate::measures::stats;
use crate::stress::Random;
use serde::Serialize;

/// The interval's ends, in percent of the resamples: 95 % lie between them.
const ENDS: [f64; 2] = [2.5, 97.5];

/// Fewer frames show nothing at 95 %: all n of them lie on one side of the true median with a chance of 2 / 2^n, and not
/// even the interval from the least to the greatest holds it then. That is 6 % for 5 frames, and 3 % for 6.
pub const FEWEST_FRAMES: usize = 6;

/// How resamples are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Bootstrap {
    /// Resamples; at least 1. Of 2000, each end of the interval stands on 50.
    pub resamples: u32,
    /// The same seed draws the same resamples.
    pub seed: u64,
}

/// What the interval says of B.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// The whole interval is below 1.
    #[serde(rename = "faster")]
    Faster,
    /// The whole interval is above 1.
    #[serde(rename = "slower")]
    Slower,
    /// It holds 1, or there are fewer frames than [`FEWEST_FRAMES`]. That is no proof that there is none.
    #[serde(rename = "no difference shown")]
    NoDifferenceShown,
}

impl Verdict {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Faster => "faster",
            Verdict::Slower => "slower",
            Verdict::NoDifferenceShown => "no difference shown",
        }
    }
}

/// The ratio of two medians, with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ratio {
    /// Median of B over median of A.
    pub ratio: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end; infinite where more than 2.5 % of the resamples have a median of 0 for A.
    pub high: f64,
    /// What the interval says.
    pub verdict: Verdict,
}

/// Times of one run, and those that they are measured by, if any: of another method of the same run, frame by frame. What slows
/// the whole run is in both, and not in their ratio.
#[derive(Clone, Copy, Debug)]
pub struct Side<'a> {
    /// The times.
    pub times: &'a [f64],
    /// What they are measured by.
    pub by: Option<&'a [f64]>,
}

impl Side<'_> {
    /// The median, over the median of what it is measured by. `None` if there are no times, or those are 0.
    pub fn median(self) -> Option<f64> {
        let by = self.by.map_or(Some(1.0), stats::median).filter(|ms| *ms > 0.0)?;
        Some(stats::median(self.times)? / by)
    }

    /// The same of the frames chosen. What it is measured by is of the same frames, if it has as many.
    fn median_of(self, chosen: &[usize], random: &mut Random) -> f64 {
        let times = median_of(self.times, chosen);
        match self.by {
            None => times,
            Some(by) if by.len() == self.times.len() => quotient(times, median_of(by, chosen)),
            Some(by) => quotient(times, median_of(by, &drawn(by.len(), random))),
        }
    }
}

/// Indices of a resample.
fn drawn(count: usize, random: &mut Random) -> Vec<usize> {
    (0..count).map(|_| random.below(count)).collect()
}

/// Median of `b` over median of `a`, with a percentile bootstrap interval (Efron and Tibshirani 1993, chapter 13). `None` if
/// a series is empty or the median of `a` is 0.
///
/// With `pairs`, entry i of both is the same frame of the path, and resamples take frames, not times: a frame that is slow
/// in both for what it shows is then no noise. Otherwise, or where the lengths differ, each series is resampled apart.
///
/// The admitted limits: frames count as independent of each other, though neighbours on a path resemble one another; and
/// what holds for a whole run, such as a machine that was busy during B, is in the ratio, but not in the interval
/// ([`ratio_by`] takes it out).
pub fn ratio(a: &[f64], b: &[f64], pairs: bool, bootstrap: Bootstrap) -> Option<Ratio> {
    ratio_by(Side { times: a, by: None }, Side { times: b, by: None }, pairs, bootstrap)
}

/// The same of two sides that are each measured by something of their own run: a ratio of ratios.
pub fn ratio_by(a: Side<'_>, b: Side<'_>, pairs: bool, bootstrap: Bootstrap) -> Option<Ratio> {
    let ratio = b.median()? / a.median().filter(|median| *median > 0.0)?;
    let pairs = pairs && a.times.len() == b.times.len();
    let mut random = Random::new(bootstrap.seed);
    let resamples = (0..bootstrap.resamples.max(1)).map(|_| {
        let of_a = drawn(a.times.len(), &mut random);
        let of_b = if pairs { of_a.clone() } else { drawn(b.times.len(), &mut random) };
        quotient(b.median_of(&of_b, &mut random), a.median_of(&of_a, &mut random))
    });
    let resamples: Vec<f64> = resamples.collect();
    let [low, high] = ENDS.map(|percent| stats::percentile(&resamples, percent));
    let (low, high) = (low?, high?);
    let verdict = match a.times.len().min(b.times.len()) {
        frames if frames < FEWEST_FRAMES => Verdict::NoDifferenceShown,
        _ if high < 1.0 => Verdict::Faster,
        _ if low > 1.0 => Verdict::Slower,
        _ => Verdict::NoDifferenceShown,
    };
    Some(Ratio { ratio, low, high, verdict })
}

/// A stage may take less than a tick of the clock. Two of those are no difference.
fn quotient(b: f64, a: f64) -> f64 {
    if a == b {
        1.0
    } else {
        b / a
    }
}

/// As [`stats::median`], of the entries chosen (at least one), without sorting them: this is all the time of a comparison.
fn median_of(values: &[f64], chosen: &[usize]) -> f64 {
    let mut values: Vec<f64> = chosen.iter().map(|&at| values[at]).collect();
    let (odd, middle) = (values.len() % 2 == 1, values.len() / 2);
    let (below, &mut above, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let below = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if odd {
        above
    } else {
        below + (above - below) * 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PLAIN: Bootstrap = Bootstrap { resamples: 2000, seed: 1 };

    /// Frame times around `middle` ms, a fifth up or down.
    fn noisy(seed: u64, frames: usize, middle: f64) -> Vec<f64> {
        let mut random = Random::new(seed);
        (0..frames).map(|_| middle * random.range(0.8, 1.2)).collect()
    }

    fn of(a: &[f64], b: &[f64], pairs: bool) -> Ratio {
        ratio(a, b, pairs, PLAIN).unwrap()
    }

    #[test]
    fn the_interval_holds_the_true_ratio_and_no_wrong_one() {
        for pairs in [true, false] {
            let same = of(&noisy(1, 60, 10.0), &noisy(2, 60, 10.0), pairs);
            assert!(same.low < 1.0 && 1.0 < same.high && same.verdict == Verdict::NoDifferenceShown, "{same:?}");
            let twice = of(&noisy(3, 60, 10.0), &noisy(4, 60, 20.0), pairs);
            assert!(twice.low < 2.0 && 2.0 < twice.high && twice.low > 1.0, "{twice:?}");
            assert_eq!(twice.verdict, Verdict::Slower);
            assert_eq!(of(&noisy(4, 60, 20.0), &noisy(3, 60, 10.0), pairs).verdict, Verdict::Faster);
        }
    }

    /// What "95 %" says: it is the true ratio that an interval misses 5 % of the time, not more than twice that.
    #[test]
    fn nine_in_ten_intervals_hold_the_true_ratio() {
        let few = Bootstrap { resamples: 400, seed: 1 };
        let holds = |pairs: bool| {
            let runs = 0..200;
            let held = runs.filter(|run| {
                let (a, b) = (noisy(2 * run, 30, 10.0), noisy(2 * run + 1, 30, 15.0));
                let found = ratio(&a, &b, pairs, few).unwrap();
                found.low <= 1.5 && 1.5 <= found.high
            });
            held.count()
        };
        for pairs in [true, false] {
            let held = holds(pairs);
            assert!((180..200).contains(&held), "{held} of 200, in pairs: {pairs}");
        }
    }

    #[test]
    fn a_frame_that_is_slow_in_both_is_no_noise_in_pairs_only() {
        let a: Vec<f64> = (1..=40).map(f64::from).collect();
        let b: Vec<f64> = a.iter().map(|ms| 1.1 * ms).collect();
        let (pairs, apart) = (of(&a, &b, true), of(&a, &b, false));
        assert!(pairs.high - pairs.low < 1e-9 && pairs.verdict == Verdict::Slower, "{pairs:?}");
        assert!(apart.low < 1.0 && apart.verdict == Verdict::NoDifferenceShown, "{apart:?}");
        // Of other lengths there are no pairs, whatever is asked for.
        assert_eq!(of(&a, &b[..39], true), of(&a, &b[..39], false));
    }

    #[test]
    fn what_slows_a_whole_run_is_not_in_a_ratio_of_ratios() {
        // B ran under another load, which grew while it ran: the method and what it is measured by took as much longer.
        let load: Vec<f64> = (0..40).map(|frame| 1.5 + 0.02 * f64::from(frame)).collect();
        let loaded = |times: Vec<f64>| times.iter().zip(&load).map(|(ms, load)| ms * load).collect::<Vec<_>>();
        let (a, ref_a) = (noisy(1, 40, 20.0), noisy(2, 40, 10.0));
        let (b, ref_b) = (loaded(noisy(3, 40, 20.0)), loaded(noisy(4, 40, 10.0)));
        let by = |times: &[f64]| {
            let (a, b) = (Side { times: &a, by: Some(&ref_a) }, Side { times, by: Some(&ref_b) });
            ratio_by(a, b, true, PLAIN).unwrap()
        };
        assert_eq!(of(&a, &b, true).verdict, Verdict::Slower, "that is the load");
        let same = by(&b);
        assert!(same.low < 1.0 && 1.0 < same.high && same.verdict == Verdict::NoDifferenceShown, "{same:?}");
        let twice = by(&b.iter().map(|ms| 2.0 * ms).collect::<Vec<_>>());
        assert!(twice.low > 1.5 && twice.high < 2.5 && twice.verdict == Verdict::Slower, "{twice:?}");
        // Of fewer frames, as a stage has them that does not always run, each is drawn apart.
        let few =
            ratio_by(Side { times: &a[..9], by: Some(&ref_a) }, Side { times: &b[..9], by: Some(&ref_b) }, true, PLAIN);
        assert!(few.unwrap().high > few.unwrap().low);
        let nothing = Side { times: &a, by: Some(&[0.0]) };
        assert_eq!(ratio_by(nothing, nothing, true, PLAIN), None);
    }

    #[test]
    fn a_seed_draws_the_same_resamples_and_another_seed_others() {
        let (a, b) = (noisy(5, 20, 10.0), noisy(6, 20, 11.0));
        let by = |seed| ratio(&a, &b, true, Bootstrap { seed, ..PLAIN }).unwrap();
        assert_eq!(by(7), by(7));
        assert_ne!((by(7).low, by(7).high), (by(8).low, by(8).high));
        assert_eq!(by(7).ratio, by(8).ratio);
    }

    #[test]
    fn too_few_frames_show_nothing() {
        let verdict = |frames| of(&vec![1.0; frames], &vec![2.0; frames], true).verdict;
        assert_eq!(verdict(FEWEST_FRAMES), Verdict::Slower);
        assert_eq!(verdict(FEWEST_FRAMES - 1), Verdict::NoDifferenceShown);
        // The interval from least to greatest misses the median with a chance of 2 / 2^n.
        let missed = |frames: usize| 2.0 * 0.5f64.powi(frames as i32);
        assert!(missed(FEWEST_FRAMES) <= 0.05 && missed(FEWEST_FRAMES - 1) > 0.05);
    }

    #[test]
    fn nothing_and_a_time_of_zero_have_no_ratio() {
        assert_eq!(ratio(&[], &[1.0], true, PLAIN), None);
        assert_eq!(ratio(&[1.0], &[], true, PLAIN), None);
        assert_eq!(ratio(&[0.0, 0.0], &[1.0, 1.0], true, PLAIN), None);
        // Half of A below a tick of the clock: an upper end, if an infinite one, and never a NaN.
        let (a, b) = ([0.0, 0.0, 0.0, 2.0, 2.0, 2.0], [0.0, 0.0, 0.0, 2.0, 2.0, 3.0]);
        let rare = of(&a, &b, false);
        assert!(
            rare.low >= 0.0 && rare.high == f64::INFINITY && rare.verdict == Verdict::NoDifferenceShown,
            "{rare:?}"
        );
    }

    proptest! {
        #[test]
        fn the_quick_median_is_the_median(values in prop::collection::vec(-1e6..1e6f64, 1..40)) {
            let all: Vec<usize> = (0..values.len()).collect();
            prop_assert_eq!(Some(median_of(&values, &all)), stats::median(&values));
        }
    }
}
