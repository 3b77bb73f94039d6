//! Mean, median and percentiles of samples. All answer `None` where there is nothing to answer from: no sample at all,
//! or a sample that is NaN (a defect of the measurement, which an ordinary number must not hide).

/// The arithmetic mean.
pub fn mean(samples: &[f64]) -> Option<f64> {
    if samples.is_empty() || samples.iter().any(|s| s.is_nan()) {
        return None;
    }
    Some(samples.iter().sum::<f64>() / samples.len() as f64)
}

/// Each label once, in order of first appearance, with the sum of its values.
pub fn by_label(values: &[(String, f64)]) -> Vec<(&str, f64)> {
    let mut sums: Vec<(&str, f64)> = Vec::new();
    for (label, value) in values {
        match sums.iter_mut().find(|(known, _)| known == label) {
            Some((_, sum)) => *sum += value,
            None => sums.push((label, *value)),
        }
    }
    sums
}

/// The middle sample, or the mean of the two in the middle.
pub fn median(samples: &[f64]) -> Option<f64> {
    percentile(samples, 50.0)
}

/// The value that `percent` of the samples do not exceed, linear between neighbouring ranks: 0 is the least sample and
/// 100 the greatest (the usual definition of numpy and spreadsheets). `percent` is clamped to 0..=100.
pub fn percentile(samples: &[f64], percent: f64) -> Option<f64> {
    if samples.is_empty() || percent.is_nan() || samples.iter().any(|s| s.is_nan()) {
        return None;
    }
    let mut sorted = samples.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let rank = percent.clamp(0.0, 100.0) / 100.0 * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[rank.floor() as usize], sorted[rank.ceil() as usize]);
    // Equal neighbours are returned as they are: interpolating infinities would give NaN.
    Some(if below == above { below } else { below + (above - below) * rank.fract() })
}

/// The 95th percentile: the slow frames without the slowest.
pub fn p95(samples: &[f64]) -> Option<f64> {
    percentile(samples, 95.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn nothing_has_no_statistics() {
        assert_eq!(mean(&[]), None);
        assert_eq!(median(&[]), None);
        assert_eq!(p95(&[]), None);
    }

    #[test]
    fn a_label_that_comes_again_is_one_row() {
        let values = [("b", 1.0), ("a", 2.0), ("b", 4.0)].map(|(label, value)| (label.to_owned(), value));
        assert_eq!(by_label(&values), [("b", 5.0), ("a", 2.0)]);
    }

    #[test]
    fn a_nan_is_never_averaged_away() {
        let samples = [1.0, f64::NAN, 3.0];
        assert_eq!(mean(&samples), None);
        assert_eq!(median(&samples), None);
        assert_eq!(p95(&samples), None);
    }

    #[test]
    fn known_values() {
        assert_eq!(mean(&[1.0, 2.0, 6.0]), Some(3.0));
        assert_eq!(median(&[7.0]), Some(7.0));
        assert_eq!(median(&[9.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), Some(2.5));
        let hundred_and_one: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        assert_eq!(p95(&hundred_and_one), Some(95.0));
        assert_eq!(percentile(&[0.0, 10.0], 25.0), Some(2.5));
        assert_eq!(percentile(&[1.0, f64::INFINITY], 0.0), Some(1.0));
        assert_eq!(median(&[f64::INFINITY; 2]), Some(f64::INFINITY));
    }

    /// Ranks lie between samples here, so that a nearest rank, or another percent, gives another value.
    #[test]
    fn each_percentile_has_its_own_rank() {
        let hundred: Vec<f64> = (1..=100).map(f64::from).collect();
        let near = |found: Option<f64>, expected: f64| {
            assert!((found.unwrap() - expected).abs() < 1e-9, "{found:?}, expected {expected}");
        };
        near(p95(&hundred), 95.05);
        near(median(&hundred), 50.5);
        near(percentile(&hundred, 90.0), 90.1);
        near(percentile(&hundred, 2.5), 3.475);
        near(percentile(&[1.0, 2.0, 4.0, 8.0], 75.0), 5.0);
        assert_eq!(percentile(&[1.0, 2.0], f64::NAN), None);
    }

    proptest! {
        #[test]
        fn statistics_lie_between_the_extremes(samples in prop::collection::vec(-1e6..1e6f64, 1..40)) {
            let least = percentile(&samples, -5.0).unwrap();
            let greatest = percentile(&samples, 105.0).unwrap();
            prop_assert_eq!(least, samples.iter().copied().fold(f64::INFINITY, f64::min));
            prop_assert_eq!(greatest, samples.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            let middle = median(&samples).unwrap();
            let high = p95(&samples).unwrap();
            prop_assert!(least <= middle && middle <= high && high <= greatest);
            let average = mean(&samples).unwrap();
            prop_assert!(average >= least - 1e-6 && average <= greatest + 1e-6);
        }

        #[test]
        fn order_of_samples_does_not_matter(samples in prop::collection::vec(-1e6..1e6f64, 1..40)) {
            let mut reversed = samples.clone();
            reversed.reverse();
            prop_assert_eq!(median(&samples), median(&reversed));
            prop_assert_eq!(p95(&samples), p95(&reversed));
        }
    }
}
