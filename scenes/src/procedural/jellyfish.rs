//! Jellyfish: bells that morph targets squeeze, stretch and dent, among walls that hide them in part. A skeleton bends every third of
//! them too. For tests of deformed meshes.

use super::random::Random;
use super::tentacles::{among_walls, set_in_motion, shares};
use super::{shade, Assembly, SceneOptions};
use crate::animation::{AnimatedNode, Attachment, Interpolation, Local, NodeAnimation, Track};
use crate::gltf::normals;
use crate::model::{Mesh, Scene, Topology};
use crate::morph::{Deformed, Displacement, MorphTarget};
use crate::skin::{weights_of_sum_one, RestVertex, Skin};
use glam::{DAffine3, DQuat, DVec3, Vec3};
use std::f32::consts::TAU;

/// Jellyfish at scale 1; there are half as many walls.
const JELLYFISH: f64 = 180.0;

/// Each has a mesh of its own, of 15 kB with its targets: a larger number would not fit into the memory of many machines.
const MOST_JELLYFISH: usize = 1 << 17;

/// Rings of vertices from the top of a bell to its rim, and vertices of a ring.
const RINGS: usize = 8;
const SIDES: usize = 12;

/// Morph targets of a bell.
const TARGETS: usize = 9;

/// Keys of a motion, and the seconds between them. The last key equals the first.
const KEYS: usize = 9;
const KEY_S: f64 = 2.0;

pub(super) fn make(options: &SceneOptions) -> Scene {
    let count = ((JELLYFISH * options.scale).round() as usize).clamp(8, MOST_JELLYFISH);
    let mut random = Random::new(options.seed, 3);
    let mut assembly = Assembly::new("jellyfish");
    let side = 20.0 * (count as f64 / JELLYFISH).sqrt();
    among_walls(&mut assembly, &mut random, count / 2, side);
    let bell = bell();
    let targets: Vec<Vec<Displacement>> = (0..TARGETS).map(|target| displacements(&bell, target)).collect();
    let (mut nodes, mut attachments, mut weights, mut skinned) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (first_mesh, first_object) = (assembly.scene.meshes.len() as u32, assembly.len());
    for jellyfish in 0..count {
        let mesh = assembly.mesh(bell.clone());
        let object = assembly.len() as u32;
        let colour = random.pick(&[[0.75, 0.45, 0.6], [0.4, 0.6, 0.75], [0.6, 0.5, 0.8], [0.8, 0.7, 0.45]]);
        let colour = shade(&mut random, colour, 0.2);
        assembly.place(mesh, colour, DAffine3::IDENTITY);
        attachments.push(Attachment::new(object, nodes.len()));
        let at = DVec3::new(random.range(-0.6, 0.6) * side, random.range(0.8, 2.2), random.range(-1.2, 0.4) * side);
        nodes.push(body(&mut random, jellyfish, at));
        if jellyfish % 3 == 0 {
            skinned.push((jellyfish, nodes.len() - 1));
            nodes.push(rim(&mut random, nodes.len() - 1));
        }
        weights.extend((0..TARGETS).map(|target| weight(&mut random, jellyfish + target)));
    }
    let animation = NodeAnimation::new(nodes, attachments).expect("parents come before their children");
    let mut scene = assembly.scene;
    scene.skins = skinned.iter().map(|(_, node)| skin(&animation, *node)).collect();
    set_in_motion(&mut scene, animation.with_weights(weights));
    let deformed = |jellyfish: usize| {
        let of_target = |(target, displacements): (usize, &Vec<Displacement>)| MorphTarget {
            weight: (jellyfish * TARGETS + target) as u32,
            displacements: displacements.clone(),
        };
        let skin = skinned.binary_search_by_key(&jellyfish, |(jellyfish, _)| *jellyfish).ok();
        Deformed {
            mesh: first_mesh + jellyfish as u32,
            skin: skin.map(|skin| skin as u32),
            rest: rest(&bell),
            targets: targets.iter().enumerate().map(of_target).collect(),
        }
    };
    debug_assert_eq!(first_object + count, scene.objects.len());
    scene.deform((0..count).map(deformed).collect()).expect("each jellyfish hangs on a node of its own");
    scene.cameras = vec![super::tentacles::camera(side)];
    scene
}

/// A bell around +y, 1 m wide and high, open below: its rim is at y = -0.5.
fn bell() -> Mesh {
    let ring = |ring: usize| {
        let (sin, cos) = (0.62 * TAU * 0.5 * ring as f32 / RINGS as f32).sin_cos();
        (0..SIDES).map(move |side| {
            let angle = side as f32 / SIDES as f32 * TAU;
            Vec3::new(0.5 * sin * angle.cos(), 0.3 + 0.5 * cos - 0.3, -0.5 * sin * angle.sin())
        })
    };
    let mut positions = vec![Vec3::Y * 0.5];
    positions.extend((1..=RINGS).flat_map(ring));
    let corner = |ring: usize, side: usize| (1 + (ring - 1) * SIDES + side % SIDES) as u32;
    let mut indices = Vec::new();
    for side in 0..SIDES {
        indices.extend([0, corner(1, side), corner(1, side + 1)]);
        for ring in 1..RINGS {
            let [a, b] = [corner(ring, side), corner(ring, side + 1)];
            let [c, d] = [corner(ring + 1, side + 1), corner(ring + 1, side)];
            indices.extend([a, d, c, a, c, b]);
        }
    }
    let mut mesh = Mesh { name: "bell".into(), topology: Topology::Triangles, positions, indices, ..Mesh::default() };
    normals::complete(&mut mesh);
    mesh
}

/// Returns the displacement of a vertex by a target. A target squeezes the whole bell, stretches its lower half, curls that to one
/// side, dents one flank, or moves one ring.
fn displaced(target: usize, at: Vec3) -> Vec3 {
    let low = (0.2 - at.y).max(0.0);
    match target {
        0 => Vec3::new(-0.6 * at.x, 0.4 * at.y, -0.6 * at.z),
        1 => Vec3::Y * (-1.5 * low),
        2 => Vec3::new(1.2 * low * low, 0.0, 0.4 * low),
        3 => Vec3::X * (0.8 * at.x.max(0.0)),
        ring => {
            let height = 0.4 - 0.15 * (ring - 4) as f32;
            let near = (1.0 - (at.y - height).abs() / 0.15).max(0.0);
            Vec3::new(at.x, 0.0, at.z) * (0.5 * near)
        }
    }
}

fn displacements(bell: &Mesh, target: usize) -> Vec<Displacement> {
    let moved: Vec<Vec3> = bell.positions.iter().map(|at| displaced(target, *at)).collect();
    let positions = bell.positions.iter().zip(&moved).map(|(at, by)| *at + *by).collect();
    let mut whole = Mesh { positions, normals: Vec::new(), ..bell.clone() };
    normals::complete(&mut whole);
    let turned = whole.normals.iter().zip(&bell.normals).map(|(there, here)| *there - *here);
    let all = moved.into_iter().zip(turned).zip(0..);
    let all = all.map(|((position, normal), vertex)| Displacement { vertex, position, normal });
    all.filter(|displaced| displaced.position != Vec3::ZERO || displaced.normal != Vec3::ZERO).collect()
}

/// Makes the vertices of a bell at rest. The upper part hangs on the body, the rim on its own joint.
fn rest(bell: &Mesh) -> Vec<RestVertex> {
    let vertices = bell.positions.iter().zip(&bell.normals);
    let vertex = vertices.map(|(position, normal)| {
        let rim = ((0.3 - position.y) / 0.6).clamp(0.0, 1.0);
        let weights = weights_of_sum_one(shares([1.0 - rim, rim]));
        RestVertex { position: *position, normal: *normal, joints: shares([0, 1]), weights }
    });
    vertex.collect()
}

/// Makes values for all keys. The last equals the first.
fn round<T: Copy>(random: &mut Random, value: impl Fn(&mut Random) -> T) -> Vec<T> {
    let mut values: Vec<T> = (1..KEYS).map(|_| value(random)).collect();
    values.push(values[0]);
    values
}

fn times() -> Vec<f64> {
    (0..KEYS).map(|key| key as f64 * KEY_S).collect()
}

/// Makes an animated weight, mostly between 0 and 1, at times below or above. Some step, some follow splines that overshoot.
fn weight(random: &mut Random, number: usize) -> Track<f64> {
    let values = round(random, |random| random.range(-0.3, 1.3));
    let (interpolation, values) = match number % 5 {
        0 => (Interpolation::Step, values),
        1 | 2 => {
            let tangents = round(random, |random| random.range(-1.0, 1.0));
            let keys = values.into_iter().zip(tangents).flat_map(|(value, tangent)| [tangent, value, tangent]);
            (Interpolation::CubicSpline, keys.collect())
        }
        _ => (Interpolation::Linear, values),
    };
    Track::new(interpolation, times(), values).expect("a value a key")
}

/// Makes the node of a jellyfish. Every second swims about, every fourth stays in place, the others turn. Every seventh is a mirror
/// image.
fn body(random: &mut Random, jellyfish: usize, at: DVec3) -> AnimatedNode {
    let size = random.range(0.7, 1.6);
    let scale = DVec3::new(if jellyfish % 7 == 4 { -size } else { size }, size, size);
    let swims = round(random, |random| at + DVec3::new(random.range(-1.5, 1.5), 0.3, random.range(-1.5, 1.5)));
    let turns = round(random, |random| DQuat::from_rotation_y(random.range(-1.0, 1.0)));
    let linear = Interpolation::Linear;
    AnimatedNode {
        parent: None,
        world_from_root: DAffine3::IDENTITY,
        local: Local::Parts { translation: at, rotation: DQuat::IDENTITY, scale },
        translation: (jellyfish % 2 == 1).then(|| Track::new(linear, times(), swims).expect("a value a key")),
        rotation: (jellyfish % 4 == 2).then(|| Track::new(linear, times(), turns).expect("a value a key")),
        scale: None,
    }
}

/// Makes the joint at the rim of a jellyfish, which sways below its body.
fn rim(random: &mut Random, body: usize) -> AnimatedNode {
    let sways = round(random, |random| {
        DQuat::from_scaled_axis(DVec3::new(random.range(-0.6, 0.6), random.range(-0.3, 0.3), random.range(-0.6, 0.6)))
    });
    AnimatedNode {
        parent: Some(body),
        world_from_root: DAffine3::IDENTITY,
        local: Local::Parts { translation: DVec3::Y * 0.2, rotation: DQuat::IDENTITY, scale: DVec3::ONE },
        translation: None,
        rotation: Some(Track::new(Interpolation::Linear, times(), sways).expect("a value a key")),
        scale: None,
    }
}

/// The skeleton of a body and its rim.
fn skin(nodes: &NodeAnimation, body: usize) -> Skin {
    let joints = [(body, DAffine3::IDENTITY), (body + 1, DAffine3::from_translation(DVec3::Y * -0.2))];
    Skin::new(nodes, body, &joints).expect("the rim hangs on the body")
}
