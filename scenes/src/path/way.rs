//! A polygon of eye positions, walked with the eyes ahead.

use super::back_and_forth;
use crate::camera::Pose;
use crate::model::Walk;
use glam::DVec3;

/// How far ahead the camera looks, as a part of the way at speed 1: it turns before it reaches a corner, and smoothly.
const LOOK_AHEAD: f64 = 0.05;

/// A [`Walk`] with the distance of each point along it.
#[derive(Clone, Debug)]
pub(super) struct Way {
    points: Vec<DVec3>,
    distances: Vec<f64>,
    length: f64,
    is_loop: bool,
}

impl Way {
    /// None if the walk does not lead anywhere.
    pub(super) fn new(walk: &Walk) -> Option<Self> {
        let mut distances = Vec::with_capacity(walk.points.len());
        let mut sum = 0.0;
        for (index, point) in walk.points.iter().enumerate() {
            sum += index.checked_sub(1).map_or(0.0, |before| point.distance(walk.points[before]));
            distances.push(sum);
        }
        let is_loop = walk.points.len() > 2 && walk.points.first() == walk.points.last();
        let leads_somewhere = sum > 0.0 && sum.is_finite() && walk.length > 0.0;
        leads_somewhere.then(|| Way { points: walk.points.clone(), distances, length: walk.length, is_loop })
    }

    /// The camera after `run` times the length of speed 1.
    pub(super) fn at(&self, run: f64) -> Pose {
        let total = self.total();
        let ahead = (LOOK_AHEAD * self.length).min(0.2 * total);
        let mut distance = run * self.length;
        if !self.is_loop {
            // Back and forth, always with a part of the way ahead. The camera keeps its direction, so it never cuts.
            distance = (total - ahead) * back_and_forth(distance / (total - ahead));
        }
        let position = self.point(distance);
        Pose::looking_at(position, self.point(distance + ahead))
    }

    fn total(&self) -> f64 {
        self.distances.last().copied().unwrap_or(0.0)
    }

    fn point(&self, distance: f64) -> DVec3 {
        let total = self.total();
        let distance = if self.is_loop { distance.rem_euclid(total) } else { distance.clamp(0.0, total) };
        let next = self.distances.partition_point(|&at| at <= distance).min(self.points.len() - 1);
        let before = next - 1;
        let t = (distance - self.distances[before]) / (self.distances[next] - self.distances[before]);
        self.points[before].lerp(self.points[next], t.clamp(0.0, 1.0))
    }
}
