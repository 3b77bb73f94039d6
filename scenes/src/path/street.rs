//! A walk through a scene that brings none: the straight line near the ground that meets the fewest objects.

use crate::model::{Aabb, Walk};
use glam::DVec3;

/// Scenes higher than this part of their width are models to walk around, not land to walk through.
const FLATTEST_MODEL: f64 = 0.4;
/// Eye height, as a part of the scene's height.
const EYE: f64 = 0.2;
/// Lines tried along each of x and z.
const LINES: usize = 63;
/// How far a path of speed 1 goes, as a part of the line.
const LENGTH: f64 = 0.3;

/// A line from edge to edge through the boxes of a scene, of which `all` is the union. None if the scene is no land.
pub(super) fn through(boxes: &[Aabb], all: &Aabb) -> Option<Walk> {
    let size = all.max - all.min;
    if !all.is_valid() || size.y > FLATTEST_MODEL * size.x.max(size.z) {
        return None;
    }
    let eye = all.min.y + EYE * size.y;
    let mut best: Option<(f64, [DVec3; 2])> = None;
    for axis in [0, 2] {
        let across = 2 - axis;
        for line in 1..=LINES {
            let part = line as f64 / (LINES + 1) as f64;
            let mut ends = [all.min, all.max];
            for end in &mut ends {
                end.y = eye;
                end[across] = all.min[across] + part * size[across];
            }
            // Of equally free lines, the one nearest to the middle. The weight is less than any object's.
            let cost = blocked(boxes, all, ends[0], axis, across) + 1e-3 * (part - 0.5).abs();
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, ends));
            }
        }
    }
    best.map(|(_, [from, to])| {
        let length = LENGTH * from.distance(to);
        Walk { points: vec![from, to], length, clearance: 0.01 * length }
    })
}

/// How much of a line along an axis lies in boxes, in metres of box for a metre of line. Boxes as long as the scene, such as
/// ground and sky, are not in the way.
fn blocked(boxes: &[Aabb], all: &Aabb, from: DVec3, axis: usize, across: usize) -> f64 {
    let size = all.max - all.min;
    let in_way = |bounds: &&Aabb| {
        let hit = |axis: usize| bounds.min[axis] <= from[axis] && from[axis] <= bounds.max[axis];
        hit(1) && hit(across) && bounds.max[axis] - bounds.min[axis] < 0.9 * size[axis]
    };
    let length = |bounds: &Aabb| bounds.max[axis] - bounds.min[axis];
    boxes.iter().filter(in_way).map(length).sum::<f64>() / size[axis].max(f64::MIN_POSITIVE)
}
