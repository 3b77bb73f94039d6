//! Recorded paths: a JSON file with one camera a frame.

use super::{CameraPath, Shot};
use crate::camera::{Pose, Projection};
use crate::error::SceneError;
use glam::{DQuat, DVec3};
use serde_json::{json, Value};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Farthest place of a recorded camera, metres: there a double still resolves 0.0001 m.
const FARTHEST_M: f64 = 1e12;
/// Narrowest field of view, degrees, and the range of near and far planes, metres: beyond them projections overflow in single
/// precision.
const NARROWEST_DEG: f64 = 1e-6;
const PLANES_M: std::ops::RangeInclusive<f64> = 1e-18..=1e18;
/// Latest time in the scene, seconds: 30 years, where a double still resolves a microsecond.
const LATEST_S: f64 = 1e9;

/// One frame of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RecordedShot {
    pub pose: Pose,
    pub projection: Projection,
    pub seconds: Option<f64>,
}

/// A recorded path with at least one frame.
#[derive(Clone, Debug)]
pub(super) struct Recording {
    frames: Vec<RecordedShot>,
    sha256: [u8; 32],
}

/// A path's frames as a file that [`CameraPath::from_file`] reads:
/// `{"schema": 1, "frames": [{"position": [x, y, z], "rotation": [x, y, z, w], "fov_y_deg": 60, "near": 0.1, "far": 1000}]}`,
/// metres and degrees; without `far` there is no far plane; `seconds`, if there, is the time in the scene.
///
/// # Errors
/// If a frame's projection is not a perspective: the format has no others.
pub fn record(path: &CameraPath, frames: usize) -> Result<String, SceneError> {
    let shots: Vec<Shot> = (0..frames).map(|frame| path.sample(frame, frames)).collect();
    record_shots(path.name(), &shots)
}

/// The same of shots from anywhere: of a camera that was flown by hand. `name` is for errors.
///
/// # Errors
/// If a shot's projection is not a perspective.
pub fn record_shots(name: &str, shots: &[Shot]) -> Result<String, SceneError> {
    let frames: Result<Vec<Value>, SceneError> = shots.iter().map(|shot| frame_value(name, shot)).collect();
    Ok(json!({ "schema": 1, "frames": frames? }).to_string())
}

fn frame_value(name: &str, shot: &Shot) -> Result<Value, SceneError> {
    let Shot { pose, projection, seconds } = *shot;
    let Projection::Perspective { fov_y, near, far } = projection else {
        return Err(SceneError::Unsupported {
            path: name.into(),
            what: "recording a camera without perspective".into(),
            remedy: "; choose a path with another camera".into(),
        });
    };
    let mut value = json!({
        "position": pose.position.to_array(),
        "rotation": pose.rotation.to_array(),
        "fov_y_deg": fov_y.to_degrees(),
        "near": near,
        "seconds": seconds,
    });
    if let Some(far) = far {
        value["far"] = far.into();
    }
    Ok(value)
}

impl Recording {
    pub(super) fn read(path: &Path) -> Result<Self, SceneError> {
        let bytes = std::fs::read(path).map_err(|cause| SceneError::Read { path: path.into(), cause })?;
        let frames = parse(&bytes).map_err(|fault| SceneError::Broken { path: path.into(), fault })?;
        Ok(Recording { frames, sha256: Sha256::digest(&bytes).into() })
    }

    /// The first 16 digits of the file's SHA-256.
    pub(super) fn fingerprint(&self) -> String {
        self.sha256[..8].iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Between the first frame (0) and the last (1).
    pub(super) fn at(&self, t: f64) -> RecordedShot {
        let place = t * (self.frames.len() - 1) as f64;
        // A place that misses a whole number by rounding only means that frame: as many frames out as in are bit-equal.
        let nearest = place.round();
        if (place - nearest).abs() < 1e-9 {
            return self.frames[nearest as usize];
        }
        let before = place.floor();
        let (a, b) = (self.frames[before as usize], self.frames[before as usize + 1]);
        between(a, b, place - before)
    }
}

fn between(a: RecordedShot, b: RecordedShot, t: f64) -> RecordedShot {
    let mix = |a: f64, b: f64| a + (b - a) * t;
    let projection = match (a.projection, b.projection) {
        (
            Projection::Perspective { fov_y: fov_a, near: near_a, far: far_a },
            Projection::Perspective { fov_y: fov_b, near: near_b, far: far_b },
        ) => Projection::Perspective {
            fov_y: mix(fov_a, fov_b),
            near: mix(near_a, near_b),
            far: far_a.zip(far_b).map(|(far_a, far_b)| mix(far_a, far_b)),
        },
        (other, _) => other,
    };
    RecordedShot {
        pose: Pose {
            position: a.pose.position.lerp(b.pose.position, t),
            rotation: a.pose.rotation.slerp(b.pose.rotation, t).normalize(),
        },
        projection,
        seconds: a.seconds.zip(b.seconds).map(|(a, b)| mix(a, b)),
    }
}

/// The frames, or what is wrong and in which frame.
fn parse(bytes: &[u8]) -> Result<Vec<RecordedShot>, String> {
    let value: Value = serde_json::from_slice(bytes).map_err(|error| format!("it is not JSON: {error}"))?;
    match value.get("schema").map(|schema| schema.as_u64()) {
        Some(Some(1)) => {}
        Some(_) => return Err(format!("its schema is {}, but only 1 is known", value["schema"])),
        None => return Err("it is no recorded path: `schema` is missing".into()),
    }
    let frames = value.get("frames").and_then(Value::as_array).ok_or("`frames` is missing or no list")?;
    if frames.is_empty() {
        return Err("`frames` is empty; a path needs at least one frame".into());
    }
    let parsed = frames.iter().enumerate();
    parsed.map(|(index, frame)| parse_frame(frame).map_err(|fault| format!("frame {index}: {fault}"))).collect()
}

fn parse_frame(frame: &Value) -> Result<RecordedShot, String> {
    let position = DVec3::from_array(numbers(frame, "position")?);
    if position.abs().max_element() > FARTHEST_M {
        return Err(format!("`position` is more than {FARTHEST_M:e} m from the origin"));
    }
    let rotation = DQuat::from_array(numbers(frame, "rotation")?);
    let length = rotation.length();
    if !(0.5..=2.0).contains(&length) {
        return Err(format!("`rotation` has length {length}, but a rotation is a quaternion of length 1"));
    }
    let [fov_y_deg] = numbers(frame, "fov_y_deg")?;
    if !(NARROWEST_DEG..180.0).contains(&fov_y_deg) {
        let shown = crate::error::typed_number(fov_y_deg);
        return Err(format!("`fov_y_deg` is {shown}, but must be between {NARROWEST_DEG:e} and 180"));
    }
    let [near] = numbers(frame, "near")?;
    let far = optional(frame, "far")?;
    if near <= 0.0 || far.is_some_and(|far| far <= near) {
        return Err("`near` must be above 0 and `far` above `near`".into());
    }
    if !PLANES_M.contains(&near) || far.is_some_and(|far| !PLANES_M.contains(&far)) {
        return Err(format!("`near` and `far` must be between {:e} and {:e}", PLANES_M.start(), PLANES_M.end()));
    }
    let seconds = optional(frame, "seconds")?;
    if seconds.is_some_and(|seconds| seconds.abs() > LATEST_S) {
        return Err(format!("`seconds` must be between -{LATEST_S:e} and {LATEST_S:e}"));
    }
    // A quaternion that is already of length 1 up to rounding is kept bit for bit.
    let rotation = if (length - 1.0).abs() < 1e-12 { rotation } else { rotation.normalize() };
    Ok(RecordedShot {
        pose: Pose { position, rotation },
        projection: Projection::Perspective { fov_y: fov_y_deg.to_radians(), near, far },
        seconds,
    })
}

fn optional(frame: &Value, key: &str) -> Result<Option<f64>, String> {
    match frame.get(key) {
        None | Some(Value::Null) => Ok(None),
        Some(_) => numbers(frame, key).map(|[number]| Some(number)),
    }
}

/// `COUNT` numbers under a key; a single one may stand without a list. JSON has no numbers that are not finite.
fn numbers<const COUNT: usize>(frame: &Value, key: &str) -> Result<[f64; COUNT], String> {
    let fault = || match COUNT {
        1 => format!("`{key}` must be a number"),
        _ => format!("`{key}` must be a list of {COUNT} numbers"),
    };
    let value = frame.get(key).ok_or_else(fault)?;
    let list = match value {
        Value::Array(list) => list.as_slice(),
        single if COUNT == 1 => std::slice::from_ref(single),
        _ => return Err(fault()),
    };
    let list: Option<Vec<f64>> = list.iter().map(Value::as_f64).collect();
    list.and_then(|list| <[f64; COUNT]>::try_from(list).ok()).ok_or_else(fault)
}
