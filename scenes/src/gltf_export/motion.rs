//! Animations: the path's camera and the moving objects, one key a frame.

use super::Export;
use crate::animation::Motion;
use crate::camera::{Pose, Projection};
use crate::error::SceneError;
use crate::model::Scene;
use crate::path::{CameraPath, Shot};
use glam::{DAffine3, DQuat, DVec3};
use serde_json::json;
use std::f64::consts::TAU;

/// Keys a second of a path.
const KEYS_A_SECOND: f64 = 30.0;
/// Scene time of a run without a path, in seconds, where motion has no end.
const RUN_S: f64 = 10.0;

/// One key: its time in the file, and the time in the scene.
pub(super) struct Sample {
    time: f32,
    pub(super) seconds: f64,
    shot: Option<Shot>,
}

/// The keys of the path, or of the scene's motion alone. None if there is nothing to animate.
pub(super) fn samples(scene: &Scene, path: Option<&CameraPath>, frames: usize) -> Vec<Sample> {
    if let Some(path) = path {
        return (0..frames.max(1))
            .map(|frame| {
                let shot = path.sample(frame, frames);
                Sample { time: (frame as f64 / KEYS_A_SECOND) as f32, seconds: shot.seconds, shot: Some(shot) }
            })
            .collect();
    }
    let (first, last) = match &scene.motion {
        Motion::Still => return Vec::new(),
        Motion::Orbits(_) => (0.0, RUN_S),
        nodes => nodes.duration_s(),
    };
    let frames = frames.max(2);
    let at = |frame: usize| first + (last - first) * frame as f64 / (frames - 1) as f64;
    (0..frames).map(|frame| Sample { time: at(frame) as f32, seconds: at(frame), shot: None }).collect()
}

impl Export {
    /// The path as an animated camera.
    pub(super) fn path_camera(&mut self, path: &CameraPath, samples: &[Sample]) -> Result<(), SceneError> {
        let shots: Vec<&Shot> = samples.iter().filter_map(|sample| sample.shot.as_ref()).collect();
        let Some(first) = shots.first() else { return Ok(()) };
        let name = format!("path {}", path.name());
        let lens = widest(&shots).unwrap_or(first.projection);
        let node = self.camera(&name, &lens, json!({ "name": name }))?;
        let poses = shots.iter().map(|shot| shot.pose).collect();
        let times = self.times(samples);
        self.rigid(node, times, poses);
        Ok(())
    }

    /// Every moving object's keys.
    pub(super) fn object_motion(&mut self, scene: &Scene, samples: &[Sample]) {
        if samples.is_empty() || matches!(scene.motion, Motion::Still) {
            return;
        }
        let times = self.times(samples);
        if let Motion::Orbits(orbits) = &scene.motion {
            for orbit in orbits {
                let pose = |sample: &Sample| {
                    // The object's own matrix stays on its node; this node carries it about, rigidly, so nothing is lost.
                    let angle = (orbit.radians_per_s * sample.seconds) % TAU;
                    let turn =
                        orbit.axis.try_normalize().map_or(DQuat::IDENTITY, |axis| DQuat::from_axis_angle(axis, angle));
                    let place = orbit.world_from_object(sample.seconds).translation;
                    Pose { position: place - turn * orbit.base.translation, rotation: turn }
                };
                let poses = samples.iter().map(pose).collect();
                let carrier = self.carrier(orbit.object as usize);
                self.nodes[orbit.object as usize]["matrix"] = super::matrix(&orbit.base);
                self.rigid(carrier, times, poses);
            }
            return;
        }
        let mut keys: Vec<Vec<DAffine3>> = vec![Vec::new(); scene.objects.len()];
        let mut transforms = Vec::new();
        for sample in samples {
            scene.motion.transforms_at(sample.seconds, &mut transforms);
            transforms.iter().for_each(|&(object, transform)| keys[object as usize].push(transform));
        }
        // Joints say where bent objects are.
        scene.skinned.iter().for_each(|skinned| keys[skinned.object as usize].clear());
        for (object, keys) in keys.iter().enumerate().filter(|(_, keys)| keys.len() == samples.len()) {
            self.parts(object, times, keys);
        }
    }

    /// A new node above an object's.
    fn carrier(&mut self, object: usize) -> usize {
        let carrier = self.nodes.len();
        self.nodes.push(json!({ "children": [object] }));
        // Roots start with the objects' nodes, in order.
        self.roots[object] = carrier;
        carrier
    }

    pub(super) fn times(&mut self, samples: &[Sample]) -> usize {
        let times: Vec<f32> = samples.iter().map(|sample| sample.time).collect();
        self.binary.times(&times)
    }

    fn rigid(&mut self, node: usize, times: usize, poses: Vec<Pose>) {
        let translations = self.binary.vectors("VEC3", poses.iter().map(|pose| pose.position.as_vec3().to_array()));
        let rotations = self.binary.vectors("VEC4", poses.iter().map(|pose| pose.rotation.as_quat().to_array()));
        self.channel(node, "translation", times, translations);
        self.channel(node, "rotation", times, rotations);
    }

    /// Keys of translation, rotation and scale in place of a node's matrix. One that is flat at some key cannot be
    /// taken apart; it stays where it is at time 0.
    pub(super) fn parts(&mut self, object: usize, times: usize, keys: &[DAffine3]) {
        let parts: Vec<(DVec3, DQuat, DVec3)> = keys.iter().map(DAffine3::to_scale_rotation_translation).collect();
        if !parts.iter().all(|(scale, rotation, _)| scale.is_finite() && rotation.is_finite()) {
            return;
        }
        if let Some(node) = self.nodes[object].as_object_mut() {
            node.remove("matrix");
        }
        let poses = parts.iter().map(|&(_, rotation, position)| Pose { position, rotation }).collect();
        self.rigid(object, times, poses);
        let scales = self.binary.vectors("VEC3", parts.iter().map(|(scale, _, _)| scale.as_vec3().to_array()));
        self.channel(object, "scale", times, scales);
    }

    fn channel(&mut self, node: usize, property: &str, input: usize, output: usize) {
        self.channels.push(json!({ "sampler": self.samplers.len(), "target": { "node": node, "path": property } }));
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
    }
}

/// The first shot's lens, with the farthest far plane of all: a path may need more of it later.
fn widest(shots: &[&Shot]) -> Option<Projection> {
    let first = shots.first()?.projection;
    let farthest = |far: f64| {
        shots.iter().fold(far, |farthest, shot| match shot.projection {
            Projection::Perspective { far: Some(far), .. } | Projection::Orthographic { far, .. } => farthest.max(far),
            _ => farthest,
        })
    };
    Some(match first {
        Projection::Perspective { fov_y, near, far } => Projection::Perspective { fov_y, near, far: far.map(farthest) },
        Projection::Orthographic { half_height, near, far } => {
            Projection::Orthographic { half_height, near, far: farthest(far) }
        }
        other => other,
    })
}
