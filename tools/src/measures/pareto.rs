//! Which of many settings are worth choosing: those that no other one beats in both of two measures.

/// The points that no other point beats, where less is better in both coordinates: their indices, by the first coordinate and
/// then in the order given. A point beats another if it is nowhere worse and somewhere better, so that equal points all stay. A
/// point with a coordinate that is not a number is never one of them.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let known = |&index: &usize| !points[index].0.is_nan() && !points[index].1.is_nan();
    let mut order: Vec<usize> = (0..points.len()).filter(known).collect();
    // -0 and 0 are one place; the sort is stable, so that equal points keep their order.
    let by = |one: f64, other: f64| (one + 0.0).total_cmp(&(other + 0.0));
    order.sort_by(|&one, &other| {
        by(points[one].0, points[other].0).then_with(|| by(points[one].1, points[other].1)).then(one.cmp(&other))
    });
    // From left to right, whoever is on the front is lower than all before, or equal to the last one on it.
    let mut front: Vec<usize> = Vec::new();
    for index in order {
        let stays = front.last().is_none_or(|&last| points[index].1 < points[last].1 || points[index] == points[last]);
        if stays {
            front.push(index);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn nothing_and_one_point() {
        assert!(front(&[]).is_empty());
        assert_eq!(front(&[(3.0, 4.0)]), [0]);
        assert_eq!(front(&[(f64::NAN, 0.0), (1.0, 1.0), (0.0, f64::NAN)]), [1]);
    }

    #[test]
    fn the_front_is_sorted_by_the_first_coordinate() {
        assert_eq!(front(&[(3.0, 1.0), (1.0, 3.0), (2.0, 2.0), (3.0, 3.0)]), [1, 2, 0]);
    }

    #[test]
    fn a_tie_in_one_coordinate_is_decided_by_the_other() {
        assert_eq!(front(&[(1.0, 2.0), (1.0, 1.0)]), [1]);
        assert_eq!(front(&[(2.0, 0.0), (1.0, 0.0)]), [1]);
        assert_eq!(front(&[(1.0, 0.0), (1.0, -0.0), (2.0, -0.0)]), [0, 1]);
    }

    #[test]
    fn equal_points_all_stay_or_all_go() {
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0), (0.5, 2.0), (1.0, 1.0)]), [2, 0, 1, 3]);
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0), (0.0, 0.0)]), [2]);
    }

    proptest! {
        #[test]
        fn the_front_is_what_nobody_beats(points in prop::collection::vec((0..6u8, 0..6u8), 0..20)) {
            let points: Vec<(f64, f64)> = points.into_iter().map(|(x, y)| (x.into(), y.into())).collect();
            let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
            let mut found = front(&points);
            prop_assert!(found.windows(2).all(|pair| points[pair[0]].0 <= points[pair[1]].0));
            found.sort_unstable();
            let expected: Vec<usize> =
                (0..points.len()).filter(|&i| !points.iter().any(|&other| beats(other, points[i]))).collect();
            prop_assert_eq!(found, expected);
        }
    }
}
