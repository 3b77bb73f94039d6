//! Keeping ways free: how far places are from a way of straight pieces.

use crate::path::back_and_up;
use glam::DVec3;

/// Distance in metres of a place from the nearest point of a way of two points or more.
pub(super) fn distance(way: &[DVec3], at: DVec3) -> f64 {
    let nearest = |piece: &[DVec3]| {
        let along = piece[1] - piece[0];
        let part = (at - piece[0]).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        (piece[0] + along * part.clamp(0.0, 1.0)).distance(at)
    };
    way.windows(2).map(nearest).fold(f64::INFINITY, f64::min)
}

/// The same, seen from above: heights do not count.
pub(super) fn level_distance(way: &[DVec3], at: DVec3) -> f64 {
    let flat = |point: &DVec3| DVec3::new(point.x, 0.0, point.z);
    let way: Vec<DVec3> = way.iter().map(flat).collect();
    distance(&way, flat(&at))
}

/// The straight line by which the path `closing-in` comes to a camera at the start of a way, from so many metres away.
pub(super) fn approach(way: &[DVec3], metres: f64) -> [DVec3; 2] {
    [way[0], way[0] + back_and_up(way[1] - way[0]) * metres]
}

/// A closed ring of a radius about a vertical axis, counter-clockwise from above, starting at an angle in radians. Each point's
/// height is that of `height` there.
pub(super) fn ring(centre: DVec3, radius: f64, start: f64, height: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    /// Points of the ring: turns of 5 degrees.
    const POINTS: usize = 72;
    let point = |step: usize| {
        let angle = start + (step % POINTS) as f64 / POINTS as f64 * std::f64::consts::TAU;
        let at = centre + DVec3::new(angle.cos(), 0.0, -angle.sin()) * radius;
        DVec3::new(at.x, height(at), at.z)
    };
    (0..=POINTS).map(point).collect()
}
