//! Bounds of deformed meshes hold every vertex, where the GPU puts it, at every time, in each of the four ways of `--bounds`.

mod morphed;
#[path = "../moving_support/mod.rs"]
mod moving_support;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use moving_support::{gpu_vertex, node, object, points, times, vector};
use proptest::prelude::*;
use scenes::animation::{AnimatedNode, Attachment, Interpolation, Local, NodeAnimation, Track};
use scenes::{
    weights_of_sum_one, Aabb, Deformed, Mesh, MorphTarget, Motion, MovingBounds, MovingBoxes, RestVertex, Scene,
    Shapes, Skin, WorldBounds, JOINTS_A_VERTEX,
};
use std::path::Path;

/// Computes vertices like `world/skin_vertices`: displaced by morph targets in order, then bent by joints in order.
fn gpu_shape(deformed: &Deformed, shapes: &Shapes) -> Vec<Vec3> {
    let mut positions: Vec<Vec3> = deformed.rest.iter().map(|vertex| vertex.position).collect();
    for target in &deformed.targets {
        let weight = shapes.weights[target.weight as usize] as f32;
        target
            .displacements
            .iter()
            .for_each(|displaced| positions[displaced.vertex as usize] += displaced.position * weight);
    }
    let Some(skin) = deformed.skin else { return positions };
    let places = shapes.joints.of(skin);
    for (position, vertex) in positions.iter_mut().zip(&deformed.rest) {
        let mut columns = [Vec3::ZERO; 4];
        for (joint, weight) in vertex.influences() {
            let place = &places[joint as usize];
            let linear = place.matrix3.as_mat3();
            let of_joint = [linear.x_axis, linear.y_axis, linear.z_axis, place.translation.as_vec3()];
            columns.iter_mut().zip(of_joint).for_each(|(sum, column)| *sum += column * weight);
        }
        let [x, y, z, shift] = columns;
        *position = x * position.x + y * position.y + z * position.z + shift;
    }
    positions
}

/// Makes the joints or the weights of a vertex. All others are 0.
fn shares<T: Copy + Default, const COUNT: usize>(first: [T; COUNT]) -> [T; JOINTS_A_VERTEX] {
    std::array::from_fn(|at| first.get(at).copied().unwrap_or_default())
}

/// Every vertex that is outside of its box at one of these times, and of the box that its mesh declares for all times.
fn outside(scene: &Scene, mode: MovingBounds, times: &[f64]) -> Vec<String> {
    let bounds = WorldBounds::new(scene);
    let boxes = MovingBoxes::new(scene, &bounds, mode);
    let (mut transforms, mut faults) = (Vec::new(), Vec::new());
    for seconds in times {
        scene.motion.transforms_at(*seconds, &mut transforms);
        let shapes = scene.shapes_at(*seconds);
        for (moving, (object, transform)) in transforms.iter().enumerate() {
            let (transform, object) = (*transform, &scene.objects[*object as usize]);
            let Some(deformed) = scene.deformation_of(object.mesh) else { continue };
            let box_ = boxes.at(moving, *seconds, &bounds, (object.mesh, &transform), &shapes);
            let always = bounds.of(object.mesh, &transform);
            let farthest = boxes.farthest(moving).unwrap_or(f64::INFINITY);
            if transform.translation.abs().max_element() > farthest {
                faults.push(format!("{mode:?}, {}, at {seconds}: its origin is beyond {farthest}", object.name));
            }
            for vertex in gpu_shape(deformed, &shapes) {
                let vertex = gpu_vertex(&transform, vertex);
                for (what, box_) in [("its box", box_), ("the box for all times", always)] {
                    if !box_.contains(vertex) {
                        faults.push(format!(
                            "{mode:?}, {}, at {seconds}: {vertex} is outside of {what}, {box_:?}",
                            object.name
                        ));
                    }
                }
            }
        }
    }
    faults
}

/// An object that a skeleton of all these nodes bends, the first of which is the anchor.
fn skinned(nodes: Vec<AnimatedNode>, inverse_binds: &[DAffine3], rest: Vec<RestVertex>) -> Scene {
    deformed(nodes, (inverse_binds, DAffine3::IDENTITY), rest, (Vec::new(), Vec::new()))
}

/// Makes an object of these vertices and morph targets, on the first of these nodes. If there are inverse bind matrices, a skeleton of
/// all nodes bends it. The object is an instance with a matrix of its own.
fn deformed(
    nodes: Vec<AnimatedNode>,
    (inverse_binds, instance): (&[DAffine3], DAffine3),
    rest: Vec<RestVertex>,
    (weights, targets): (Vec<Track<f64>>, Vec<MorphTarget>),
) -> Scene {
    let on = match inverse_binds.is_empty() {
        true => Attachment { node_from_object: instance, ..Attachment::new(0, 0) },
        false => Attachment { world_from_tree: instance, ..Attachment::new(0, 0) },
    };
    let count = if inverse_binds.is_empty() { 0 } else { nodes.len() };
    let animation = NodeAnimation::new(nodes, vec![on]).expect("a legal animation").with_weights(weights);
    let joints: Vec<(usize, DAffine3)> =
        (0..count).map(|node| (node, inverse_binds[node % inverse_binds.len()])).collect();
    let skins = match joints.is_empty() {
        true => Vec::new(),
        false => vec![Skin::new(&animation, 0, &joints).expect("a legal skin")],
    };
    let skin = (!skins.is_empty()).then_some(0);
    let positions: Vec<Vec3> = rest.iter().map(|vertex| vertex.position).collect();
    let mut scene = Scene {
        meshes: vec![Mesh { normals: vec![Vec3::Z; positions.len()], positions, ..Mesh::default() }],
        motion: Motion::Nodes(animation),
        skins,
        ..Scene::default()
    };
    let mut transforms = Vec::new();
    scene.motion.transforms_at(0.0, &mut transforms);
    scene.objects = vec![object("body", 0, transforms[0].1)];
    scene.deform(vec![Deformed { mesh: 0, skin, rest, targets }]).expect("it can be deformed");
    scene
}

fn affine() -> impl Strategy<Value = DAffine3> {
    let far = prop_oneof![vector(2.0), vector(1e5)];
    (prop::array::uniform9(-1.5..1.5f64), far)
        .prop_map(|(columns, at)| DAffine3 { matrix3: DMat3::from_cols_array(&columns), translation: at })
}

/// Joints and weights.
type Choice = ([u32; JOINTS_A_VERTEX], [f32; JOINTS_A_VERTEX]);

/// Vertices on up to eight joints each, some of them on one alone.
fn rest(points: Vec<Vec3>, choices: &[Choice], joints: usize) -> Vec<RestVertex> {
    let vertex = |(position, (on, weights)): (Vec3, &Choice)| RestVertex {
        position,
        normal: Vec3::Z,
        joints: on.map(|joint| joint % joints as u32),
        weights: weights_of_sum_one(*weights),
    };
    points.into_iter().zip(choices.iter().cycle()).map(vertex).collect()
}

/// A tree: each node hangs on one before it.
fn skeleton() -> impl Strategy<Value = (Vec<AnimatedNode>, Vec<f64>)> {
    prop::collection::vec((node(), any::<prop::sample::Index>()), 1..6).prop_map(|nodes| {
        let mut keys = Vec::new();
        let hang = |(index, ((node, _), parent)): (usize, ((AnimatedNode, bool), prop::sample::Index))| {
            let ends = [
                node.translation.as_ref().map(Track::duration_s),
                node.rotation.as_ref().map(Track::duration_s),
                node.scale.as_ref().map(Track::duration_s),
            ];
            keys.extend(ends.into_iter().flatten().flat_map(|(first, last)| [first, last]));
            AnimatedNode { parent: (index > 0).then(|| parent.index(index)), ..node }
        };
        let nodes = nodes.into_iter().enumerate().map(hang).collect();
        (nodes, keys)
    })
}

fn choices() -> impl Strategy<Value = Vec<Choice>> {
    let weight = prop_oneof![0.0..1.0f32, Just(0.0f32), Just(1.0f32)];
    prop::collection::vec((prop::array::uniform8(0..6u32), prop::array::uniform8(weight)), 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn what_a_skeleton_bends_stays_in_its_box(
        (nodes, keys) in skeleton(), inverse_binds in prop::collection::vec(affine(), 1..4), points in points(), choices in choices(),
        by_chance in prop::collection::vec(0.0..1.0f64, 30),
    ) {
        let joints = nodes.len();
        let scene = skinned(nodes, &inverse_binds, rest(points, &choices, joints));
        for mode in MovingBounds::ALL {
            let faults = outside(&scene, mode, &times(&keys, &by_chance));
            prop_assert!(faults.is_empty(), "{}", faults.join("\n"));
        }
    }
}

/// An arm of two bones along x, the second of which bends by a third of a turn in two seconds.
fn arm() -> Scene {
    let node = |parent: Option<usize>, at: f64, turns: Vec<DQuat>| AnimatedNode {
        parent,
        world_from_root: DAffine3::IDENTITY,
        local: Local::Parts { translation: DVec3::X * at, rotation: DQuat::IDENTITY, scale: DVec3::ONE },
        translation: None,
        rotation: (!turns.is_empty())
            .then(|| Track::new(Interpolation::Linear, vec![0.0, 2.0], turns).expect("a legal track")),
        scale: None,
    };
    let bend = vec![DQuat::IDENTITY, DQuat::from_rotation_z(std::f64::consts::TAU / 3.0)];
    let vertices = [(0.0, [1.0, 0.0]), (1.0, [0.5, 0.5]), (2.0, [0.0, 1.0])];
    let rest = vertices.map(|(x, [upper, lower])| RestVertex {
        position: Vec3::X * x,
        normal: Vec3::Z,
        joints: shares([0, 1]),
        weights: shares([upper, lower]),
    });
    let inverse_binds = [DAffine3::IDENTITY, DAffine3::from_translation(-DVec3::X)];
    skinned(vec![node(None, 0.0, Vec::new()), node(Some(0), 1.0, bend)], &inverse_binds, rest.to_vec())
}

/// What this is against: the box of the mesh at rest, moved with its object as that of any other; and boxes at the keys alone.
#[test]
fn bounds_of_the_rest_pose_are_caught() {
    let scene = arm();
    let mut rigid = scene.clone();
    (rigid.deformed, rigid.skins) = (Vec::new(), Vec::new());
    rigid.meshes[0].declared_bounds = None;
    let rests = WorldBounds::new(&rigid);
    let hand = |seconds: f64| gpu_shape(&scene.deformed[0], &scene.shapes_at(seconds))[2].as_dvec3();
    let (bent_up, keys) = (hand(1.2), Aabb::from_points([0.0, 2.0].map(hand)).union(Aabb::from_points([DVec3::ZERO])));
    let frozen = MovingBoxes::new(&rigid, &rests, MovingBounds::Union);
    let frozen = frozen.at(0, 1.2, &rests, (0, &DAffine3::IDENTITY), &Shapes::default());
    assert!(!frozen.contains(bent_up), "{bent_up}: {frozen:?}");
    assert!(!keys.contains(bent_up), "{bent_up}: {keys:?}");
    for mode in MovingBounds::ALL {
        assert_eq!(outside(&scene, mode, &[0.0, 0.7, 1.2, 2.0, 9.0]), Vec::<String>::new());
    }
}

/// A skeleton's boxes are as small as its joints': no sphere of all that it could do.
#[test]
fn boxes_of_bent_objects_are_tight() {
    let scene = arm();
    let bounds = WorldBounds::new(&scene);
    let at = |mode, seconds: f64| {
        let shapes = scene.shapes_at(seconds);
        MovingBoxes::new(&scene, &bounds, mode).at(0, seconds, &bounds, (0, &DAffine3::IDENTITY), &shapes)
    };
    let near = |box_: Aabb, [x, y]: [f64; 2], [u, v]: [f64; 2], slack: f64| {
        let wanted = Aabb { min: DVec3::new(x, y, 0.0), max: DVec3::new(u, v, 0.0) };
        assert!((box_.min - wanted.min).abs().max_element() < slack, "{box_:?} {wanted:?}");
        assert!((box_.max - wanted.max).abs().max_element() < slack, "{box_:?} {wanted:?}");
    };
    near(at(MovingBounds::PerFrame, 0.0), [0.0, 0.0], [2.0, 0.0], 1e-5);
    let third = 3f64.sqrt() / 2.0;
    near(at(MovingBounds::PerFrame, 2.0), [0.0, 0.0], [1.0, third], 1e-5);
    // The hand goes round the elbow at (1, 0), from (2, 0) by (1, 1) to (0.5, 0.87).
    near(at(MovingBounds::Union, 1.0), [0.0, 0.0], [2.0, 1.0], 0.05);
    near(at(MovingBounds::InPlace, 1.0), [0.0, 0.0], [2.0, 1.0], 0.05);
    near(at(MovingBounds::PerAnimation, 1.0), [0.0, 0.0], [2.0, 1.0], 0.05);
    // Once it is over, it is over.
    near(at(MovingBounds::PerAnimation, 3.0), [0.0, 0.0], [1.0, third], 1e-5);
}

/// The glTF tutorial's skin, through all of its motion.
#[test]
fn what_a_file_bends_stays_in_its_box() {
    let scene = scenes::import(Path::new("/usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf"))
        .expect("Debian's assimp-testmodels");
    let times: Vec<f64> = (0..200).map(|step| -0.2 + f64::from(step) * 0.03).collect();
    for mode in MovingBounds::ALL {
        assert_eq!(outside(&scene, mode, &times), Vec::<String>::new());
    }
}

#[test]
fn skins_without_a_meaning_are_refused() {
    assert!(arm().check().is_ok());
    type Change = fn(&mut Scene);
    let changes: [(Change, &str); 9] = [
        (|scene| scene.objects.push(object("other", 0, DAffine3::IDENTITY)), "it hangs on no node of the animation"),
        (|scene| scene.deformed.push(scene.deformed[0].clone()), "its mesh is deformed twice, or out of order"),
        (|scene| scene.deformed[0].skin = Some(3), "it has skin 3, but the scene has 1"),
        (|scene| scene.deformed[0].rest[1].joints[2] = 9, "vertex 1: it has joint 9, but its skin has 2"),
        (|scene| scene.deformed[0].rest[1].weights = shares([0.5, 0.25]), "do not add up to 1"),
        (|scene| scene.deformed[0].rest[1].weights = shares([1.5, -0.5]), "are negative"),
        (|scene| scene.deformed[0].rest.truncate(2), "2 vertices at rest for the 3 of its mesh"),
        (|scene| scene.meshes[0].declared_bounds = None, "declares no box for all its shapes"),
        (|scene| scene.motion = Motion::Still, "its mesh is deformed, but nothing moves"),
    ];
    for (index, (change, text)) in changes.into_iter().enumerate() {
        let mut scene = arm();
        change(&mut scene);
        let message = scene.check().expect_err("it has no meaning").to_string();
        assert!(message.starts_with("object '") && message.contains(text), "change {index}: {message}");
    }
    let Motion::Nodes(nodes) = arm().motion else { panic!("an arm has bones") };
    let refused = |anchor: usize, joint: (usize, DAffine3)| Skin::new(&nodes, anchor, &[joint]).unwrap_err();
    assert_eq!(refused(2, (0, DAffine3::IDENTITY)), "its anchor is node 2 of 2");
    assert_eq!(refused(1, (0, DAffine3::IDENTITY)), "joint 0 does not hang below the anchor");
    assert_eq!(refused(0, (5, DAffine3::IDENTITY)), "joint 0 is node 5 of 2");
    let infinite = DAffine3::from_translation(DVec3::INFINITY);
    assert_eq!(refused(0, (1, infinite)), "the inverse bind matrix of joint 0 is not finite");
}
