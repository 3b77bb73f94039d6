//! Boxes to build trees over.

use glam::DVec3;
use proptest::prelude::*;
use scenes::bvh::Split;
use scenes::Aabb;

pub const SPLITS: [Split; 4] = [Split::Sah, Split::Middle, Split::EqualCount, Split::Ploc];

pub fn any_split() -> impl Strategy<Value = Split> {
    prop::sample::select(SPLITS.to_vec())
}

pub fn box_at(centre: DVec3, half: f64) -> Aabb {
    Aabb { min: centre - half, max: centre + half }
}

/// Scattered boxes, heaps of equal ones, points, flat ones, and ones far away or far apart in size.
pub fn any_boxes(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Aabb>> {
    let place = prop_oneof![
        4 => prop::array::uniform3(-100.0..100.0f64),
        4 => prop::array::uniform3(0..4i32).prop_map(|place| place.map(f64::from)),
        1 => prop::array::uniform3(-1e6..1e6f64),
        1 => (-60..60i32, 0..3usize).prop_map(|(power, axis)| {
            let mut place = [0.0; 3];
            place[axis] = f64::from(power).exp2();
            place
        }),
    ];
    let size = prop::array::uniform3(prop_oneof![Just(0.0), Just(1.0), 0.0..10.0f64, 0.0..1e-3f64]);
    let one = (place, size).prop_map(|(min, size)| Aabb { min: min.into(), max: DVec3::from(min) + DVec3::from(size) });
    prop::collection::vec(one, count)
}
