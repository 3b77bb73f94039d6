//! Laws of skins: what bends, where, and what is refused.

use crate::model::{assert_says, Model, FLOAT, U16, U8};
use glam::{DAffine3, DVec3};
use proptest::prelude::*;
use scenes::{weights_of_sum_one, Scene};
use serde_json::json;
use std::f64::consts::FRAC_1_SQRT_2;
use std::path::Path;

/// A triangle of three vertices, at (0, 0, 0), (1, 0, 0) and (0, 1, 0): the first on the lower joint, the third on the upper one, the second on both. The
/// lower joint, node 2, stands at (0, 5, 0); the upper, node 3, is 1 m above it, and half a metre above where it was when the skin was bound.
/// The mesh's own node is far away, which means nothing.
pub fn skinned() -> Model {
    let mut model = Model::triangle();
    let joints = model.accessor(&[0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0], U8, "VEC4", 3);
    let weights = model.floats("VEC4", &[1., 0., 0., 0., 1., 3., 0., 0., 1., 0., 0., 0.]);
    let attributes = &mut model.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = joints.into();
    attributes["WEIGHTS_0"] = weights.into();
    let at = |y: f32| [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., y, 0., 1.];
    let inverse_binds = model.floats("MAT4", &[at(0.0), at(-0.5)].concat());
    model.json["nodes"] = json!([
        { "mesh": 0, "skin": 0, "translation": [100, 0, 0], "name": "cloak" },
        { "children": [2], "name": "armature" },
        { "children": [3], "translation": [0, 5, 0] },
        { "translation": [0, 1, 0] },
        {},
    ]);
    model.json["scenes"][0]["nodes"] = json!([0, 1]);
    model.json["skins"] = json!([{ "name": "cloth", "joints": [2, 3], "inverseBindMatrices": inverse_binds }]);
    model
}

/// The upper joint turns a quarter turn to the left about its own place in the first second.
pub fn turning() -> Model {
    let mut model = skinned();
    let turns = [0., 0., 0., 1., 0., 0., FRAC_1_SQRT_2 as f32, FRAC_1_SQRT_2 as f32];
    let (input, output) = (model.floats("SCALAR", &[0., 1.]), model.floats("VEC4", &turns));
    model.channel(3, "rotation", "LINEAR", input, output);
    model
}

/// Returns the vertices of an object in the world at a time.
pub fn vertices_of(scene: &Scene, object: usize, seconds: f64) -> Vec<DVec3> {
    let mut transforms = Vec::new();
    scene.motion.transforms_at(seconds, &mut transforms);
    let moved = transforms.iter().find(|(moved, _)| *moved as usize == object);
    let world_from_object = moved.map_or(scene.objects[object].world_from_object, |(_, place)| *place);
    let meshes = scene.meshes_at(seconds);
    let positions = meshes[scene.objects[object].mesh as usize].positions.iter();
    positions.map(|at| world_from_object.transform_point3(at.as_dvec3())).collect()
}

fn vertices(scene: &Scene, seconds: f64) -> Vec<DVec3> {
    vertices_of(scene, 0, seconds)
}

#[track_caller]
pub fn assert_near(found: &[DVec3], expected: [[f64; 3]; 3]) {
    for (found, expected) in found.iter().zip(expected.map(DVec3::from)) {
        assert!(found.abs_diff_eq(expected, 1e-6), "{found} is not {expected}");
    }
}

#[test]
fn a_skin_that_nothing_moves_is_bent_for_ever() {
    let scene = skinned().scene();
    assert!(scene.skins.is_empty() && scene.deformed.is_empty() && !scene.objects[0].dynamic);
    let object = &scene.objects[0];
    let positions = scene.meshes[object.mesh as usize].positions.iter();
    let found: Vec<DVec3> = positions.map(|at| object.world_from_object.transform_point3(at.as_dvec3())).collect();
    // The upper joint lifts what it carries by half a metre; the second vertex is carried by three quarters.
    assert_near(&found, [[0.0, 5.0, 0.0], [1.0, 5.375, 0.0], [0.0, 6.5, 0.0]]);
}

#[test]
fn joints_bend_what_they_carry() {
    let scene = turning().scene();
    assert_eq!((scene.skins.len(), scene.deformed.len(), scene.objects.len()), (1, 1, 1));
    assert!(scene.objects[0].dynamic && scene.objects[0].name == "cloak");
    assert_near(&vertices(&scene, 0.0), [[0.0, 5.0, 0.0], [1.0, 5.375, 0.0], [0.0, 6.5, 0.0]]);
    // A quarter turn about (0, 6, 0): (0, 6.5, 0) goes to (-0.5, 6, 0), and (1, 5.5, 0), of which there are three quarters, to (0.5, 7, 0).
    assert_near(&vertices(&scene, 1.0), [[0.0, 5.0, 0.0], [0.625, 6.5, 0.0], [-0.5, 6.0, 0.0]]);
    // The scene's own mesh is that of time 0, and its box holds both.
    let mesh = &scene.meshes[scene.objects[0].mesh as usize];
    let (world_from_object, always) = (scene.objects[0].world_from_object, mesh.declared_bounds.expect("a box"));
    let object_from_world: DAffine3 = world_from_object.inverse();
    for seconds in [0.0, 0.3, 1.0] {
        for vertex in vertices(&scene, seconds) {
            assert!(always.contains(object_from_world.transform_point3(vertex)), "{vertex} at {seconds}");
        }
    }
    let at_start = mesh.positions.iter().map(|at| world_from_object.transform_point3(at.as_dvec3()));
    assert_near(&at_start.collect::<Vec<_>>(), [[0.0, 5.0, 0.0], [1.0, 5.375, 0.0], [0.0, 6.5, 0.0]]);
    assert!(scene.check().is_ok());
}

/// The file of the glTF tutorial: its upper joint turns back and forth, and so do the vertices that it carries alone.
#[test]
fn the_simple_skin_sways() {
    let file = Path::new("/usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf");
    let scene = scenes::import(file).expect("Debian's assimp-testmodels");
    assert_eq!((scene.deformed.len(), scene.skins[0].joint_count()), (1, 2));
    let top = |seconds: f64| vertices(&scene, seconds)[8];
    assert!(top(0.0).abs_diff_eq(top(5.5), 1e-5), "{} {}", top(0.0), top(5.5));
    assert!(!top(0.0).abs_diff_eq(top(1.5), 0.1), "{} {}", top(0.0), top(1.5));
}

#[test]
fn skins_without_a_common_root_are_refused() {
    let mut model = skinned();
    model.json["skins"][0] = json!({ "name": "cloth", "joints": [2, 3, 4] });
    assert_says(&model.error(), "skin 0 'cloth': its joints 2 and 4 have no common root");
    model.json["skins"][0]["joints"] = json!([9]);
    assert_says(&model.error(), "skin 0 'cloth': it refers to node 9, but the file has 5");
    model.json["skins"][0]["joints"] = json!([]);
    assert_says(&model.error(), "skin 0 'cloth': it has no joints");
    model.json["skins"][0]["joints"] = json!([4]);
    assert_says(&model.error(), "skin 0 'cloth': its joints are not in the scene; add node 4 to it");
    model.json["nodes"][0]["skin"] = 1.into();
    assert_says(&model.error(), "node 0 'cloak': it refers to skin 1, but the file has 1");
}

#[test]
fn broken_influences_are_refused() {
    let refused = |change: &dyn Fn(&mut Model), text: &str| {
        for mut model in [skinned(), turning()] {
            change(&mut model);
            assert_says(&model.error(), text);
        }
    };
    let attribute = |name: &'static str, make: fn(&mut Model) -> usize| {
        move |model: &mut Model| {
            let accessor = make(model);
            model.json["meshes"][0]["primitives"][0]["attributes"][name] = accessor.into();
        }
    };
    let without = |name: &'static str| {
        move |model: &mut Model| {
            model.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().expect("a list").remove(name);
        }
    };
    refused(&without("JOINTS_0"), "mesh 0, primitive 0: its node has a skin, but it has no JOINTS_0");
    refused(&without("WEIGHTS_0"), "mesh 0, primitive 0: its node has a skin, but it has no WEIGHTS_0");
    let far = attribute("JOINTS_0", |model| model.accessor(&[0, 0, 0, 0, 0, 2, 0, 0, 1, 0, 0, 0], U8, "VEC4", 3));
    refused(&far, "mesh 0, primitive 0: JOINTS_0: vertex 1 refers to joint 2, but its skin has 2");
    let few = attribute("JOINTS_0", |model| model.accessor(&[0; 16], U16, "VEC4", 2));
    refused(&few, "has 2 elements, but there are 3 positions");
    let floats = attribute("JOINTS_0", |model| model.floats("VEC4", &[0.0; 12]));
    refused(&floats, "joints of component type 5126; they must be unsigned (5121 or 5123)");
    for (weight, said) in [(-0.25, "-0.25"), (f32::NAN, "NaN"), (f32::INFINITY, "inf")] {
        let set = |model: &mut Model| {
            let weights = model.floats("VEC4", &[1., 0., 0., 0., 1., weight, 0., 0., 1., 0., 0., 0.]);
            model.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights.into();
        };
        refused(&set, &format!("WEIGHTS_0: a weight of vertex 1 is {said}; weights are 0 or more"));
    }
    let plain = attribute("WEIGHTS_0", |model| model.accessor(&[0; 12], U8, "VEC4", 3));
    refused(&plain, "component type 5121 is not allowed here");
}

#[test]
fn broken_inverse_bind_matrices_are_refused() {
    let refused = |numbers: &[f32], text: &str| {
        for mut model in [skinned(), turning()] {
            let matrices = model.floats("MAT4", numbers);
            model.json["skins"][0]["inverseBindMatrices"] = matrices.into();
            assert_says(&model.error(), text);
        }
    };
    let identity = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    refused(&identity, "skin 0 'cloth': inverseBindMatrices: accessor");
    refused(&identity, "has 1 elements, but there are 2 joints");
    let (mut infinite, mut distorted) = (identity, identity);
    infinite[5] = f32::INFINITY;
    distorted[3] = 0.5;
    refused(&[identity, infinite].concat(), "its matrix has a number that is not finite");
    refused(&[identity, distorted].concat(), "its matrix has the last row [0.5, 0, 0, 1]");
    let mut model = skinned();
    let vectors = model.floats("VEC4", &[0.0; 8]);
    model.json["skins"][0]["inverseBindMatrices"] = vectors.into();
    assert_says(&model.error(), "its type is 'VEC4', but MAT4 is needed here");
    model.json["accessors"][vectors]["componentType"] = FLOAT.into();
}

/// EXT_mesh_gpu_instancing puts an instance at NodeWorldXform * InstanceXform; where there is a skin, glTF ignores the node's
/// transform. Each instance is an object, and all share one mesh.
#[test]
fn an_instance_of_a_skin_stands_where_its_own_transform_says() {
    for (mut model, moves) in [(skinned(), false), (turning(), true)] {
        let places = model.floats("VEC3", &[0., 0., 0., 10., 0., -2.]);
        let scales = model.floats("VEC3", &[1., 1., 1., 2., 2., 2.]);
        model.json["nodes"][0]["extensions"] =
            json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places, "SCALE": scales } } });
        let scene = model.scene();
        assert_eq!((scene.objects.len(), scene.deformed.len()), (2, usize::from(moves)));
        assert_eq!(scene.objects[0].mesh, scene.objects[1].mesh);
        assert_near(&vertices_of(&scene, 0, 0.0), [[0.0, 5.0, 0.0], [1.0, 5.375, 0.0], [0.0, 6.5, 0.0]]);
        assert_near(&vertices_of(&scene, 1, 0.0), [[10.0, 10.0, -2.0], [12.0, 10.75, -2.0], [10.0, 13.0, -2.0]]);
        if moves {
            assert_near(&vertices_of(&scene, 1, 1.0), [[10.0, 10.0, -2.0], [11.25, 13.0, -2.0], [9.0, 12.0, -2.0]]);
        }
        assert!(scene.check().is_ok());
        // In an exported file, each instance has a skeleton of its own.
        let written = scenes::export_glb(&scene, None, 2).expect("it can be written");
        let back = crate::model::import(&written).expect("what we write can be read");
        for (object, seconds) in [(0, 0.0), (1, 0.0), (0, 1.0), (1, 1.0)] {
            let expected = vertices_of(&scene, object, seconds).into_iter().map(|at| at.to_array());
            let expected: Vec<[f64; 3]> = expected.collect();
            assert_near(&vertices_of(&back, object, seconds), expected.try_into().expect("a triangle"));
        }
    }
}

/// Import panicked: it asked for the first object of a mesh that had none.
#[test]
fn a_skin_without_instances_shows_nothing() {
    for mut model in [skinned(), turning()] {
        let none = model.bare_accessor(json!({ "componentType": FLOAT, "type": "VEC3", "count": 0 }));
        model.json["nodes"][0]["extensions"] =
            json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": none } } });
        let scene = model.scene();
        assert!(scene.objects.is_empty() && scene.deformed.is_empty());
    }
}

/// The second vertex hangs on six joints, by a sixth each: three on either bone.
#[test]
fn eight_joints_carry_a_vertex() {
    let mut model = turning();
    let sets = [[[0u8; 4], [0, 1, 0, 1], [1, 0, 0, 0]], [[9; 4], [0, 1, 9, 9], [9; 4]]];
    let weights = [[[1f32, 0., 0., 0.], [1., 1., 1., 1.], [1., 0., 0., 0.]], [[0.; 4], [1., 1., 0., 0.], [0.; 4]]];
    for set in 0..2 {
        let joints = model.accessor(sets[set].as_flattened(), U8, "VEC4", 3);
        let weights = model.floats("VEC4", weights[set].as_flattened());
        let attributes = &mut model.json["meshes"][0]["primitives"][0]["attributes"];
        attributes[format!("JOINTS_{set}")] = joints.into();
        attributes[format!("WEIGHTS_{set}")] = weights.into();
    }
    // Half of (1, 0, 0), where the lower joint has it, and half of (0.5, 7, 0) less (0, 5, 0).
    let (scene, expected) = (model.scene(), [[0.0, 5.0, 0.0], [0.75, 6.0, 0.0], [-0.5, 6.0, 0.0]]);
    assert_near(&vertices(&scene, 1.0), expected);
    assert_eq!(scene.deformed[0].rest[1].influences().count(), 6);
    let written = scenes::export_glb(&scene, None, 2).expect("it can be written");
    assert_near(&vertices(&crate::model::import(&written).expect("what we write can be read"), 1.0), expected);
    let far = model.accessor(&[[0u8; 4], [2; 4], [0; 4]].concat(), U8, "VEC4", 3);
    model.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_1"] = far.into();
    assert_says(&model.error(), "JOINTS_1: vertex 1 refers to joint 2, but its skin has 2");
    model.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().expect("a list").remove("JOINTS_1");
    assert_says(&model.error(), "its node has a skin, but it has no JOINTS_1");
}

/// Of more than eight joints those of the largest weights carry a vertex.
#[test]
fn the_largest_eight_weights_count() {
    let mut model = turning();
    for set in 0..3 {
        let upper = u8::from(set == 2);
        let joints = model.accessor(&[[0u8; 4], [upper; 4], [1, 0, 0, 0]].concat(), U8, "VEC4", 3);
        // Eight weights of 1 below four of 3: the four of 3 and four of 1 stay.
        let weight = if set == 2 { 3.0 } else { 1.0 };
        let weights = model.floats("VEC4", &[[1., 0., 0., 0.], [weight; 4], [1., 0., 0., 0.]].concat());
        let attributes = &mut model.json["meshes"][0]["primitives"][0]["attributes"];
        attributes[format!("JOINTS_{set}")] = joints.into();
        attributes[format!("WEIGHTS_{set}")] = weights.into();
    }
    // Twelve of sixteen parts on the upper joint, as in `turning`.
    assert_near(&vertices(&model.scene(), 1.0), [[0.0, 5.0, 0.0], [0.625, 6.5, 0.0], [-0.5, 6.0, 0.0]]);
}

/// What has no weight may name any joint; a vertex without weights hangs on its first joint.
#[test]
fn joints_without_weight_do_not_count() {
    let mut model = turning();
    let joints = model.accessor(&[0, 9, 9, 9, 0, 1, 9, 9, 1, 9, 9, 9], U8, "VEC4", 3);
    model.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = joints.into();
    for last in [7.0, 0.0] {
        let weights = model.floats("VEC4", &[0., 0., 0., 0., 1., 3., 0., 0., last, 0., 0., 0.]);
        model.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights.into();
        assert_near(&vertices(&model.scene(), 1.0), [[0.0, 5.0, 0.0], [0.625, 6.5, 0.0], [-0.5, 6.0, 0.0]]);
    }
}

/// Two nodes that show one mesh by one skin each have it for themselves; a third, without a skin, has it as it lies in the file.
#[test]
fn what_is_bent_is_nobody_elses() {
    let mut model = turning();
    for node in [json!({ "mesh": 0, "skin": 0 }), json!({ "mesh": 0 })] {
        model.node(node, true);
    }
    let scene = model.scene();
    let meshes: Vec<u32> = scene.objects.iter().map(|object| object.mesh).collect();
    assert_eq!((scene.deformed.len(), scene.skins.len(), meshes.len()), (2, 1, 3));
    assert!(meshes[0] != meshes[1] && meshes[1] != meshes[2] && meshes[0] != meshes[2], "{meshes:?}");
    assert!(!scene.objects[2].dynamic);
    assert_eq!(scene.meshes[meshes[2] as usize].positions[2], glam::Vec3::Y);
}

proptest! {
    #[test]
    fn weights_add_up_to_one(weights in prop::array::uniform8(prop_oneof![0.0..1.0f32, Just(0.0), Just(1e-30f32), Just(1e30f32)])) {
        let parts = weights_of_sum_one(weights);
        let sum: f64 = parts.iter().copied().map(f64::from).sum();
        prop_assert!((sum - 1.0).abs() <= 1.0 / 33_554_432.0 + 1e-15, "{weights:?} {parts:?} {sum}");
        prop_assert!(parts.iter().all(|part| (0.0..=1.0).contains(part)), "{weights:?} {parts:?}");
        let whole: f64 = weights.iter().copied().map(f64::from).sum();
        if whole > 0.0 {
            for (weight, part) in weights.into_iter().zip(parts) {
                prop_assert!((f64::from(weight) / whole - f64::from(part)).abs() < 2.5e-7, "{weights:?} {parts:?}");
            }
        }
    }
}
