//! Random models: masks whose alpha equals the cutoff, objects that mirror in the middle of an animation, skins, morph targets, and
//! tracks of every kind. A seed always gives the same model.

use super::model::{Interpolation, Material, Mesh, Model, Node, Skin, Target, Track};
use crate::Random;
use glam::{DAffine3, DQuat, DVec3};
use scenes::{Pose, Projection, Shot};

/// Length of the animations in seconds.
const LENGTH_S: f64 = 2.0;

/// A model of about twenty objects near the origin.
pub fn model(seed: u64) -> Model {
    let mut random = Random::new(seed);
    let mut model = Model::default();
    for _ in 0..14 {
        let parent = (!model.nodes.is_empty() && random.below(3) == 0).then(|| random.below(model.nodes.len()));
        let spread = if parent.is_some() { 1.0 } else { 4.0 };
        let mesh = match random.below(4) {
            0 => morphing(&mut random),
            1 => sheet(&mut random),
            _ => cube(&mut random),
        };
        let targets = mesh.targets.len();
        model.meshes.push(mesh);
        let mesh = Some(model.meshes.len() - 1);
        let place = (spread * random.vector(), random.turn(), any_scale(&mut random));
        let mut node = Node { parent, place, mesh, skin: None, tracks: Vec::new() };
        animate(&mut random, &mut node, targets);
        model.nodes.push(node);
    }
    (0..2).for_each(|_| skinned(&mut random, &mut model));
    model
}

/// Makes views of a model from any side, in perspective or parallel, each at another time.
pub fn shots(seed: u64, count: usize) -> Vec<Shot> {
    let mut random = Random::new(seed ^ 0x5eed);
    let shot = |number: usize| {
        let position = random.vector().normalize_or(DVec3::Z) * random.range(5.0, 9.0);
        let projection = match random.below(3) {
            0 => Projection::Orthographic { half_height: random.range(2.0, 5.0), near: 0.1, far: 30.0 },
            1 => Projection::Perspective { fov_y: random.range(0.4, 1.4), near: 0.1, far: None },
            _ => Projection::Perspective { fov_y: random.range(0.4, 1.4), near: 0.05, far: Some(50.0) },
        };
        let seconds = LENGTH_S * (number as f64 + random.range(0.1, 0.9)) / count as f64;
        Shot { pose: Pose::looking_at(position, random.vector()), projection, seconds }
    };
    (0..count).map(shot).collect()
}

fn any_scale(random: &mut Random) -> DVec3 {
    let factor = |random: &mut Random| random.range(0.4, 1.6) * if random.below(5) == 0 { -1.0 } else { 1.0 };
    DVec3::new(factor(random), factor(random), factor(random))
}

fn track(random: &mut Random, target: Target, value: impl Fn(&mut Random) -> Vec<f32>) -> Track {
    let interpolation = [Interpolation::Step, Interpolation::Linear, Interpolation::Cubic][random.below(3)];
    let keys = 2 + random.below(3);
    let times = (0..keys).map(|key| (LENGTH_S * key as f64 / (keys - 1) as f64) as f32).collect();
    let tangent = |random: &mut Random| value(random).iter().map(|part| 0.3 * part).collect();
    let each = |random: &mut Random| match interpolation {
        Interpolation::Cubic => vec![tangent(random), value(random), tangent(random)],
        _ => vec![value(random)],
    };
    let values = (0..keys).flat_map(|_| each(random)).collect();
    Track { target, interpolation, times, values }
}

fn floats(of: DVec3) -> Vec<f32> {
    of.as_vec3().to_array().to_vec()
}

fn animate(random: &mut Random, node: &mut Node, targets: usize) {
    let around = node.place.0;
    if random.below(3) == 0 {
        node.tracks.push(track(random, Target::Translation, |random| floats(around + 0.7 * random.vector())));
    }
    if random.below(3) == 0 {
        node.tracks.push(track(random, Target::Rotation, |random| random.turn().as_quat().to_array().to_vec()));
    }
    if random.below(2) == 0 {
        node.tracks.push(track(random, Target::Scale, |random| floats(any_scale(random))));
    }
    if targets > 0 {
        let weights = move |random: &mut Random| (0..targets).map(|_| random.range(-0.5, 1.5) as f32).collect();
        node.tracks.push(track(random, Target::Weights, weights));
    }
}

fn material(random: &mut Random) -> Material {
    Material { double_sided: random.below(4) == 0, alpha: 1.0, ..Material::default() }
}

fn cube(random: &mut Random) -> Mesh {
    let corner = |number: u32| [0, 1, 2].map(|axis| if number >> axis & 1 == 0 { -0.5 } else { 0.5 });
    // Counter-clockwise as seen from outside.
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices = faces.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    Mesh { positions: (0..8).map(corner).collect(), indices, material: material(random), ..Mesh::default() }
}

fn morphing(random: &mut Random) -> Mesh {
    let mut mesh = cube(random);
    let displacement = |random: &mut Random| floats(0.5 * random.vector());
    let three = |of: Vec<f32>| [of[0], of[1], of[2]];
    let target = |random: &mut Random| (0..8).map(|_| three(displacement(random))).collect::<Vec<[f32; 3]>>();
    mesh.targets = (0..1 + random.below(8)).map(|_| target(random)).collect();
    mesh
}

/// A square whose alpha equals its cutoff somewhere, or everywhere.
fn sheet(random: &mut Random) -> Mesh {
    let step = [255u8, 128, 90][random.below(3)];
    let cutoff = f32::from(step) / 255.0;
    let mut mesh = Mesh {
        positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
        coordinates: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        material: Material { cutoff: Some(cutoff), ..material(random) },
        ..Mesh::default()
    };
    match random.below(4) {
        0 => mesh.material.alpha = cutoff,
        1 => mesh.alpha = vec![step; 4],
        2 => mesh.alpha = vec![step, 255, step, 20],
        _ => mesh.material.texture = Some((8, (0..64).map(|_| [step, 255, 0][random.below(3)]).collect())),
    }
    mesh
}

/// Adds a strip that three joints in a row carry. Any of them may mirror.
fn skinned(random: &mut Random, model: &mut Model) {
    const ROWS: u32 = 7;
    let parent = (random.below(2) == 0).then(|| random.below(model.nodes.len()));
    let first = model.nodes.len();
    for joint in 0..3 {
        let (parent, place) = match joint {
            0 => (parent, (2.0 * random.vector(), random.turn(), any_scale(random))),
            _ => (Some(first + joint - 1), (DVec3::Y, DQuat::IDENTITY, DVec3::ONE)),
        };
        let mut node = Node { parent, place, mesh: None, skin: None, tracks: Vec::new() };
        animate(random, &mut node, 0);
        model.nodes.push(node);
    }
    let inverse_binds = (0..3).map(|joint| DAffine3::from_translation(DVec3::Y * -f64::from(joint))).collect();
    model.skins.push(Skin { joints: (first..first + 3).collect(), inverse_binds });
    let mut mesh = Mesh { material: material(random), ..Mesh::default() };
    for row in 0..ROWS {
        let up = 2.5 * row as f32 / (ROWS - 1) as f32;
        let (lower, share) = ((up.min(1.99) as u8), up.min(1.99).fract());
        let influence = ([lower, lower + 1, 0, 0], [1.0 - share, share, 0.0, 0.0]);
        mesh.positions.extend([[-0.4, up, 0.0], [0.4, up, 0.1]]);
        mesh.influences.extend([influence; 2]);
        if row > 0 {
            let corner = 2 * row;
            mesh.indices.extend([corner - 2, corner - 1, corner + 1, corner - 2, corner + 1, corner]);
        }
    }
    if random.below(2) == 0 {
        mesh.targets = vec![mesh.positions.iter().map(|_| [0.3 * random.unit() as f32; 3]).collect()];
    }
    let targets = mesh.targets.len();
    model.meshes.push(mesh);
    let place = (9.0 * random.vector(), random.turn(), any_scale(random));
    let (mesh, skin) = (Some(model.meshes.len() - 1), Some(model.skins.len() - 1));
    let mut node = Node { parent: None, place, mesh, skin, tracks: Vec::new() };
    if targets > 0 {
        let weight = |random: &mut Random| vec![random.range(-0.5, 1.5) as f32];
        node.tracks.push(track(random, Target::Weights, weight));
    }
    model.nodes.push(node);
}
