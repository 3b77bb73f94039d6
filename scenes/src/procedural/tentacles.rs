//! Tentacles: columns that skeletons bend, swaying among walls that hide them in part, for tests of what bends.

use super::parts::Parts;
use super::random::Random;
use super::{shade, sized, Assembly, SceneOptions};
use crate::animation::{AnimatedNode, Attachment, Interpolation, Local, Motion, NodeAnimation, Track};
use crate::camera::{Camera, Pose, Projection};
use crate::model::{Mesh, Scene, Topology};
use crate::morph::Deformed;
use crate::skin::{weights_of_sum_one, RestVertex, Skin, JOINTS_A_VERTEX};
use glam::{DAffine3, DQuat, DVec3, Vec3};
use std::f32::consts::TAU;

/// Tentacles at scale 1; there are half as many walls.
const TENTACLES: f64 = 240.0;

/// Each has a mesh of its own, of 15 kB: more than this is more than many a machine has memory for, and devices have room for.
const MOST_TENTACLES: usize = 1 << 17;

/// Joints of a tentacle, one above the other.
const JOINTS: usize = 5;

/// Metres from joint to joint, and from the last one to the tip.
const BONE: f64 = 0.6;

/// Rings of vertices a bone.
const RINGS: usize = 3;

/// Vertices of a ring.
const SIDES: usize = 12;

/// Keys of a motion, each so many seconds after the one before. The last is the first.
const KEYS: usize = 17;
const KEY_S: f64 = 1.0;

pub(super) fn make(options: &SceneOptions) -> Scene {
    let count = ((TENTACLES * options.scale).round() as usize).clamp(8, MOST_TENTACLES);
    let mut random = Random::new(options.seed, 2);
    let mut assembly = Assembly::new("tentacles");
    let side = 20.0 * (count as f64 / TENTACLES).sqrt();
    among_walls(&mut assembly, &mut random, count / 2, side);
    let rest = rest();
    let (mut nodes, mut attachments) = (Vec::new(), Vec::new());
    for tentacle in 0..count {
        let mesh = assembly.mesh(mesh(&rest));
        let object = assembly.len() as u32;
        let colour = random.pick(&[[0.7, 0.3, 0.45], [0.35, 0.6, 0.5], [0.45, 0.4, 0.7], [0.75, 0.65, 0.3]]);
        let colour = shade(&mut random, colour, 0.2);
        assembly.place(mesh, colour, DAffine3::IDENTITY);
        attachments.push(Attachment::new(object, nodes.len()));
        let at = somewhere(&mut random, side);
        skeleton(&mut random, tentacle, at, &mut nodes);
    }
    let mut scene = assembly.scene;
    let first = scene.objects.len() - count;
    let animation = NodeAnimation::new(nodes, attachments).expect("parents come before their children");
    let skins = (0..count).map(|tentacle| skin(&animation, tentacle * JOINTS));
    scene.skins = skins.collect();
    set_in_motion(&mut scene, animation);
    let deformed = |tentacle: usize| Deformed {
        mesh: scene.objects[first + tentacle].mesh,
        skin: Some(tentacle as u32),
        rest: rest.clone(),
        targets: Vec::new(),
    };
    scene.deform((0..count).map(deformed).collect()).expect("each tentacle hangs on its own lowest joint");
    scene.cameras = vec![camera(side)];
    scene
}

/// A place on a ground of this size.
fn somewhere(random: &mut Random, side: f64) -> DVec3 {
    DVec3::new(random.range(-0.6, 0.6), 0.0, random.range(-1.2, 0.4)) * side
}

/// The ground, and walls on it.
pub(super) fn among_walls(assembly: &mut Assembly, random: &mut Random, walls: usize, side: f64) {
    let cube = assembly.built("wall", Default::default(), |parts: &mut Parts| parts.cuboid([-0.5; 3], [0.5; 3]));
    let ground = sized(DVec3::new(0.0, -0.5, 0.0), DVec3::new(8.0 * side, 1.0, 8.0 * side));
    assembly.place(cube, [0.4, 0.42, 0.4], ground);
    for _ in 0..walls {
        let size = DVec3::new(random.range(2.0, 4.5), random.range(1.5, 3.0), 0.3);
        let at = somewhere(random, side) + DVec3::Y * 0.5 * size.y;
        let place = DAffine3 { matrix3: super::quarter_turns(random.below(4) as i32), translation: at }
            * DAffine3::from_scale(size);
        let colour = shade(random, [0.65, 0.5, 0.4], 0.2);
        assembly.place(cube, colour, place);
    }
}

/// Sets a scene in motion. Its objects take their places of time 0.
pub(super) fn set_in_motion(scene: &mut Scene, animation: NodeAnimation) {
    scene.motion = Motion::Nodes(animation);
    let mut transforms = Vec::new();
    scene.motion.transforms_at(0.0, &mut transforms);
    for (object, transform) in transforms {
        let object = &mut scene.objects[object as usize];
        (object.world_from_object, object.dynamic) = (transform, true);
    }
}

/// A camera in front of the walls.
pub(super) fn camera(side: f64) -> Camera {
    let eye = DVec3::new(0.1 * side, 1.7, 0.75 * side);
    Camera {
        name: "front".into(),
        pose: Pose::looking_at(eye, DVec3::new(0.0, 1.2, 0.0)),
        projection: Projection::Perspective { fov_y: 60f64.to_radians(), near: 0.1, far: Some(20.0 * side) },
        aspect: None,
        node: None,
    }
}

/// A column around +y, thinner towards its tip. Each ring is carried by the joint below it and the one above, by how far it is from them.
fn rest() -> Vec<RestVertex> {
    let rings = JOINTS * RINGS;
    let ring = |ring: usize| {
        let along = ring as f32 / RINGS as f32;
        let radius = 0.28 - 0.22 * ring as f32 / rings as f32;
        let (lower, upper) = ((along as usize).min(JOINTS - 1), (along as usize + 1).min(JOINTS - 1));
        // Fully the lower joint's in the middle of its bone: what bends is the half of a bone on either side of a joint.
        let part = along.fract();
        let weights = match ring == rings || lower == upper {
            true => shares([1.0, 0.0]),
            false => weights_of_sum_one(shares([1.0 - 0.5 * part, 0.5 * part])),
        };
        (0..SIDES).map(move |side| {
            let angle = side as f32 / SIDES as f32 * TAU;
            let normal = Vec3::new(angle.cos(), 0.0, -angle.sin());
            let position = normal * radius + Vec3::Y * (along * BONE as f32);
            RestVertex { position, normal, joints: shares([lower as u32, upper as u32]), weights }
        })
    };
    let mut vertices: Vec<RestVertex> = (0..=rings).flat_map(ring).collect();
    let tip = vertices[vertices.len() - 1];
    vertices.push(RestVertex { position: Vec3::Y * (tip.position.y + 0.1), normal: Vec3::Y, ..tip });
    vertices
}

/// The joints of a vertex, or their weights, of which two are used.
pub(super) fn shares<T: Copy + Default>([lower, upper]: [T; 2]) -> [T; JOINTS_A_VERTEX] {
    let mut all = [T::default(); JOINTS_A_VERTEX];
    (all[0], all[1]) = (lower, upper);
    all
}

/// The mesh of these vertices.
fn mesh(rest: &[RestVertex]) -> Mesh {
    let corner = |ring: usize, side: usize| (ring * SIDES + side % SIDES) as u32;
    let rings = (rest.len() - 1) / SIDES;
    let mut indices = Vec::new();
    for side in 0..SIDES {
        for ring in 0..rings - 1 {
            let [a, b] = [corner(ring, side), corner(ring, side + 1)];
            let [c, d] = [corner(ring + 1, side + 1), corner(ring + 1, side)];
            indices.extend([a, b, c, a, c, d]);
        }
        indices.extend([corner(rings - 1, side), corner(rings - 1, side + 1), rest.len() as u32 - 1]);
    }
    Mesh {
        name: "tentacle".into(),
        topology: Topology::Triangles,
        positions: rest.iter().map(|vertex| vertex.position).collect(),
        normals: rest.iter().map(|vertex| vertex.normal).collect(),
        indices,
        ..Mesh::default()
    }
}

/// Adds the joints of a tentacle, the lowest first: each sways about an axis of its own. Each fifth goes somewhere too; each sixth shrinks
/// and grows; each seventh stops again and again; each ninth is a mirror image.
fn skeleton(random: &mut Random, tentacle: usize, at: DVec3, nodes: &mut Vec<AnimatedNode>) {
    let times: Vec<f64> = (0..KEYS).map(|key| key as f64 * KEY_S).collect();
    let interpolation = if tentacle % 7 == 3 { Interpolation::Step } else { Interpolation::Linear };
    let size = random.range(0.6, 1.4);
    let scale = if tentacle % 9 == 5 { DVec3::new(-size, size, size) } else { DVec3::splat(size) };
    let round = |random: &mut Random, value: &dyn Fn(&mut Random) -> DVec3| {
        let mut values: Vec<DVec3> = (1..KEYS).map(|_| value(random)).collect();
        values.push(values[0]);
        values
    };
    for joint in 0..JOINTS {
        let most = if joint == 0 { 0.25 } else { 0.7 };
        let sways = round(random, &|random| {
            DVec3::new(random.range(-most, most), random.range(-0.3, 0.3), random.range(-most, most))
        });
        let turns = sways.into_iter().map(DQuat::from_scaled_axis).collect();
        let place = if joint == 0 { at } else { DVec3::Y * BONE };
        let goes = (joint == 0 && tentacle % 5 == 2)
            .then(|| round(random, &|random| at + DVec3::new(random.range(-1.5, 1.5), 0.0, random.range(-1.5, 1.5))));
        let grows = (joint == 2 && tentacle % 6 == 1).then(|| {
            round(random, &|random| DVec3::new(random.range(0.4, 1.6), random.range(0.6, 1.3), random.range(0.4, 1.6)))
        });
        let track = |values| Track::new(Interpolation::Linear, times.clone(), values).expect("a value a key");
        nodes.push(AnimatedNode {
            parent: (joint > 0).then(|| nodes.len() - 1),
            world_from_root: DAffine3::IDENTITY,
            local: Local::Parts {
                translation: place,
                rotation: DQuat::IDENTITY,
                scale: if joint == 0 { scale } else { DVec3::ONE },
            },
            translation: goes.map(track),
            rotation: Some(Track::new(interpolation, times.clone(), turns).expect("a value a key")),
            scale: grows.map(track),
        });
    }
}

/// The skeleton whose lowest joint is a node. The column was bound to it upright.
fn skin(nodes: &NodeAnimation, lowest: usize) -> Skin {
    let joint = |joint: usize| (lowest + joint, DAffine3::from_translation(-DVec3::Y * (joint as f64 * BONE)));
    let joints: Vec<(usize, DAffine3)> = (0..JOINTS).map(joint).collect();
    Skin::new(nodes, lowest, &joints).expect("each joint hangs on the one below")
}
