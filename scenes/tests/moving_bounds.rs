//! Bounds of what moves hold every vertex, where the GPU puts it, at every time, in each of the four ways to have them.

mod moving_support;

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use moving_support::{gpu_vertex, node, object, points, times, vector};
use proptest::prelude::*;
use scenes::animation::{AnimatedNode, Attachment, Interpolation, Local, NodeAnimation, Orbit, Track};
use scenes::{
    export_glb, import_bytes, Aabb, Mesh, Motion, MovingBounds, MovingBoxes, Scene, SceneOptions, Shapes, WorldBounds,
};
use std::path::Path;

/// Every vertex that is outside of its box at one of these times.
fn outside(scene: &Scene, mode: MovingBounds, times: &[f64]) -> Vec<String> {
    let bounds = WorldBounds::new(scene);
    let boxes = MovingBoxes::new(scene, &bounds, mode);
    let (mut transforms, mut faults) = (Vec::new(), Vec::new());
    for seconds in times {
        scene.motion.transforms_at(*seconds, &mut transforms);
        let shapes = scene.shapes_at(*seconds);
        for (moving, (object, transform)) in transforms.iter().enumerate() {
            let object = &scene.objects[*object as usize];
            let box_ = boxes.at(moving, *seconds, &bounds, (object.mesh, transform), &shapes);
            let farthest = boxes.farthest(moving).unwrap_or(f64::INFINITY);
            if transform.translation.abs().max_element() > farthest {
                faults.push(format!("{mode:?}, {}, at {seconds}: its origin is beyond {farthest}", object.name));
            }
            let vertices = scene.meshes[object.mesh as usize].positions.iter();
            let vertices = vertices.map(|position| gpu_vertex(transform, *position));
            for vertex in vertices.filter(|vertex| !box_.contains(*vertex)) {
                faults.push(format!("{mode:?}, {}, at {seconds}: {vertex} is outside of {box_:?}", object.name));
            }
        }
    }
    faults
}

fn scene(positions: Vec<Vec3>, motion: Motion) -> Scene {
    let mut transforms = Vec::new();
    motion.transforms_at(0.0, &mut transforms);
    Scene {
        meshes: vec![Mesh { positions, ..Mesh::default() }],
        objects: transforms.iter().map(|(at, place)| object(&format!("object {at}"), 0, *place)).collect(),
        motion,
        ..Scene::default()
    }
}

/// A few nodes, each of which hangs on the one before or is a root, with an object on each.
fn motion() -> impl Strategy<Value = (Motion, Vec<f64>)> {
    (prop::collection::vec(node(), 1..5), vector(3.0)).prop_map(|(nodes, offset)| {
        let mut keys = Vec::new();
        for (node, _) in &nodes {
            for (first, last) in [
                node.translation.as_ref().map(Track::duration_s),
                node.rotation.as_ref().map(Track::duration_s),
                node.scale.as_ref().map(Track::duration_s),
            ]
            .into_iter()
            .flatten()
            {
                keys.extend([first, last]);
            }
        }
        let hang = |(index, (node, hangs)): (usize, (AnimatedNode, bool))| AnimatedNode {
            parent: (hangs && index > 0).then(|| index - 1),
            ..node
        };
        let count = nodes.len();
        let nodes = nodes.into_iter().enumerate().map(hang).collect();
        let on = |node: usize| Attachment {
            node_from_object: DAffine3::from_translation(offset * node as f64),
            ..Attachment::new(node as u32, node)
        };
        let animation = NodeAnimation::new(nodes, (0..count).map(on).collect()).expect("a legal animation");
        (Motion::Nodes(animation), keys)
    })
}

fn orbit() -> impl Strategy<Value = Orbit> {
    let base = (prop::array::uniform9(-1.5..1.5f64), vector(9.0))
        .prop_map(|(linear, at)| DAffine3 { matrix3: DMat3::from_cols_array(&linear), translation: at });
    let axis = prop_oneof![vector(1.0), Just(DVec3::ZERO), Just(DVec3::Y)];
    let speed = prop_oneof![-3.0..3.0f64, Just(0.0)];
    let period = prop_oneof![0.5..5.0f64, Just(0.0)];
    (base, vector(9.0), axis, speed, vector(3.0), period).prop_map(
        |(base, centre, axis, radians_per_s, bob, bob_period_s)| Orbit {
            object: 0,
            base,
            centre,
            axis,
            radians_per_s,
            bob,
            bob_period_s,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn what_nodes_carry_stays_in_its_box(
        (motion, keys) in motion(), points in points(), by_chance in prop::collection::vec(0.0..1.0f64, 40),
    ) {
        let scene = scene(points, motion);
        for mode in MovingBounds::ALL {
            let faults = outside(&scene, mode, &times(&keys, &by_chance));
            prop_assert!(faults.is_empty(), "{}", faults.join("\n"));
        }
    }

    #[test]
    fn what_orbits_stays_in_its_box(
        orbit in orbit(), points in points(), by_chance in prop::collection::vec(0.0..1.0f64, 40),
    ) {
        let scene = scene(points, Motion::Orbits(vec![orbit]));
        for mode in MovingBounds::ALL {
            let faults = outside(&scene, mode, &times(&[0.0, 100.0], &by_chance));
            prop_assert!(faults.is_empty(), "{}", faults.join("\n"));
        }
    }
}

fn turning(interpolation: Interpolation, values: Vec<DQuat>) -> Scene {
    let times =
        (0..values.len() / if interpolation == Interpolation::CubicSpline { 3 } else { 1 }).map(|key| key as f64);
    let node = AnimatedNode {
        parent: None,
        world_from_root: DAffine3::IDENTITY,
        local: Local::Parts { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE },
        translation: None,
        rotation: Some(Track::new(interpolation, times.collect(), values).expect("a legal track")),
        scale: None,
    };
    let on = Attachment::new(0, 0);
    let animation = NodeAnimation::new(vec![node], vec![on]).expect("a legal animation");
    scene(vec![Vec3::ZERO, Vec3::X], Motion::Nodes(animation))
}

/// What this is against: a box around the places at the keys alone. A third of a turn leaves it, and so must be caught.
#[test]
fn a_box_around_the_keys_alone_is_caught() {
    let third = DQuat::from_rotation_z(std::f64::consts::TAU / 3.0);
    let scene = turning(Interpolation::Linear, vec![DQuat::IDENTITY, third, third * third, DQuat::IDENTITY]);
    let (bounds, mut transforms, mut keys) = (WorldBounds::new(&scene), Vec::new(), Aabb::EMPTY);
    for seconds in [0.0, 1.0, 2.0, 3.0] {
        scene.motion.transforms_at(seconds, &mut transforms);
        keys = keys.union(bounds.of(0, &transforms[0].1));
    }
    let boxes = MovingBoxes::new(&scene, &bounds, MovingBounds::Union);
    let union = boxes.at(0, 0.0, &bounds, (0, &DAffine3::IDENTITY), &Shapes::default());
    scene.motion.transforms_at(0.75, &mut transforms);
    let vertex = gpu_vertex(&transforms[0].1, Vec3::X);
    assert!(!keys.contains(vertex) && union.contains(vertex), "{vertex}: {keys:?}, {union:?}");
    // No looser than its derivation says: 13 spans a third of a turn, each half of which moves the point by less than 0.081.
    assert!(union.max.max_element() < 1.081 && union.min.min_element() > -1.081, "{union:?}");
}

/// A spline of rotations whose control points surround the origin can turn anywhere between its keys.
#[test]
fn splines_of_rotations_that_turn_right_over_stay_in_their_box() {
    let turn = |angle: f64| DQuat::from_rotation_z(angle);
    let tangent = DQuat::from_array([5.0, -7.0, 3.0, -9.0]);
    let values = vec![tangent, turn(0.0), tangent, -tangent, turn(3.0), tangent, tangent, -turn(6.0), tangent];
    let scene = turning(Interpolation::CubicSpline, values);
    let times: Vec<f64> = (0..4001).map(|step| -0.1 + f64::from(step) * 0.00055).collect();
    for mode in MovingBounds::ALL {
        assert_eq!(outside(&scene, mode, &times), Vec::<String>::new());
    }
}

/// Each way is what it says: what changes from frame to frame, and how large it is, on a door that swings open and, later, drives away.
#[test]
fn the_four_ways_differ_as_the_chapter_says() {
    let quarter = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    let lines = |times: [f64; 2], values: [DVec3; 2]| {
        Track::new(Interpolation::Linear, times.to_vec(), values.to_vec()).expect("a legal track")
    };
    let node = AnimatedNode {
        parent: None,
        world_from_root: DAffine3::IDENTITY,
        local: Local::Parts { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE },
        translation: Some(lines([5.0, 9.0], [DVec3::ZERO, DVec3::X * 100.0])),
        rotation: Some(
            Track::new(Interpolation::Linear, vec![0.0, 2.0], vec![DQuat::IDENTITY, quarter]).expect("a legal track"),
        ),
        scale: None,
    };
    let on = Attachment::new(0, 0);
    let animation = NodeAnimation::new(vec![node], vec![on]).expect("a legal animation");
    let scene = scene(vec![Vec3::ZERO, Vec3::new(1.0, 2.0, 0.1)], Motion::Nodes(animation));
    let bounds = WorldBounds::new(&scene);
    let mut transforms = Vec::new();
    let mut at = |mode, seconds: f64| {
        scene.motion.transforms_at(seconds, &mut transforms);
        MovingBoxes::new(&scene, &bounds, mode).at(0, seconds, &bounds, (0, &transforms[0].1), &Shapes::default())
    };
    let width = |box_: Aabb| box_.max.x - box_.min.x;
    assert_eq!(at(MovingBounds::Union, 1.0), at(MovingBounds::Union, 7.0));
    assert!(width(at(MovingBounds::Union, 1.0)) > 100.0);
    assert_eq!(
        at(MovingBounds::PerAnimation, 0.5),
        at(MovingBounds::PerAnimation, 1.5),
        "one box while the door swings"
    );
    assert!(width(at(MovingBounds::PerAnimation, 1.0)) < 1.2 && width(at(MovingBounds::PerAnimation, 3.0)) < 0.2);
    assert!(width(at(MovingBounds::PerAnimation, 7.0)) > 100.0);
    let [swings, drives] = [1.0, 7.0].map(|seconds| at(MovingBounds::InPlace, seconds));
    assert!(((drives.max - drives.min) - (swings.max - swings.min)).length() < 1e-9, "one box, moved");
    assert!(width(drives) < 1.3 && drives.min.x > 40.0);
    let [then, now] = [1.0, 1.5].map(|seconds| at(MovingBounds::PerFrame, seconds));
    assert_ne!(then, now);
}

/// The scenes and files that move: at 40 times, every vertex of every moving object.
#[test]
fn what_moves_in_scenes_and_files_stays_in_its_box() {
    let options = SceneOptions { scale: 0.02, seed: 3, ..SceneOptions::default() };
    let boxes = scenes::open("moving-boxes", &options).expect("a scene that opens");
    // Nodes with keys instead of orbits.
    let file = export_glb(&boxes, None, 0).expect("it can be written");
    let file = import_bytes(Path::new("moving.glb"), &file).expect("it can be read");
    assert!(matches!(file.motion, Motion::Nodes(_)));
    let balloons = scenes::open("moving-balloons", &options).expect("a scene that opens");
    let mut moving = 0;
    for scene in [boxes, file, balloons] {
        let (first, last) = scene.motion.duration_s();
        moving += scene.motion.dynamic_objects().len();
        let times: Vec<f64> = (0..40)
            .map(|step| first - 0.5 + (last - first + 1.0) * f64::from(step) * 0.618_034 % (last + 1.0))
            .collect();
        for mode in MovingBounds::ALL {
            assert_eq!(outside(&scene, mode, &times), Vec::<String>::new(), "{}", scene.name);
        }
    }
    assert!(moving > 100, "{moving} moving objects");
}

#[test]
fn a_motion_that_is_not_finite_gives_a_box_that_is_not_valid() {
    let orbit = Orbit {
        object: 0,
        base: DAffine3::IDENTITY,
        centre: DVec3::new(f64::NAN, 0.0, 0.0),
        axis: DVec3::Y,
        radians_per_s: 1.0,
        bob: DVec3::ZERO,
        bob_period_s: 0.0,
    };
    let scene = scene(vec![Vec3::ONE], Motion::Orbits(vec![orbit]));
    let bounds = WorldBounds::new(&scene);
    let boxes = MovingBoxes::new(&scene, &bounds, MovingBounds::Union);
    assert!(!boxes.at(0, 0.0, &bounds, (0, &DAffine3::IDENTITY), &Shapes::default()).is_valid());
}
