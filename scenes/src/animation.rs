//! How objects and cameras move over time.
//!
//! Everything is a pure function of the time in seconds, in `f64`: the same time always gives the same bytes, so a run can be
//! repeated and any frame can be asked for on its own.

mod nodes;
mod track;

pub(crate) use nodes::pose_of;
pub use nodes::{AnimatedNode, Attachment, Local, NodeAnimation};
pub(crate) use track::Between;
pub use track::{Interpolate, Interpolation, Track};

use crate::camera::Pose;
use glam::{DAffine3, DQuat, DVec3};
use std::f64::consts::TAU;

/// How the dynamic objects and cameras of a scene move.
#[derive(Clone, Debug, Default)]
pub enum Motion {
    /// Nothing moves.
    #[default]
    Still,
    /// A tree of animated nodes carries objects and cameras (glTF).
    Nodes(NodeAnimation),
    /// Each entry moves one object for ever (procedural scenes).
    Orbits(Vec<Orbit>),
}

impl Motion {
    /// World from object of every dynamic object at a time, in order of object index. `out` is cleared first.
    /// Before the first key and after the last, objects keep the place they have there.
    pub fn transforms_at(&self, seconds: f64, out: &mut Vec<(u32, DAffine3)>) {
        out.clear();
        match self {
            Motion::Still => {}
            Motion::Nodes(nodes) => nodes.transforms_at(seconds, out),
            Motion::Orbits(orbits) => {
                out.extend(orbits.iter().map(|orbit| (orbit.object, orbit.world_from_object(seconds))));
                out.sort_by_key(|&(object, _)| object);
            }
        }
    }

    /// Times of the first and the last key in seconds; (0, 0) if nothing moves. Orbits have no end: they give (0, longest period).
    pub fn duration_s(&self) -> (f64, f64) {
        match self {
            Motion::Still => (0.0, 0.0),
            Motion::Nodes(nodes) => nodes.duration_s(),
            Motion::Orbits(orbits) => (0.0, orbits.iter().map(Orbit::period_s).fold(0.0, f64::max)),
        }
    }

    /// Where the camera on a node (see [`crate::Camera::node`]) is at a time; none if there is no such node.
    pub fn camera_pose_at(&self, node: usize, seconds: f64) -> Option<Pose> {
        match self {
            Motion::Nodes(nodes) => nodes.pose_at(node, seconds),
            Motion::Still | Motion::Orbits(_) => None,
        }
    }

    /// Indices of the objects that move, ascending: those for which [`Object::dynamic`](crate::Object::dynamic) must be set.
    pub fn dynamic_objects(&self) -> Vec<u32> {
        match self {
            Motion::Still => Vec::new(),
            Motion::Nodes(nodes) => nodes.objects().iter().map(|attachment| attachment.object).collect(),
            Motion::Orbits(orbits) => {
                let mut objects: Vec<u32> = orbits.iter().map(|orbit| orbit.object).collect();
                objects.sort_unstable();
                objects
            }
        }
    }
}

/// The endless motion of one object: a rotation about an axis and a sinusoidal shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Index of the object; at most one orbit an object.
    pub object: u32,
    /// World from object at time 0.
    pub base: DAffine3,
    /// A point on the axis, in the world, in metres.
    pub centre: DVec3,
    /// Direction of the axis, of any length but zero; zero means no rotation.
    pub axis: DVec3,
    /// Angular speed, right-handed about the axis; 0 for none.
    pub radians_per_s: f64,
    /// Largest shift from the orbit in metres, reached a quarter of a period after time 0.
    pub bob: DVec3,
    /// Time of one swing, > 0; otherwise there is no shift.
    pub bob_period_s: f64,
}

impl Orbit {
    /// World from object at a time.
    pub fn world_from_object(&self, seconds: f64) -> DAffine3 {
        let angle = (self.radians_per_s * seconds) % TAU;
        let rotation = match self.axis.try_normalize() {
            Some(axis) => DQuat::from_axis_angle(axis, angle),
            None => DQuat::IDENTITY,
        };
        let shift = if self.bob_period_s > 0.0 {
            self.bob * (TAU * (seconds / self.bob_period_s).fract()).sin()
        } else {
            DVec3::ZERO
        };
        let arm = rotation * (self.base.translation - self.centre);
        DAffine3 {
            matrix3: glam::DMat3::from_quat(rotation) * self.base.matrix3,
            translation: self.centre + arm + shift,
        }
    }

    /// Time in seconds after which both parts have come round at least once; 0 if the object does not move.
    pub fn period_s(&self) -> f64 {
        let turn = if self.radians_per_s == 0.0 { 0.0 } else { TAU / self.radians_per_s.abs() };
        turn.max(self.bob_period_s).max(0.0)
    }
}
