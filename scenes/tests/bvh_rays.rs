//! Laws of the ray traversal (EOVC thesis, section III.4).

mod bvh_support;

use bvh_support::{any_boxes, any_split, box_at};
use glam::DVec3;
use proptest::prelude::*;
use scenes::bvh::{hit_leaves, Bvh, Split};
use scenes::Aabb;

const FORWARD: std::ops::RangeInclusive<f64> = 0.0..=f64::INFINITY;

/// A ray and a point that lies on it exactly at `t = times`, though origin, point and direction take all bits that `f64`
/// has: `times * step` needs up to 60 bits, of which the point has the upper and the origin, negated, the lower ones.
fn ray_through_point(step: [i64; 3], times: i64) -> (DVec3, DVec3, DVec3) {
    let low_bits = |product: i64| product & ((1 << 30) - 1);
    let products = step.map(|step| step * times);
    let vector = |parts: [i64; 3]| DVec3::from(parts.map(|part| part as f64));
    (
        vector(products.map(|product| -low_bits(product))),
        vector(step),
        vector(products.map(|product| product - low_bits(product))),
    )
}

fn any_step() -> impl Strategy<Value = [i64; 3]> {
    prop::array::uniform3(prop_oneof![-(1i64 << 53)..1 << 53, -3i64..4, -(1i64 << 32)..1 << 32])
}

proptest! {
    #[test]
    fn no_box_on_the_ray_is_missed_by_rounding(step in any_step(), times in 1i64..128, others in any_boxes(0..20), split in any_split()) {
        let (origin, direction, point) = ray_through_point(step, times);
        let mut boxes = others;
        boxes.push(box_at(point, 0.0));
        let bvh = Bvh::build(&boxes, split).unwrap();
        let leaf = bvh.leaf_of_object()[boxes.len() - 1];
        let t = times as f64;
        for range in [t..=t, FORWARD, 0.0..=t, t..=f64::MAX] {
            let hits = hit_leaves(&bvh, 0, origin, direction, range.clone());
            prop_assert!(hits.contains(&leaf), "{range:?} misses {point} from {origin} along {direction}");
        }
    }

    #[test]
    fn a_ray_meets_what_holds_a_point_of_it(
        boxes in any_boxes(1..80), split in any_split(),
        origin in prop::array::uniform3(-200i32..200), target in prop::array::uniform3(-6i32..6), stretch in 1..9i32,
    ) {
        let (origin, target) = (DVec3::from(origin.map(f64::from)), DVec3::from(target.map(f64::from)));
        let direction = (target - origin) * f64::from(stretch);
        let bvh = Bvh::build(&boxes, split).unwrap();
        let hits = hit_leaves(&bvh, 0, origin, direction, 0.0..=1.0);
        for (object, bounds) in boxes.iter().enumerate() {
            if bounds.contains(target) {
                prop_assert!(hits.contains(&bvh.leaf_of_object()[object]), "{bounds:?}");
            }
        }
    }

    #[test]
    fn the_tree_finds_what_each_box_alone_answers(
        boxes in any_boxes(1..80), split in any_split(),
        origin in prop::array::uniform3(-200.0..200.0f64), direction in prop::array::uniform3(prop_oneof![-1.0..1.0f64, Just(0.0)]),
    ) {
        let (origin, direction) = (DVec3::from(origin), DVec3::from(direction));
        let bvh = Bvh::build(&boxes, split).unwrap();
        for range in [FORWARD, -50.0..=50.0, 1.0..=0.0] {
            let alone = |bounds: &Aabb| {
                let one = Bvh::build(&[*bounds], Split::Sah).unwrap();
                !hit_leaves(&one, 0, origin, direction, range.clone()).is_empty()
            };
            let mut expected: Vec<u32> = boxes.iter().zip(bvh.leaf_of_object()).filter(|(bounds, _)| alone(bounds))
                .map(|(_, leaf)| *leaf).collect();
            expected.sort_unstable();
            prop_assert_eq!(hit_leaves(&bvh, 0, origin, direction, range.clone()), expected);
        }
    }

    #[test]
    fn a_subtree_answers_for_its_own_leaves(boxes in any_boxes(2..60), split in any_split(), direction in prop::array::uniform3(-1.0..1.0f64)) {
        let bvh = Bvh::build(&boxes, split).unwrap();
        let hits = |root| hit_leaves(&bvh, root, DVec3::ZERO, direction.into(), FORWARD);
        let mut both = [hits(1), hits(2)].concat();
        both.sort_unstable();
        prop_assert_eq!(hits(0), both);
    }
}

fn meets(bounds: Aabb, origin: DVec3, direction: DVec3) -> bool {
    let bvh = Bvh::build(&[bounds], Split::Sah).unwrap();
    !hit_leaves(&bvh, 0, origin, direction, FORWARD).is_empty()
}

#[test]
fn a_ray_that_passes_by_meets_nothing() {
    let cube = box_at(DVec3::ZERO, 1.0);
    let slightly = 1.0 + 1e-12;
    assert!(meets(cube, DVec3::new(-5.0, 1.0, 1.0), DVec3::X), "along an edge");
    assert!(!meets(cube, DVec3::new(-5.0, slightly, 1.0), DVec3::X), "beside an edge");
    assert!(!meets(cube, DVec3::new(-5.0, 0.0, 0.0), DVec3::NEG_X), "away from it");
    assert!(meets(cube, DVec3::new(-2.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0)), "through a corner");
    assert!(!meets(cube, DVec3::new(-2.0 * slightly, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0)), "beside a corner");
    assert!(
        !meets(box_at(DVec3::splat(1e6), 0.0), DVec3::ZERO, DVec3::new(1.0, 1.0, 1.0 + 1e-12)),
        "beside a far point"
    );
}

#[test]
fn a_direction_of_zero_asks_for_the_origin() {
    let cube = box_at(DVec3::ZERO, 1.0);
    assert!(meets(cube, DVec3::ONE, DVec3::ZERO));
    assert!(!meets(cube, DVec3::new(1.5, 0.0, 0.0), DVec3::ZERO));
}

#[test]
fn a_ray_that_is_no_number_meets_everything() {
    let cube = box_at(DVec3::ZERO, 1.0);
    assert!(meets(cube, DVec3::NAN, DVec3::X));
    assert!(meets(cube, DVec3::ZERO, DVec3::NAN));
}

#[test]
fn distances_beyond_f64_conclude_nothing() {
    let most = Aabb { min: DVec3::splat(f64::MAX), max: DVec3::splat(f64::MAX) };
    assert!(meets(most, DVec3::splat(-f64::MAX), DVec3::ONE));
    assert!(meets(most, DVec3::splat(-f64::MAX), DVec3::splat(1e-300)));
    assert!(!meets(most, DVec3::splat(0.0), DVec3::new(1.0, 1.0, -1.0)));
}
