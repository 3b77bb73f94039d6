//! Laws of node animation and orbits.

use crate::model::{assert_says, Model};
use glam::{DAffine3, DQuat, DVec3};
use scenes::animation::{AnimatedNode, Attachment, Interpolation, Local, NodeAnimation, Orbit, Track};
use scenes::Motion;
use serde_json::json;
use std::f64::consts::{FRAC_PI_2, PI};

fn x(value: f64) -> DVec3 {
    DVec3::new(value, 0.0, 0.0)
}

#[test]
fn a_cubic_spline_goes_through_the_values_worked_out_by_hand() {
    // From 1 to 3 in 2 s, leaving at 4 a second and arriving at -2 a second.
    let values = [x(9.0), x(1.0), x(4.0), x(-2.0), x(3.0), x(9.0)].to_vec();
    let track = Track::new(Interpolation::CubicSpline, vec![10.0, 12.0], values).expect("a legal track");
    // p = (2t³-3t²+1) 1 + 2 (t³-2t²+t) 4 + (3t²-2t³) 3 + 2 (t³-t²) (-2), at t = 1/4, 1/2 and 3/4.
    for (seconds, expected) in
        [(10.0, 1.0), (10.5, 2.625), (11.0, 3.5), (11.5, 3.625), (12.0, 3.0), (0.0, 1.0), (99.0, 3.0)]
    {
        assert_eq!(track.at(seconds).x, expected, "at {seconds}");
    }
    // A rotation keeps unit length although its components are splines.
    let zero = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let values = [zero, DQuat::IDENTITY, zero, zero, DQuat::from_rotation_z(FRAC_PI_2), zero].to_vec();
    let track = Track::new(Interpolation::CubicSpline, vec![0.0, 1.0], values).expect("a legal track");
    assert!(track.at(0.5).abs_diff_eq(DQuat::from_rotation_z(FRAC_PI_2 / 2.0), 1e-12));
}

#[test]
fn steps_hold_and_lines_are_straight() {
    let values = vec![x(0.0), x(4.0), x(-4.0)];
    let steps = Track::new(Interpolation::Step, vec![1.0, 2.0, 4.0], values.clone()).expect("a legal track");
    let lines = Track::new(Interpolation::Linear, vec![1.0, 2.0, 4.0], values).expect("a legal track");
    for (seconds, step, line) in
        [(0.0, 0.0, 0.0), (1.5, 0.0, 2.0), (2.0, 4.0, 4.0), (3.0, 4.0, 0.0), (4.0, -4.0, -4.0), (9.0, -4.0, -4.0)]
    {
        assert_eq!((steps.at(seconds).x, lines.at(seconds).x), (step, line), "at {seconds}");
    }
    assert_eq!(lines.duration_s(), (1.0, 4.0));
    assert!(lines.at(f64::NAN).is_finite());
}

#[test]
fn rotations_take_the_shorter_arc() {
    // The second key is a quarter turn, written with the opposite sign.
    let values = vec![DQuat::IDENTITY, -DQuat::from_rotation_y(FRAC_PI_2)];
    let track = Track::new(Interpolation::Linear, vec![0.0, 1.0], values).expect("a legal track");
    let third = track.at(1.0 / 3.0) * DVec3::X;
    assert!(third.abs_diff_eq(DQuat::from_rotation_y(FRAC_PI_2 / 3.0) * DVec3::X, 1e-12), "{third}");
}

#[test]
fn tracks_without_a_meaning_are_refused() {
    let linear = |times: &[f64], values: &[DVec3]| {
        Track::new(Interpolation::Linear, times.to_vec(), values.to_vec()).map(|_| ()).unwrap_err()
    };
    assert_says(&linear(&[], &[]), "no keys");
    assert_says(&linear(&[0.0, 1.0], &[x(0.0)]), "2 keys need 1 values each, but there are 1");
    assert_says(&linear(&[0.0, f64::NAN], &[x(0.0); 2]), "not a finite number");
    assert_says(&linear(&[1.0, 0.0], &[x(0.0); 2]), "the time of key 1 is before that of key 0");
    // Two keys at one time are a jump.
    let jump =
        Track::new(Interpolation::Linear, vec![0.0, 1.0, 1.0], vec![x(0.0), x(1.0), x(5.0)]).expect("a legal track");
    assert_eq!((jump.at(0.5).x, jump.at(1.0).x), (0.5, 5.0));
}

/// A still parent, an arm that turns about y from 1 s to 3 s, and on it a triangle and a camera; beside them a still triangle.
fn turning_arm() -> Model {
    let mut model = Model::triangle();
    model.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1 } }]);
    model.json["nodes"] = json!([
        { "mesh": 0 },
        { "children": [2], "translation": [0, 5, 0] },
        { "children": [3, 4] },
        { "mesh": 0, "translation": [2, 0, 0] },
        { "camera": 0, "translation": [0, 0, 1], "scale": [2, 2, 2] },
    ]);
    model.json["scenes"][0]["nodes"] = json!([0, 1]);
    let input = model.floats("SCALAR", &[1.0, 3.0]);
    let output = model.floats("VEC4", &[0., 0., 0., 1., 0., 1., 0., 0.]);
    model.channel(2, "rotation", "LINEAR", input, output);
    model
}

#[test]
fn what_hangs_on_an_animated_node_moves_with_it() {
    let scene = turning_arm().scene();
    assert_eq!(scene.motion.dynamic_objects(), [1]);
    assert_eq!([scene.objects[0].dynamic, scene.objects[1].dynamic], [false, true]);
    assert_eq!(scene.motion.duration_s(), (1.0, 3.0));
    let mut places = vec![(7, DAffine3::IDENTITY)];
    for (seconds, angle) in [(0.0, 0.0), (2.0, FRAC_PI_2), (3.0, PI), (50.0, PI)] {
        scene.motion.transforms_at(seconds, &mut places);
        assert_eq!((places.len(), places[0].0), (1, 1));
        let turned = DQuat::from_rotation_y(angle);
        let expected = turned * DVec3::new(2.0, 0.0, 0.0) + DVec3::new(0.0, 5.0, 0.0);
        assert!(places[0].1.translation.abs_diff_eq(expected, 1e-6), "at {seconds}: {}", places[0].1.translation);
        let pose =
            scene.motion.camera_pose_at(scene.cameras[0].node.expect("an animated camera"), seconds).expect("a pose");
        assert!(pose.forward().abs_diff_eq(turned * DVec3::NEG_Z, 1e-6), "at {seconds}: {}", pose.forward());
    }
    assert!(scene.motion.camera_pose_at(99, 0.0).is_none());
}

#[test]
fn the_scene_is_at_time_zero() {
    let scene = turning_arm().scene();
    let mut places = Vec::new();
    scene.motion.transforms_at(0.0, &mut places);
    for (object, place) in places {
        assert_eq!(scene.objects[object as usize].world_from_object, place);
    }
    assert_eq!(scene.motion.camera_pose_at(scene.cameras[0].node.expect("animated"), 0.0), Some(scene.cameras[0].pose));
}

#[test]
fn an_animated_matrix_is_taken_apart() {
    let mut model = turning_arm();
    model.json["nodes"][2]["matrix"] = json!([3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 0, 0, 1, 1]);
    let place = model.scene().objects[1].world_from_object;
    assert!(place.translation.abs_diff_eq(DVec3::new(6.0, 5.0, 1.0), 1e-9), "{place}");
}

#[test]
fn animation_of_nothing_leaves_the_scene_still() {
    let mut model = turning_arm();
    model.json["nodes"][3] = json!({});
    model.json["nodes"][4] = json!({});
    assert!(matches!(model.scene().motion, Motion::Still));
    let mut model = turning_arm();
    model.json["animations"][0]["channels"][0]["target"] = json!({ "path": "rotation" });
    assert!(matches!(model.scene().motion, Motion::Still));
}

#[test]
fn channels_that_fit_nothing_are_refused_with_their_place() {
    let cases = [
        ("/animations/0/channels/0/target/node", json!(9), "animation 0, channel 0: it refers to node 9"),
        ("/animations/0/channels/0/target/path", json!("colour"), "its path 'colour'"),
        ("/animations/0/channels/0/target/path", json!("scale"), "its type is 'VEC4', but VEC3 is needed here"),
        ("/animations/0/channels/0/sampler", json!(1), "it refers to sampler 1"),
        ("/animations/0/samplers/0/interpolation", json!("BOUNCE"), "its interpolation 'BOUNCE'"),
        ("/animations/0/samplers/0/interpolation", json!("CUBICSPLINE"), "2 keys need 3 values each"),
    ];
    for (place, value, text) in cases {
        let mut model = turning_arm();
        *model.json.pointer_mut(place).expect(place) = value;
        assert_says(&model.error(), text);
    }
}

#[test]
fn a_list_of_nodes_must_be_a_tree_and_objects_hang_once() {
    let still = Local::Parts { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
    let node = |parent| AnimatedNode {
        parent,
        world_from_root: DAffine3::IDENTITY,
        local: still,
        translation: None,
        rotation: None,
        scale: None,
    };
    let on = |object, node| Attachment::new(object, node);
    let refused = |nodes, objects| NodeAnimation::new(nodes, objects).map(|_| ()).unwrap_err();
    assert_says(&refused(vec![node(Some(0))], vec![]), "node 0 comes before its parent");
    assert_says(&refused(vec![node(None)], vec![on(4, 1)]), "object 4 hangs on node 1 of 1");
    assert_says(&refused(vec![node(None)], vec![on(4, 0), on(2, 0), on(4, 0)]), "object 4 hangs on two nodes");
    let nodes = NodeAnimation::new(vec![node(None)], vec![on(4, 0), on(2, 0)]).expect("legal");
    assert_eq!(Motion::Nodes(nodes).dynamic_objects(), [2, 4]);
}

#[test]
fn orbits_turn_about_their_axis_and_bob() {
    let base = DAffine3::from_translation(DVec3::new(3.0, 0.0, 0.0));
    let orbit = Orbit {
        object: 5,
        base,
        centre: x(1.0),
        axis: DVec3::Y * 4.0,
        radians_per_s: PI,
        bob: DVec3::Y,
        bob_period_s: 2.0,
    };
    let still = Orbit { object: 1, axis: DVec3::ZERO, bob_period_s: 0.0, ..orbit };
    let motion = Motion::Orbits(vec![orbit, still]);
    let mut places = Vec::new();
    motion.transforms_at(0.0, &mut places);
    assert_eq!(places, [(1, base), (5, base)]);
    motion.transforms_at(0.5, &mut places);
    assert!(places[1].1.translation.abs_diff_eq(DVec3::new(1.0, 1.0, -2.0), 1e-12), "{}", places[1].1);
    assert_eq!(places[0].1, base);
    assert_eq!((motion.duration_s(), motion.dynamic_objects()), ((0.0, 2.0), vec![1, 5]));
}

/// Each channel has a copy of the values of its sampler, and any number of channels may use one sampler.
#[test]
fn a_small_file_cannot_ask_for_many_keys() {
    let with = |nodes: usize, keys: u64| {
        let mut model = Model::triangle();
        let times = model.bare_accessor(json!({ "componentType": 5126, "type": "SCALAR", "count": keys }));
        let places = model.bare_accessor(json!({ "componentType": 5126, "type": "VEC3", "count": keys }));
        for node in 0..nodes {
            model.node(json!({ "mesh": 0 }), true);
            model.channel(node, "translation", "LINEAR", times, places);
        }
        for channel in model.json["animations"][0]["channels"].as_array_mut().expect("a list") {
            channel["sampler"] = 0.into();
        }
        model
    };
    let Motion::Nodes(nodes) = with(40, 1 << 10).scene().motion else { panic!("it moves") };
    assert_eq!(nodes.objects().len(), 40);
    // A scene that is not refused is too large to print.
    let message = with(40, 1 << 18).import().map(drop).expect_err("too many keys").to_string();
    assert_says(&message, "animation 0, channel 1");
    assert_says(&message, "too many for its size");
}
