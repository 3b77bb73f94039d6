//! Animations: the path's camera and the moving objects, one key a frame.

use super::Export;
use crate::animation::{AnimatedNode, Local, Motion, NodeAnimation, Orbit, Track};
use crate::camera::{Pose, Projection};
use crate::error::SceneError;
use crate::model::Scene;
use crate::path::{CameraPath, Shot};
use crate::skin::Skin;
use glam::{DAffine3, DQuat, DVec3};
use serde_json::{json, Value};
use std::collections::{BTreeSet, HashMap, HashSet};
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

/// The nodes of the file that hold the scene's animation. The tree of animated nodes may stand at several places.
#[derive(Default)]
pub(super) struct Trees(HashMap<PlaceKey, HashMap<usize, usize>>);

/// The bits of a place's matrix.
type PlaceKey = [u64; 12];

fn key(place: &DAffine3) -> PlaceKey {
    // -0 becomes 0: equal places have equal bits.
    place.to_cols_array().map(|number| (number + 0.0).to_bits())
}

impl Trees {
    /// Returns the file's node of a node of the animation, in the tree at a place; none if it was not written there.
    pub(super) fn at(&self, world_from_tree: &DAffine3, node: usize) -> Option<usize> {
        self.0.get(&key(world_from_tree))?.get(&node).copied()
    }
}

/// The animated nodes that the file needs at each place, in the order in which places are first needed.
#[derive(Default)]
struct Needed {
    places: Vec<(DAffine3, BTreeSet<usize>)>,
    index: HashMap<PlaceKey, usize>,
}

impl Needed {
    /// Adds a node and all above it.
    fn add(&mut self, nodes: &NodeAnimation, world_from_tree: &DAffine3, node: usize) {
        let at = *self.index.entry(key(world_from_tree)).or_insert(self.places.len());
        if at == self.places.len() {
            self.places.push((*world_from_tree, BTreeSet::new()));
        }
        let needed = &mut self.places[at].1;
        let mut next = Some(node);
        while let Some(node) = next.filter(|node| needed.insert(*node)) {
            next = nodes.nodes()[node].parent;
        }
    }
}

/// Returns the skins of the file, with the place of each skeleton: the scene's skins, then one for each instance that stands elsewhere.
pub(super) fn placed_skins<'a>(
    scene: &'a Scene,
    placed: &'a [(u32, DAffine3)],
) -> impl Iterator<Item = (&'a Skin, DAffine3)> + 'a {
    let placed = placed.iter().map(|(skin, place)| (&scene.skins[*skin as usize], *place));
    scene.skins.iter().map(|skin| (skin, DAffine3::IDENTITY)).chain(placed)
}

impl Export {
    /// The path as an animated camera.
    pub(super) fn path_camera(&mut self, path: &CameraPath, samples: &[Sample]) -> Result<(), SceneError> {
        let shots: Vec<&Shot> = samples.iter().filter_map(|sample| sample.shot.as_ref()).collect();
        let Some(first) = shots.first() else { return Ok(()) };
        let name = format!("path {}", path.name());
        let lens = widest(&shots).unwrap_or(first.projection);
        let node = self.camera(&name, &lens, path.aspect(), json!({ "name": name }))?;
        let poses = shots.iter().map(|shot| shot.pose).collect();
        let times = self.times(samples);
        self.rigid(node, times, poses);
        Ok(())
    }

    /// Writes the motion of objects. Returns the file's node of each node of the scene's animation.
    pub(super) fn object_motion(&mut self, scene: &Scene, samples: &[Sample]) -> Trees {
        match &scene.motion {
            Motion::Still => Trees::default(),
            Motion::Orbits(orbits) => {
                self.orbits(orbits, samples);
                Trees::default()
            }
            Motion::Nodes(nodes) => self.animated_nodes(scene, nodes, samples),
        }
    }

    fn orbits(&mut self, orbits: &[Orbit], samples: &[Sample]) {
        let times = self.times(samples);
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
    }

    /// Writes the tree of animated nodes as it is, once for each place at which it stands. Only nodes that joints or objects need are
    /// written, and all above them. glTF can store a node's own translation, rotation and scale as keys. It could not store the node's
    /// place in the world where a parent's scale or matrix shears it.
    fn animated_nodes(&mut self, scene: &Scene, nodes: &NodeAnimation, samples: &[Sample]) -> Trees {
        // The joints of a skinned object give its place.
        let is_bent = |object: u32| {
            let deformed = scene.deformation_of(scene.objects[object as usize].mesh);
            deformed.is_some_and(|deformed| deformed.skin.is_some())
        };
        let mut needed = Needed::default();
        for (skin, place) in placed_skins(scene, &self.placed_skins) {
            skin.joints().iter().for_each(|joint| needed.add(nodes, &place, joint.node));
        }
        for attachment in nodes.objects().iter().filter(|attachment| !is_bent(attachment.object)) {
            needed.add(nodes, &attachment.world_from_tree, attachment.node);
        }
        let times = self.times(samples);
        let mut written = Trees::default();
        for (world_from_tree, some) in &needed.places {
            let tree = self.tree(nodes, (world_from_tree, some), (times, samples));
            written.0.insert(key(world_from_tree), tree);
        }
        let mut hung = HashSet::new();
        for attachment in nodes.objects().iter().filter(|attachment| !is_bent(attachment.object)) {
            let object = attachment.object as usize;
            if let Some(node) = self.nodes[object].as_object_mut() {
                node.remove("matrix");
            }
            if attachment.node_from_object != DAffine3::IDENTITY {
                self.nodes[object]["matrix"] = super::matrix(&attachment.node_from_object);
            }
            if let Some(parent) = written.at(&attachment.world_from_tree, attachment.node) {
                self.hang(object, parent);
                hung.insert(object);
            }
        }
        self.roots.retain(|root| !hung.contains(root));
        written
    }

    /// Writes some nodes of the tree at one place; parents are among them. Returns the file's node of each.
    fn tree(
        &mut self,
        nodes: &NodeAnimation,
        (world_from_tree, some): (&DAffine3, &BTreeSet<usize>),
        (times, samples): (usize, &[Sample]),
    ) -> HashMap<usize, usize> {
        let mut written: HashMap<usize, usize> = HashMap::with_capacity(some.len());
        // Parents come before their children.
        for &index in some {
            let animated = &nodes.nodes()[index];
            let node = self.nodes.len();
            self.nodes.push(at_rest(animated));
            let world_from_root = *world_from_tree * animated.world_from_root;
            match animated.parent.and_then(|parent| written.get(&parent)) {
                Some(&parent) => self.hang(node, parent),
                None if world_from_root == DAffine3::IDENTITY => self.roots.push(node),
                None => {
                    self.roots.push(self.nodes.len());
                    self.nodes.push(json!({ "matrix": super::matrix(&world_from_root), "children": [node] }));
                }
            }
            self.keys(node, animated, times, samples);
            written.insert(index, node);
        }
        written
    }

    fn hang(&mut self, node: usize, parent: usize) {
        match self.nodes[parent]["children"].as_array_mut() {
            Some(children) => children.push(node.into()),
            None => self.nodes[parent]["children"] = json!([node]),
        }
    }

    /// Writes the keys of a node's tracks.
    fn keys(&mut self, node: usize, animated: &AnimatedNode, times: usize, samples: &[Sample]) {
        if let Local::Matrix(_) = animated.local {
            return;
        }
        let vectors = |track: &Track<DVec3>| -> Vec<[f32; 3]> {
            samples.iter().map(|sample| track.at(sample.seconds).as_vec3().to_array()).collect()
        };
        if let Some(track) = &animated.translation {
            let values = self.binary.vectors("VEC3", vectors(track).into_iter());
            self.channel(node, "translation", times, values);
        }
        if let Some(track) = &animated.rotation {
            let values = samples.iter().map(|sample| unit(track.at(sample.seconds)));
            let values = self.binary.vectors("VEC4", values);
            self.channel(node, "rotation", times, values);
        }
        if let Some(track) = &animated.scale {
            let values = self.binary.vectors("VEC3", vectors(track).into_iter());
            self.channel(node, "scale", times, values);
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
        let rotations = self.binary.vectors("VEC4", poses.iter().map(|pose| unit(pose.rotation)));
        self.channel(node, "translation", times, translations);
        self.channel(node, "rotation", times, rotations);
    }

    pub(super) fn channel(&mut self, node: usize, property: &str, input: usize, output: usize) {
        self.channels.push(json!({ "sampler": self.samplers.len(), "target": { "node": node, "path": property } }));
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
    }
}

/// A rotation of unit length in `f32`, as glTF wants it.
fn unit(rotation: DQuat) -> [f32; 4] {
    rotation.normalize().as_quat().to_array()
}

/// Writes a node at its place of time 0.
fn at_rest(node: &AnimatedNode) -> Value {
    match node.local {
        Local::Matrix(matrix) => json!({ "matrix": super::matrix(&matrix) }),
        Local::Parts { translation, rotation, scale } => {
            let vector =
                |track: &Option<Track<DVec3>>, still: DVec3| track.as_ref().map_or(still, |track| track.at(0.0));
            json!({
                "translation": vector(&node.translation, translation).to_array(),
                "rotation": node.rotation.as_ref().map_or(rotation, |track| track.at(0.0)).to_array(),
                "scale": vector(&node.scale, scale).to_array(),
            })
        }
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
