//! Camera paths: where the camera is in each frame of a run, and what the time in the scene is.
//!
//! A path is a pure function of the frame's number. `frames` divides one and the same way more or less finely; `speed`
//! makes the way longer, so 16 times the speed is 16 times the motion from frame to frame.

mod recorded;
mod street;
mod viewpoint;
mod way;

pub use recorded::{record, record_shots};
pub(crate) use viewpoint::back_and_up;

use crate::animation::Motion;
use crate::bounds::WorldBounds;
use crate::camera::{Fit, Pose, Projection};
use crate::error::SceneError;
use crate::model::{Aabb, Scene};
use glam::{DQuat, DVec3};
use recorded::Recording;
use std::f64::consts::TAU;
use std::path::Path;
use viewpoint::Viewpoint;
use way::Way;

/// Scene time that passes in a run at speed 1, in seconds, where the scene's motion has no end of its own.
const RUN_S: f64 = 16.0;
/// Frames of a run that goes the whole way at speed 1: 16 s at 60 Hz, as in Kim 2015, V.
const RUN_FRAMES: f64 = 960.0;
/// How far `cuts` goes on from frame to frame, as a part of the way: the golden section, which comes near no place again soon.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// How far `zoom` narrows the field of view.
const ZOOM: f64 = 4.0;

/// What the camera does on a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathKind {
    /// Moves as the scene's own animated camera does.
    Camera,
    /// Goes along the ground: the scene's own walk, or forward, or around.
    Walk,
    /// Moves sideways.
    Pan,
    /// Narrows the field of view to a quarter and widens it again.
    Zoom,
    /// Turns once around on the spot.
    Rotate,
    /// Comes from far outside to the scene's viewpoint.
    ClosingIn,
    /// Stands still.
    Still,
    /// Is somewhere else in each frame, scattered over the way of the scene's camera or walk.
    Cuts,
    /// Follows a recorded file.
    Recorded,
}

impl PathKind {
    /// The paths that every scene has and that go on steadily: all but [`PathKind::Cuts`].
    pub const EVERYWHERE: [PathKind; 6] =
        [PathKind::Walk, PathKind::Pan, PathKind::Zoom, PathKind::Rotate, PathKind::ClosingIn, PathKind::Still];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            PathKind::Camera => "camera",
            PathKind::Walk => "walk",
            PathKind::Pan => "pan",
            PathKind::Zoom => "zoom",
            PathKind::Rotate => "rotate",
            PathKind::ClosingIn => "closing-in",
            PathKind::Still => "still",
            PathKind::Cuts => "cuts",
            PathKind::Recorded => "recorded",
        }
    }
}

/// The camera in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// Where it stands and looks.
    pub pose: Pose,
    /// What it sees.
    pub projection: Projection,
    /// The time in the scene, for [`Motion::transforms_at`].
    pub seconds: f64,
}

/// A camera path through one scene.
#[derive(Clone, Debug)]
pub struct CameraPath {
    name: String,
    speed: f64,
    whole: bool,
    base: Viewpoint,
    course: Course,
    clock: Clock,
    /// Says what else a shot depends on: a recording's hash.
    detail: String,
    /// The factor by which view volumes are higher than the camera's: see [`CameraPath::fitted`].
    widening: f64,
}

#[derive(Clone, Debug)]
enum Course {
    Animated {
        motion: Motion,
        node: usize,
    },
    Along(Way),
    Around {
        centre: DVec3,
    },
    Forward {
        metres: f64,
    },
    Pan,
    Zoom,
    Rotate,
    ClosingIn,
    Still,
    /// This course, out of order.
    Scattered(Box<Course>),
    Recorded(Recording),
}

/// How scene time passes.
#[derive(Clone, Copy, Debug)]
enum Clock {
    /// Back and forth between the first key and the last, in seconds.
    Keys(f64, f64),
    /// On and on, by so many seconds a run at speed 1.
    Endless(f64),
}

impl CameraPath {
    /// The names that [`CameraPath::named`] takes for a scene, its default first.
    pub fn names(scene: &Scene) -> Vec<&'static str> {
        let animated = animated_camera(scene).map(|_| PathKind::Camera);
        animated.into_iter().chain(PathKind::EVERYWHERE).chain([PathKind::Cuts]).map(PathKind::name).collect()
    }

    /// A path by name; without a name the scene's animated camera, or a walk if it has none.
    ///
    /// # Errors
    /// An unknown name, or a speed that is not above 0 and finite.
    pub fn named(scene: &Scene, name: Option<&str>, speed: f64) -> Result<CameraPath, SceneError> {
        check_speed(speed)?;
        let names = CameraPath::names(scene);
        let name = name.unwrap_or(names[0]);
        let animated = animated_camera(scene);
        let base = Viewpoint::of(scene, animated.map_or(0, |(camera, _)| camera));
        let by_camera = |node: usize| Course::Animated { motion: scene.motion.clone(), node };
        let course = match (name, animated) {
            ("camera", Some((_, node))) => by_camera(node),
            ("cuts", Some((_, node))) => Course::Scattered(Box::new(by_camera(node))),
            ("cuts", None) => Course::Scattered(Box::new(walk_of(scene, &base))),
            ("walk", _) => walk_of(scene, &base),
            ("pan", _) => Course::Pan,
            ("zoom", _) => Course::Zoom,
            ("rotate", _) => Course::Rotate,
            ("closing-in", _) => Course::ClosingIn,
            ("still", _) => Course::Still,
            _ => {
                let choices = names.join(", ") + ", or a .json file of recorded frames";
                return Err(SceneError::Unknown { kind: "camera path", name: name.into(), choices });
            }
        };
        let clock = Clock::of(&scene.motion);
        Ok(CameraPath {
            name: name.into(),
            speed,
            whole: false,
            base,
            course,
            clock,
            detail: String::new(),
            widening: 1.0,
        })
    }

    /// A path recorded in a file, see [`record`] for the format. Scene time follows the recording if it has times,
    /// otherwise it passes as on the other paths, sixteen seconds a run.
    ///
    /// # Errors
    /// A file that cannot be read or is no recording, or a speed that is not above 0 and finite.
    pub fn from_file(path: &Path, speed: f64) -> Result<CameraPath, SceneError> {
        check_speed(speed)?;
        let recording = Recording::read(path)?;
        let first = recording.at(0.0);
        let base = Viewpoint::fixed(first.pose, first.projection);
        let name = path.file_stem().map_or("recorded".into(), |stem| stem.to_string_lossy().into_owned());
        let detail = format!(" sha256={}", recording.fingerprint());
        let clock = Clock::Endless(RUN_S);
        Ok(CameraPath {
            name,
            speed,
            whole: false,
            base,
            course: Course::Recorded(recording),
            clock,
            detail,
            widening: 1.0,
        })
    }

    /// The name asked for, or the stem of the recorded file's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the camera does.
    pub fn kind(&self) -> PathKind {
        match self.course {
            Course::Animated { .. } => PathKind::Camera,
            Course::Along(_) | Course::Around { .. } | Course::Forward { .. } => PathKind::Walk,
            Course::Pan => PathKind::Pan,
            Course::Zoom => PathKind::Zoom,
            Course::Rotate => PathKind::Rotate,
            Course::ClosingIn => PathKind::ClosingIn,
            Course::Still => PathKind::Still,
            Course::Scattered(_) => PathKind::Cuts,
            Course::Recorded(_) => PathKind::Recorded,
        }
    }

    /// How many times the way of speed 1 the camera goes in a run.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// A line that differs between any two paths through the same scene, and stays the same from run to run: for cache keys.
    pub fn describe(&self) -> String {
        let whole = if self.whole { " whole" } else { "" };
        let wider = if self.widening == 1.0 { String::new() } else { format!(" wider={:?}", self.widening) };
        format!("{} speed={:?}{whole}{}{wider}", self.name, self.speed, self.detail)
    }

    /// Returns the path for pictures of an aspect (width over height), with the rectangle of the scene's camera fitted into them.
    pub fn fitted(self, aspect: f64, fit: Fit) -> Self {
        let widening = fit.widening(self.base.aspect, aspect);
        CameraPath { widening, ..self }
    }

    /// Width over height of the rectangle that the scene's camera was made for; none for any rectangle.
    pub fn aspect(&self) -> Option<f64> {
        self.base.aspect
    }

    /// The factor, 1 or more, by which view volumes are higher than the camera's because pictures are too narrow.
    pub fn widening(&self) -> f64 {
        self.widening
    }

    /// The same path, its whole way (times the speed) spread over each run, however few frames that has: for seeing all of
    /// it quickly. The camera then moves by large steps.
    pub fn whole(self) -> Self {
        CameraPath { whole: true, ..self }
    }

    /// The camera in frame `frame` of a run of `frames`. At speed 1 a frame goes on by 1/960 of the way, whatever the
    /// run's length, so that motion from frame to frame is that of the papers' 16 second sequences. A recorded or animated
    /// path is spread over the run from first key to last instead, as is [`CameraPath::whole`]; both ends are included.
    /// Frames past the last go on beyond. On the path `cuts` the frame's number alone says where on the way it is: each
    /// frame is 0.38 or 0.62 of the way from the one before, in scene time too, and no two are at one place.
    pub fn sample(&self, frame: usize, frames: usize) -> Shot {
        let (course, is_scattered) = match &self.course {
            Course::Scattered(course) => (course.as_ref(), true),
            course => (course, false),
        };
        let spread = self.whole || matches!(self.course, Course::Animated { .. } | Course::Recorded(_));
        let way = match (spread, frames) {
            _ if is_scattered => (frame as f64 * GOLDEN).fract(),
            (true, ..2) => 0.0,
            (true, frames) => frame as f64 / (frames - 1) as f64,
            (false, _) => frame as f64 / RUN_FRAMES,
        };
        let run = way * self.speed;
        let seconds = self.clock.at(run);
        let Viewpoint { pose, projection, .. } = self.base;
        let mut shot = Shot { pose, projection, seconds };
        match course {
            // It is one level deep.
            Course::Scattered(_) | Course::Still => {}
            Course::Animated { motion, node } => shot.pose = motion.camera_pose_at(*node, seconds).unwrap_or(pose),
            Course::Along(way) => shot.pose = way.at(run),
            Course::Around { centre } => shot.pose = around(pose, *centre, 0.5 * run),
            Course::Forward { metres } => shot.pose.position += level_forward(pose) * (*metres * back_and_forth(run)),
            Course::Pan => shot.pose.position += pose.rotation * DVec3::X * (self.base.clearance * back_and_forth(run)),
            Course::Zoom => shot.projection = zoomed(projection, back_and_forth(2.0 * run)),
            Course::Rotate => shot.pose.rotation = DQuat::from_rotation_y(-TAU * run.fract()) * pose.rotation,
            Course::ClosingIn => shot = self.base.closing_in(back_and_forth(run), seconds),
            Course::Recorded(recording) => {
                let recorded = recording.at(back_and_forth(run));
                shot = Shot {
                    pose: recorded.pose,
                    projection: recorded.projection,
                    seconds: recorded.seconds.unwrap_or(seconds),
                };
            }
        }
        shot.projection = shot.projection.widened(self.widening);
        shot
    }
}

impl Clock {
    fn of(motion: &Motion) -> Self {
        match motion {
            Motion::Nodes(nodes) => {
                let (first, last) = nodes.duration_s();
                Clock::Keys(first, last)
            }
            Motion::Still | Motion::Orbits(_) => Clock::Endless(RUN_S),
        }
    }

    fn at(self, run: f64) -> f64 {
        match self {
            // Weighted, not first + t (last - first): that may miss the last key by a rounding.
            Clock::Keys(first, last) => {
                let t = back_and_forth(run);
                first * (1.0 - t) + last * t
            }
            Clock::Endless(seconds) => seconds * run,
        }
    }
}

/// Index of the first camera that an animated node carries, and the node.
fn animated_camera(scene: &Scene) -> Option<(usize, usize)> {
    scene.cameras.iter().enumerate().find_map(|(index, camera)| {
        let node = camera.node?;
        scene.motion.camera_pose_at(node, 0.0).map(|_| (index, node))
    })
}

fn walk_of(scene: &Scene, base: &Viewpoint) -> Course {
    if let Some(way) = scene.walk.as_ref().and_then(Way::new) {
        return Course::Along(way);
    }
    if !scene.cameras.is_empty() {
        return Course::Forward { metres: 0.25 * base.reach };
    }
    let bounds = WorldBounds::new(scene);
    let boxes: Vec<Aabb> =
        scene.objects.iter().map(|object| bounds.of(object.mesh, &object.world_from_object)).collect();
    let all = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    match street::through(&boxes, &all).as_ref().and_then(Way::new) {
        Some(way) => Course::Along(way),
        None => Course::Around { centre: if all.is_valid() { all.centre() } else { DVec3::ZERO } },
    }
}

/// The pose turned by a part of a full turn about the vertical through `centre`.
fn around(pose: Pose, centre: DVec3, turns: f64) -> Pose {
    let turn = DQuat::from_rotation_y(TAU * turns.fract());
    Pose { position: centre + turn * (pose.position - centre), rotation: turn * pose.rotation }
}

/// The direction of view without its vertical part; straight up or down has none, then -z.
fn level_forward(pose: Pose) -> DVec3 {
    let forward = pose.forward();
    DVec3::new(forward.x, 0.0, forward.z).normalize_or(DVec3::NEG_Z)
}

/// 0 at even numbers, 1 at odd ones, straight between.
fn back_and_forth(run: f64) -> f64 {
    let phase = run.rem_euclid(2.0);
    if phase <= 1.0 {
        phase
    } else {
        2.0 - phase
    }
}

/// Narrower by [`ZOOM`] to the power of `amount`. A custom projection has no field of view to change; it stays.
fn zoomed(projection: Projection, amount: f64) -> Projection {
    let factor = ZOOM.powf(-amount);
    match projection {
        Projection::Perspective { fov_y, near, far } => Projection::Perspective { fov_y: fov_y * factor, near, far },
        Projection::Orthographic { half_height, near, far } => {
            Projection::Orthographic { half_height: half_height * factor, near, far }
        }
        Projection::Custom(_) => projection,
    }
}

fn check_speed(speed: f64) -> Result<(), SceneError> {
    // At higher speeds rounding loses a frame's place on the way and its time in the scene; far higher ones overflow.
    const FASTEST: f64 = 1e6;
    if speed > 0.0 && speed <= FASTEST {
        return Ok(());
    }
    let choices = "any number above 0 and up to 1000000, usually 1 to 16".into();
    Err(SceneError::Unknown { kind: "camera speed", name: crate::error::typed_number(speed), choices })
}
