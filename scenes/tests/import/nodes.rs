//! Laws of the node tree, instances and cameras.

use crate::model::{assert_says, warnings, Model, FLOAT};
use glam::{DMat3, DQuat, DVec3};
use scenes::Projection;
use serde_json::json;

#[test]
fn matrices_are_read_bit_for_bit() {
    let numbers: [f64; 12] = [
        0.1,
        -0.0,
        1e-300,
        std::f64::consts::PI,
        1.0 / 3.0,
        2e15 / 7.0,
        -5e-324,
        123_456_789.123_456_79,
        0.3,
        1e6 + 1e-9,
        -0.0,
        7.1,
    ];
    let mut model = Model::triangle();
    let columns: Vec<f64> = numbers
        .chunks(3)
        .enumerate()
        .flat_map(|(at, column)| [column, &[if at == 3 { 1.0 } else { 0.0 }]].concat())
        .collect();
    model.json["nodes"][0]["matrix"] = json!(columns);
    let object = model.scene().objects.remove(0);
    let bits = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&object.world_from_object.to_cols_array()), bits(&numbers));
    // An identity above it changes nothing, not even the sign of a zero.
    let root = model.node(json!({ "children": [0] }), true);
    model.json["scenes"][0]["nodes"] = json!([root]);
    assert_eq!(bits(&model.scene().objects[0].world_from_object.to_cols_array()), bits(&numbers));
}

#[test]
fn transforms_accumulate_in_f64() {
    let mut model = Model::triangle();
    model.json["nodes"][0] = json!({ "mesh": 0, "translation": [1e-3, 0, 0], "scale": [-1, 2, 1] });
    let root = model.node(json!({ "children": [0], "translation": [1e6, 0, 0], "rotation": [0, 0, 0.6, 0.6] }), true);
    model.json["scenes"][0]["nodes"] = json!([root]);
    let place = model.scene().objects[0].world_from_object;
    assert!((place.translation - DVec3::new(1e6, 1e-3, 0.0)).length() < 1e-9, "{place}");
    let expected =
        DMat3::from_rotation_z(std::f64::consts::FRAC_PI_2) * DMat3::from_diagonal(DVec3::new(-1.0, 2.0, 1.0));
    assert!(place.matrix3.abs_diff_eq(expected, 1e-12), "{place}");
}

#[test]
fn recursive_nodes_are_refused() {
    let mut model = Model::triangle();
    model.node(json!({ "children": [2] }), false);
    model.node(json!({ "children": [1] }), false);
    assert_says(&model.error(), "node 2 is its own ancestor, by way of node 1");
    model.json["nodes"] = json!([{ "children": [0] }]);
    assert_says(&model.error(), "node 0 is its own ancestor");
}

#[test]
fn a_node_has_one_parent() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{ "children": [2] }, { "children": [2] }, { "mesh": 0 }]);
    assert_says(&model.error(), "node 2 is a child of both node 0 and node 1");
    model.json["nodes"] = json!([{ "children": [1, 1] }, {}]);
    assert_says(&model.error(), "node 0 lists node 1 twice");
    model.json["nodes"] = json!([{ "mesh": 0 }, { "children": [0] }]);
    assert_says(&model.error(), "scene 0 lists node 0, which is no root but a child of node 1");
    model.json["nodes"] = json!([{ "children": [5] }]);
    assert_says(&model.error(), "node 0: it refers to node 5, but the file has 1");
}

/// A tree of this depth overflows the stack of any reader that recurses.
const DEEP: usize = 50_000;

#[test]
fn trees_of_any_depth_are_read() {
    let mut model = Model::triangle();
    let chain = |node: usize| {
        if node == DEEP {
            json!({ "mesh": 0 })
        } else {
            json!({ "children": [node + 1], "translation": [1, 0, 0] })
        }
    };
    model.json["nodes"] = (0..=DEEP).map(chain).collect();
    let input = model.floats("SCALAR", &[0.0, 2.0]);
    let output = model.floats("VEC3", &[0., 0., 0., 0., 6., 0.]);
    assert_eq!(model.scene().objects[0].world_from_object.translation.x, DEEP as f64);
    model.channel(0, "translation", "LINEAR", input, output);
    let (scene, mut places) = (model.scene(), Vec::new());
    scene.motion.transforms_at(1.0, &mut places);
    assert_eq!(places[0].1.translation, DVec3::new(DEEP as f64 - 1.0, 3.0, 0.0));
}

#[test]
fn files_without_scene_or_nodes_are_empty_scenes() {
    for json in [
        json!({ "asset": { "version": "2.0" } }),
        json!({ "asset": { "version": "2.0" }, "scene": 0 }),
        json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{}] }),
        json!({ "asset": { "version": "2.0" }, "nodes": [{}], "meshes": [] }),
    ] {
        let scene = Model { json, binary: Vec::new() }.scene();
        assert!(scene.objects.is_empty() && scene.meshes.is_empty() && scene.cameras.is_empty());
    }
    let mut model = Model::triangle();
    model.json["scene"] = 1.into();
    assert_says(&model.error(), "its default scene: it refers to scene 1, but the file has 1");
}

#[test]
fn nodes_share_their_mesh_and_keep_their_order() {
    let mut model = Model::triangle();
    let primitive = model.json["meshes"][0]["primitives"][0].clone();
    model.json["meshes"] = json!([{ "name": "pair", "primitives": [primitive, primitive] }]);
    model.json["nodes"] = json!([{ "mesh": 0, "name": "b" }, { "mesh": 0 }]);
    model.json["scenes"][0]["nodes"] = json!([1, 0]);
    let scene = model.scene();
    let objects: Vec<(&str, u32)> = scene.objects.iter().map(|object| (object.name.as_str(), object.mesh)).collect();
    assert_eq!(objects, [("b/0", 0), ("b/1", 1), ("pair/0", 0), ("pair/1", 1)]);
    assert_eq!((scene.meshes.len(), scene.meshes[1].name.as_str()), (2, "pair/1"));
}

#[test]
fn instances_become_objects() {
    let mut model = Model::triangle();
    let translation = model.floats("VEC3", &[1., 0., 0., 0., 2., 0.]);
    let half = 23170_i16.to_le_bytes();
    let quarter_turn: Vec<u8> = [[0, 0], [0, 0], half, half].concat().repeat(2);
    let rotation = model.accessor(&quarter_turn, 5122, "VEC4", 2);
    model.json["accessors"][rotation]["normalized"] = true.into();
    let scale = model.floats("VEC3", &[2., 2., 2., 3., 3., 3.]);
    let attributes = json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale });
    model.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    model.json["nodes"][0] = json!({
        "mesh": 0, "name": "tree", "translation": [10, 0, 0], "extensions": { "EXT_mesh_gpu_instancing": { "attributes": attributes } },
    });
    let scene = model.scene();
    assert_eq!((scene.meshes.len(), scene.objects.len(), scene.objects[1].name.as_str()), (1, 2, "tree#1"));
    let at = |object: usize| scene.objects[object].world_from_object.transform_point3(DVec3::X);
    assert!(
        at(0).abs_diff_eq(DVec3::new(11.0, 2.0, 0.0), 1e-9) && at(1).abs_diff_eq(DVec3::new(10.0, 5.0, 0.0), 1e-9),
        "{} {}",
        at(0),
        at(1)
    );
    model.json["accessors"][scale]["count"] = 1.into();
    assert_says(&model.error(), "node 0 'tree': EXT_mesh_gpu_instancing: its attributes have different counts");
}

#[test]
fn places_without_a_meaning_are_refused() {
    let mut model = Model::triangle();
    model.json["nodes"][0] = json!({ "mesh": 0, "rotation": [0, 0, 0, 0] });
    assert_says(&model.error(), "node 0: a rotation of zero length");
    model.json["nodes"][0] = json!({ "mesh": 0, "matrix": [1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] });
    assert_says(&model.error(), "node 0: its matrix has the last row");
    model.json["nodes"] = json!([{ "children": [1], "scale": [1e300, 1, 1] }, { "mesh": 0, "scale": [1e300, 1, 1] }]);
    assert_says(&model.error(), "node 1: its place in the world is not finite");
}

/// Found by fuzzing: `Scene::check` refuses such a scene, and the import let it pass.
#[test]
fn what_leaves_the_range_of_f32_is_refused() {
    let mut model = Model::triangle();
    let positions = model.floats("VEC3", &[0., 0., 0., -1.7e38, 0., 0., 0., 1., 0.]);
    model.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = positions.into();
    assert!(model.scene().check().is_ok());
    model.json["nodes"][0] = json!({ "mesh": 0, "name": "far", "scale": [3, 1, 1] });
    assert_says(&model.error(), "object 'far': its transform takes it beyond the range of 32-bit numbers");
}

#[test]
fn cameras_keep_their_place_and_lens() {
    let mut model = Model::new();
    model.json["cameras"] = json!([
        { "name": "eye", "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1, "aspectRatio": 4 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 2.5, "znear": 0, "zfar": 10 } },
    ]);
    model.node(json!({ "camera": 0, "translation": [1, 2, 3], "rotation": [0, 1, 0, 0], "scale": [3, 3, 3] }), true);
    model.node(json!({ "camera": 1, "name": "map" }), true);
    let cameras = model.scene().cameras;
    assert_eq!(cameras[0].projection, Projection::Perspective { fov_y: 0.7, near: 0.1, far: None });
    assert_eq!(cameras[0].pose.position, DVec3::new(1.0, 2.0, 3.0));
    assert!(cameras[0].pose.rotation.dot(DQuat::from_rotation_y(std::f64::consts::PI)).abs() > 1.0 - 1e-12);
    assert_eq!(cameras[1].projection, Projection::Orthographic { half_height: 2.5, near: 0.0, far: 10.0 });
    assert_eq!((cameras[0].aspect, cameras[1].aspect), (Some(4.0), Some(0.4)));
    assert_eq!((cameras[0].name.as_str(), cameras[1].name.as_str()), ("eye", "map"));
    // No picture is made for such a rectangle.
    for wild in [1e300, 1e-300] {
        let mut wide = Model { json: model.json.clone(), binary: model.binary.clone() };
        wide.json["cameras"][0]["perspective"]["aspectRatio"] = wild.into();
        assert_eq!(wide.scene().cameras[0].aspect, None);
    }
    for (place, value) in [("yfov", 4.0), ("yfov", 0.0), ("znear", 0.0), ("zfar", 0.05)] {
        let mut model = Model { json: model.json.clone(), binary: Vec::new() };
        model.json["cameras"][0]["perspective"][place] = value.into();
        assert_says(&model.error(), "node 0: camera 0 'eye': its");
    }
}

#[test]
fn a_mesh_without_positions_draws_nothing() {
    let mut model = Model::triangle();
    model.json["meshes"][0]["primitives"][0]["attributes"] = json!({ "NORMAL": 0 });
    assert!(model.scene().objects.is_empty());
    model.bare_accessor(json!({ "componentType": FLOAT, "type": "VEC3", "count": 3 }));
    model.json["meshes"][0]["primitives"][0]["attributes"] = json!({ "POSITION": 1 });
    let (scene, warnings) = warnings(|| model.scene());
    assert_eq!(scene.meshes[0].positions, [glam::Vec3::ZERO; 3], "an accessor without bytes is zeros");
    assert!(warnings.iter().any(|line| line.contains("POSITION has no data")), "{warnings:?}");
}

/// "The view matrix is derived from the global transform of the node containing the camera with the scaling ignored" (3.10.2).
#[test]
fn the_scale_of_a_cameras_own_node_changes_nothing() {
    let pose = |scale: [f64; 3], animated: bool| {
        let mut model = Model::new();
        model.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }]);
        let place = json!({ "camera": 0, "translation": [1, 2, 3], "rotation": [0, 0.6, 0, 0.8], "scale": scale });
        let node = model.node(place, true);
        if animated {
            let input = model.floats("SCALAR", &[0.0, 1.0]);
            let keys: Vec<f32> = scale.iter().chain(&[1.0, 1.0, 1.0]).map(|part| *part as f32).collect();
            let output = model.floats("VEC3", &keys);
            model.channel(node, "scale", "LINEAR", input, output);
        }
        let scene = model.scene();
        match scene.cameras[0].node {
            Some(node) => scene.motion.camera_pose_at(node, 0.25).expect("an animated camera"),
            None => scene.cameras[0].pose,
        }
    };
    let expected = pose([1.0; 3], false);
    for scale in [[1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [-2.0, -2.0, -2.0], [0.0, 0.0, 0.0], [3.0, 0.5, 1.0]] {
        for animated in [false, true] {
            let found = pose(scale, animated);
            assert_eq!(found.position, expected.position, "{scale:?}");
            assert!(found.rotation.dot(expected.rotation).abs() > 1.0 - 1e-12, "{scale:?} {animated}");
        }
    }
}
