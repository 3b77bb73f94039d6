//! Where to look at a scene from: its own camera, or a place made from its bounds.

use super::Shot;
use crate::camera::{Pose, Projection};
use crate::model::{Aabb, Scene};
use glam::{DQuat, DVec3};

/// Field of view of derived cameras, radians.
const FOV_Y: f64 = 60.0 * std::f64::consts::PI / 180.0;
/// The near plane of derived cameras, in radii of the scene.
const NEAR: f64 = 5e-4;
/// Where `closing-in` starts, in radii of the scene from its middle.
const FAR_OUTSIDE: f64 = 2.5;

/// The place that the standard paths start from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewpoint {
    pub pose: Pose,
    pub projection: Projection,
    /// Width over height of the rectangle that the camera was made for, if it was made for one.
    pub aspect: Option<f64>,
    /// Far outside: where `closing-in` starts.
    pub outside: DVec3,
    /// What `closing-in` looks at on its way.
    pub focus: DVec3,
    /// Radius of the scene in metres.
    pub reach: f64,
    /// How far the camera can move sideways.
    pub clearance: f64,
}

impl Viewpoint {
    /// The camera of that index, or if there is none, a three-quarter view from outside that holds the whole scene.
    pub(super) fn of(scene: &Scene, camera: usize) -> Self {
        let bounds = scene.bounds();
        let bounds = if bounds.is_valid() { bounds } else { Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE } };
        // A scene of one point, or none, is looked at as if it were a cube of 2 m.
        let bounds = match bounds.min == bounds.max {
            true => Aabb { min: bounds.min - DVec3::ONE, max: bounds.max + DVec3::ONE },
            false => bounds,
        };
        let radius = bounds.half_extent().length();
        match scene.cameras.get(camera) {
            Some(camera) => {
                let forward = camera.pose.forward();
                let start = camera.pose.position + back_and_up(forward) * (FAR_OUTSIDE * radius);
                let clearance = scene.walk.as_ref().map_or(0.1 * radius, |walk| walk.clearance);
                Viewpoint {
                    pose: camera.pose,
                    projection: camera.projection,
                    aspect: camera.aspect,
                    outside: start,
                    focus: camera.pose.position + forward * (0.25 * radius),
                    reach: radius,
                    clearance,
                }
            }
            None => Self::outside(&bounds, radius),
        }
    }

    /// A viewpoint of which only the pose and the projection are used.
    pub(super) fn fixed(pose: Pose, projection: Projection) -> Self {
        Viewpoint {
            pose,
            projection,
            aspect: None,
            outside: pose.position,
            focus: pose.position,
            reach: 1.0,
            clearance: 1.0,
        }
    }

    fn outside(bounds: &Aabb, radius: f64) -> Self {
        let centre = bounds.centre();
        // Flat scenes, cities for one, are looked at from higher up: from the side they hide themselves.
        let half = bounds.half_extent();
        let flatness = 1.0 - (half.y / half.x.max(half.z).max(f64::MIN_POSITIVE)).min(1.0);
        let direction = DVec3::new(0.6, 0.35 + 0.45 * flatness, 1.0).normalize();
        let distance = fitting_distance(bounds, direction);
        let pose = Pose::looking_at(centre + direction * distance, centre);
        Viewpoint {
            aspect: None,
            pose,
            projection: Projection::Perspective {
                fov_y: FOV_Y,
                near: NEAR * radius,
                far: Some(distance + 1.5 * radius),
            },
            outside: centre + direction * (distance + FAR_OUTSIDE * radius),
            focus: centre,
            reach: radius,
            clearance: 0.5 * radius,
        }
    }

    /// From outside (0) to the viewpoint (1). The distance left shrinks by the same factor in each frame, so that things
    /// grow evenly; the far plane moves out with the camera.
    pub(super) fn closing_in(&self, t: f64, seconds: f64) -> Shot {
        let arm = self.outside - self.pose.position;
        // From the whole way to a hundredth of it evenly; the subtraction takes the last hundredth off.
        let left = (0.01f64.powf(t) - 0.01) / 0.99;
        let position = self.pose.position + arm * left;
        // Towards the focus, and only near the end into the viewpoint's own direction.
        let rotation = short_way(Pose::looking_at(position, self.focus).rotation, self.pose.rotation, t.powi(4));
        let projection = match self.projection {
            Projection::Perspective { fov_y, near, far } => {
                Projection::Perspective { fov_y, near, far: far.map(|far| far + arm.length() * left) }
            }
            Projection::Orthographic { half_height, near, far } => {
                Projection::Orthographic { half_height, near, far: far + arm.length() * left }
            }
            Projection::Custom(_) => self.projection,
        };
        Shot { pose: Pose { position, rotation }, projection, seconds }
    }
}

/// Where `closing-in` comes from, as a unit direction from a camera that looks `forward`: back and up, so that a camera in a
/// street comes down along the street and not through houses.
pub(crate) fn back_and_up(forward: DVec3) -> DVec3 {
    let level = DVec3::new(forward.x, 0.0, forward.z).normalize_or(DVec3::NEG_Z);
    (DVec3::Y - level).normalize()
}

/// How far from the middle of a box a derived camera sees all of it in pictures of 4:3 and wider, looking against `direction`.
fn fitting_distance(bounds: &Aabb, direction: DVec3) -> f64 {
    let (centre, half) = (bounds.centre(), bounds.half_extent());
    let from_view = Pose::looking_at(centre + direction, centre).rotation;
    let tangent = (0.5 * FOV_Y).tan();
    let corners = (0..8).map(|corner| {
        let side = |axis: i32| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        let seen = from_view.inverse() * (half * DVec3::new(side(0), side(1), side(2)));
        // In front of the corner by as much as it lies beside or above the middle, and by some more to keep off the near plane.
        let beside = (seen.x.abs() / (tangent * 4.0 / 3.0)).max(seen.y.abs() / tangent);
        seen.z + beside.max(0.2 * half.length())
    });
    1.05 * corners.fold(f64::MIN_POSITIVE, f64::max)
}

/// From `from` to `to` along the shorter arc, exactly `to` at 1.
fn short_way(from: DQuat, to: DQuat, t: f64) -> DQuat {
    if t >= 1.0 {
        return to;
    }
    from.slerp(to, t).normalize()
}
