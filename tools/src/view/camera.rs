//! A camera that is flown by hand: plain data, moved by what is held down for how long.

use glam::{DQuat, DVec2, DVec3};
use scenes::{Pose, Scene};
use std::f64::consts::FRAC_PI_2;

/// Radians that the camera turns by a pixel of the mouse's way.
const TURN_PER_PX: f64 = 0.0025;
/// How much faster a notch of the wheel makes it.
const FASTER_PER_NOTCH: f64 = 1.25;
/// How much faster it is with Shift.
const HURRY: f64 = 5.0;
/// Seconds that it takes at first to cross a scene.
const CROSSING_S: f64 = 40.0;
/// As far as one can look up or down: short of where left and right change places.
const STEEPEST: f64 = FRAC_PI_2 - 0.01;

/// Which ways the camera is told to go: each part is -1, 0 or 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    /// To the right.
    pub right: f64,
    /// Up.
    pub up: f64,
    /// Forward.
    pub forward: f64,
    /// In a hurry.
    pub hurry: bool,
}

/// Where the camera is, where it looks, and how fast it goes. It is always upright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlyCamera {
    position: DVec3,
    /// Left turn from -z, radians.
    yaw: f64,
    /// Upward tilt, radians.
    pitch: f64,
    /// Metres a second.
    speed: f64,
}

impl FlyCamera {
    /// A camera in a pose, as fast as the scene is large.
    pub fn new(scene: &Scene, pose: &Pose) -> Self {
        let bounds = scene.bounds();
        let across = if bounds.is_valid() { 2.0 * bounds.half_extent().length() } else { 1.0 };
        let mut camera =
            FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, speed: (across / CROSSING_S).max(1e-3) };
        camera.take(pose);
        camera
    }

    /// Goes where a pose is and looks where it looks. What it leans to a side is left out.
    pub fn take(&mut self, pose: &Pose) {
        let forward = pose.forward();
        self.position = pose.position;
        self.pitch = forward.y.clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST);
        // Straight up or down, the top of the picture says where it heads.
        let level = if forward.y.abs() > 0.9999 { pose.rotation * DVec3::Y * -forward.y.signum() } else { forward };
        self.yaw = (-level.x).atan2(-level.z);
    }

    /// As a shot takes it.
    pub fn pose(&self) -> Pose {
        Pose { position: self.position, rotation: self.rotation() }
    }

    /// Metres a second.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Goes on for so many seconds.
    pub fn fly(&mut self, course: Course, seconds: f64) {
        let way = self.rotation() * DVec3::new(course.right, 0.0, -course.forward) + DVec3::Y * course.up;
        let speed = if course.hurry { HURRY * self.speed } else { self.speed };
        self.position += way.normalize_or_zero() * (speed * seconds);
    }

    /// Turns by the mouse's way in pixels, right and down.
    pub fn turn(&mut self, way_px: DVec2) {
        self.yaw -= way_px.x * TURN_PER_PX;
        self.pitch = (self.pitch - way_px.y * TURN_PER_PX).clamp(-STEEPEST, STEEPEST);
    }

    /// Gets faster, or slower by notches below 0.
    pub fn change_speed(&mut self, notches: f64) {
        self.speed = (self.speed * FASTER_PER_NOTCH.powf(notches)).clamp(1e-3, 1e7);
    }

    fn rotation(&self) -> DQuat {
        DQuat::from_rotation_y(self.yaw) * DQuat::from_rotation_x(self.pitch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> FlyCamera {
        FlyCamera { position: DVec3::ZERO, yaw: 0.0, pitch: 0.0, speed: 2.0 }
    }

    #[test]
    fn it_flies_where_it_looks_and_no_faster_askew() {
        let mut flown = camera();
        flown.fly(Course { forward: 1.0, ..Course::default() }, 0.5);
        assert!(flown.position.distance(DVec3::NEG_Z) < 1e-12);
        flown.turn(DVec2::new(FRAC_PI_2 / TURN_PER_PX, 0.0));
        flown.fly(Course { forward: 1.0, hurry: true, ..Course::default() }, 0.1);
        assert!(flown.position.distance(DVec3::new(1.0, 0.0, -1.0)) < 1e-12, "right of where it looked: {flown:?}");
        let mut askew = camera();
        askew.fly(Course { forward: 1.0, right: 1.0, up: 1.0, hurry: false }, 1.0);
        assert!((askew.position.length() - 2.0).abs() < 1e-12);
        let mut apart = camera();
        (0..10).for_each(|_| apart.fly(Course { right: 1.0, ..Course::default() }, 0.1));
        assert!(apart.position.distance(DVec3::X * 2.0) < 1e-12, "one long step or ten short ones");
    }

    #[test]
    fn it_never_turns_over() {
        let mut tilted = camera();
        tilted.turn(DVec2::new(0.0, -1e6));
        assert!((tilted.rotation() * DVec3::Y).y > 0.0 && tilted.pose().forward().y > 0.999);
    }

    #[test]
    fn it_takes_a_pose_and_gives_it_back() {
        for target in [DVec3::new(3.0, 1.0, -2.0), DVec3::new(-4.0, -7.0, 0.5), DVec3::Z] {
            let pose = Pose::looking_at(DVec3::ONE, DVec3::ONE + target);
            let mut camera = camera();
            camera.take(&pose);
            let taken = camera.pose();
            assert!(taken.forward().distance(pose.forward()) < 1e-9 && taken.position == pose.position, "{target}");
        }
        let mut down = camera();
        down.take(&Pose::looking_at(DVec3::ZERO, DVec3::NEG_Y));
        assert!(down.pose().forward().y < -0.999);
    }

    #[test]
    fn the_wheel_makes_it_faster_and_slower() {
        let mut camera = camera();
        camera.change_speed(2.0);
        camera.change_speed(-2.0);
        assert!((camera.speed() - 2.0).abs() < 1e-12);
        camera.change_speed(-1e6);
        assert!(camera.speed() > 0.0);
    }
}
