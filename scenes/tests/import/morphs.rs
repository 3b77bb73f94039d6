//! Laws of morph targets: static weights become part of the mesh, animated weights are played, and broken ones are refused.

use crate::model::{assert_says, warnings, Model, FLOAT, U8};
use crate::skins::{assert_near, skinned, turning, vertices_of};
use glam::{DVec3, Vec3};
use scenes::Scene;
use serde_json::{json, Value};
use std::path::Path;

/// Adds a morph target of POSITION to the only primitive.
fn add_target(model: &mut Model, deltas: &[f32]) -> usize {
    let accessor = model.floats("VEC3", deltas);
    let targets = &mut model.json["meshes"][0]["primitives"][0]["targets"];
    match targets.as_array_mut() {
        Some(targets) => targets.push(json!({ "POSITION": accessor })),
        None => *targets = json!([{ "POSITION": accessor }]),
    }
    accessor
}

/// A triangle with two targets, on a node at (0, 0, 10): the first lifts its first vertex by 4 along z, the second its second by 2 along y.
fn morphing() -> Model {
    let mut model = Model::triangle();
    add_target(&mut model, &[0., 0., 4., 0., 0., 0., 0., 0., 0.]);
    add_target(&mut model, &[0., 0., 0., 0., 2., 0., 0., 0., 0.]);
    model.json["nodes"][0] = json!({ "mesh": 0, "translation": [0, 0, 10], "name": "face" });
    model
}

fn played(interpolation: &str, times: &[f32], weights: &[f32]) -> Model {
    let mut model = morphing();
    let (input, output) = (model.floats("SCALAR", times), model.floats("SCALAR", weights));
    model.channel(0, "weights", interpolation, input, output);
    model
}

/// Returns how far the first vertex is lifted along z and the second along y, at a time.
fn lifted(scene: &Scene, seconds: f64) -> [f64; 2] {
    let vertices = vertices_of(scene, 0, seconds);
    [vertices[0].z - 10.0, vertices[1].y]
}

#[track_caller]
fn assert_lifted(scene: &Scene, seconds: f64, expected: [f64; 2]) {
    let found = lifted(scene, seconds);
    let near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-5);
    assert!(near, "{found:?} is not {expected:?}, at {seconds}");
}

#[test]
fn lines_of_weights_are_played() {
    let scene = played("LINEAR", &[1., 3.], &[0., 0.5, 1., -1.]).scene();
    assert!(scene.objects[0].dynamic && scene.check().is_ok());
    assert_eq!(scene.motion.duration_s(), (1.0, 3.0));
    for (seconds, expected) in
        [(0.0, [0.0, 1.0]), (1.0, [0.0, 1.0]), (2.0, [2.0, -0.5]), (3.0, [4.0, -2.0]), (9.0, [4.0, -2.0])]
    {
        assert_lifted(&scene, seconds, expected);
    }
    // The scene's own mesh is that of time 0.
    assert_eq!(scene.meshes[0].positions[1], Vec3::new(1.0, 1.0, 0.0));
}

#[test]
fn steps_and_splines_of_weights_are_played() {
    let scene = played("STEP", &[0., 2.], &[1., 0., 0., 3.]).scene();
    for (seconds, expected) in [(0.0, [4.0, 0.0]), (1.99, [4.0, 0.0]), (2.0, [0.0, 6.0])] {
        assert_lifted(&scene, seconds, expected);
    }
    // In-tangents of both targets, their weights, their out-tangents; then those of the next key.
    let keys = [0., 0., 0., 1., 3., 0., -3., 0., 0., 1., 0., 0.];
    let scene = played("CUBICSPLINE", &[0., 2.], &keys).scene();
    // At half way: the mean of both weights, and an eighth of the time between keys times the difference of the tangents.
    for (seconds, expected) in [(0.0, [0.0, 2.0]), (1.0, [6.0, 2.0]), (2.0, [0.0, 2.0])] {
        assert_lifted(&scene, seconds, expected);
    }
    // The second weight is 1 at both keys, without tangents. It still counts as animated: the import does not compare tangents.
    assert_eq!(scene.deformed[0].targets.len(), 2);
}

/// Weights of 8 bits are fractions; weights that never change are no animation.
#[test]
fn weights_that_never_change_are_part_of_the_mesh() {
    let mut model = morphing();
    let (input, output) = (model.floats("SCALAR", &[0., 1.]), model.accessor(&[255, 51, 255, 51], U8, "SCALAR", 4));
    model.json["accessors"][output]["normalized"] = true.into();
    model.channel(0, "weights", "LINEAR", input, output);
    let scene = model.scene();
    assert!(scene.deformed.is_empty() && !scene.objects[0].dynamic);
    assert_lifted(&scene, 0.0, [4.0, 0.4]);
    // A weight that changes is animated, beside one that does not.
    let scene = played("LINEAR", &[0., 1.], &[0.5, 0., 0.5, 1.]).scene();
    assert_eq!((scene.deformed.len(), scene.deformed[0].targets.len()), (1, 1));
    assert_lifted(&scene, 1.0, [2.0, 2.0]);
}

/// The node's weights come before the mesh's, and a channel before both.
#[test]
fn default_weights_yield_to_animated_ones() {
    let mut model = played("LINEAR", &[0., 1.], &[0., 0., 1., 1.]);
    model.json["meshes"][0]["weights"] = json!([0.25, 0.25]);
    model.node(json!({ "mesh": 0, "translation": [0, 0, 10], "weights": [0.5, 0] }), true);
    model.node(json!({ "mesh": 0, "translation": [0, 0, 10] }), true);
    let scene = model.scene();
    assert_lifted(&scene, 0.5, [2.0, 1.0]);
    assert_near(&vertices_of(&scene, 1, 0.5), [[0.0, 0.0, 12.0], [1.0, 0.0, 10.0], [0.0, 1.0, 10.0]]);
    assert_near(&vertices_of(&scene, 2, 0.5), [[0.0, 0.0, 11.0], [1.0, 0.5, 10.0], [0.0, 1.0, 10.0]]);
    let dynamic: Vec<bool> = scene.objects.iter().map(|object| object.dynamic).collect();
    assert_eq!(dynamic, [true, false, false]);
}

/// Twelve targets at once, each of which lifts one vertex; a thirteenth lifts none, and costs nothing.
#[test]
fn any_number_of_targets_is_played() {
    let mut model = Model::triangle();
    for target in 0..13 {
        let mut deltas = [0.0; 9];
        deltas[3 * (target % 3) + 2] = if target < 12 { 1.0 } else { 0.0 };
        add_target(&mut model, &deltas);
    }
    let keys: Vec<f32> = (0..26).map(|key| if key < 13 { 0.0 } else { (key - 12) as f32 }).collect();
    let (input, output) = (model.floats("SCALAR", &[0., 1.]), model.floats("SCALAR", &keys));
    model.channel(0, "weights", "LINEAR", input, output);
    // Without normals of its own, a mesh has computed normals, which would change all over the triangle.
    let normals = model.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    model.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals.into();
    let scene = model.scene();
    assert_eq!(scene.deformed[0].targets.len(), 12);
    assert!(scene.deformed[0].targets.iter().all(|target| target.displacements.len() == 1), "only what moves is kept");
    // 1 + 4 + 7 + 10, and so on.
    assert_near(&vertices_of(&scene, 0, 1.0), [[0.0, 0.0, 22.0], [1.0, 0.0, 26.0], [0.0, 1.0, 30.0]]);
}

/// Each instance of a node has the node's shape, at its own place; all share one mesh.
#[test]
fn instances_share_the_weights_of_their_node() {
    let mut model = played("LINEAR", &[0., 1.], &[0., 0., 1., 1.]);
    let places = model.floats("VEC3", &[0., 0., 0., 7., 0., 0.]);
    model.json["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    let scene = model.scene();
    assert_eq!((scene.objects.len(), scene.deformed.len()), (2, 1));
    assert_near(&vertices_of(&scene, 0, 1.0), [[0.0, 0.0, 14.0], [1.0, 2.0, 10.0], [0.0, 1.0, 10.0]]);
    assert_near(&vertices_of(&scene, 1, 1.0), [[7.0, 0.0, 14.0], [8.0, 2.0, 10.0], [7.0, 1.0, 10.0]]);
}

/// Morphs first, then bends (glTF 3.7.2.2): the third vertex is lifted by 1 along y, and then goes with the upper joint, which turns.
#[test]
fn morphed_vertices_are_bent() {
    for (mut model, expected) in [
        (skinned(), [[0.0, 5.0, 0.0], [1.0, 5.375, 0.0], [0.0, 7.5, 0.0]]),
        (turning(), [[0.0, 5.0, 0.0], [0.625, 6.5, 0.0], [-1.5, 6.0, 0.0]]),
    ] {
        add_target(&mut model, &[0., 0., 0., 0., 0., 0., 0., 1., 0.]);
        let (input, output) = (model.floats("SCALAR", &[0., 1.]), model.floats("SCALAR", &[0., 1.]));
        model.channel(0, "weights", "LINEAR", input, output);
        let scene = model.scene();
        assert!(scene.objects[0].dynamic && scene.check().is_ok());
        assert_near(&vertices_of(&scene, 0, 0.0), [[0.0, 5.0, 0.0], [1.0, 5.375, 0.0], [0.0, 6.5, 0.0]]);
        assert_near(&vertices_of(&scene, 0, 1.0), expected);
    }
}

/// Positions without data are zeros; morph targets give them a shape.
#[test]
fn positions_of_zeros_may_be_morphed() {
    let mut model = Model::triangle();
    let zeros = model.bare_accessor(json!({ "componentType": FLOAT, "type": "VEC3", "count": 3 }));
    model.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = zeros.into();
    let (scene, heard) = warnings(|| model.scene());
    assert_near(&vertices_of(&scene, 0, 0.0), [[0.0; 3]; 3]);
    assert_says(&heard.join("|"), "its POSITION has no data");
    add_target(&mut model, &[0., 0., 0., 2., 0., 0., 0., 2., 0.]);
    model.json["meshes"][0]["weights"] = json!([0.5]);
    assert_near(&vertices_of(&model.scene(), 0, 0.0), [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
}

/// Targets may have normals alone, be sparse, or of normalised bytes.
#[test]
fn targets_of_every_form_are_read() {
    let mut model = Model::triangle();
    let normals = model.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    model.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals.into();
    let turned = model.floats("VEC3", &[1., 0., 0., 0., 0., 0., 0., 0., 0.]);
    let (at, values) = (model.view(&[1]), model.view(&[0f32, 0., 3.].map(f32::to_le_bytes).concat()));
    let sparse = model.bare_accessor(json!({ "componentType": FLOAT, "type": "VEC3", "count": 3, "sparse": {
        "count": 1, "indices": { "bufferView": at, "componentType": U8 }, "values": { "bufferView": values } } }));
    // Elements of three bytes, four apart.
    let bytes = model.accessor(&[0, 0, 0, 0, 0, 0, 0, 0, 0, 127, 0, 0], 5120, "VEC3", 3);
    model.json["accessors"][bytes]["normalized"] = true.into();
    let view = model.json["accessors"][bytes]["bufferView"].as_u64().expect("a view") as usize;
    model.json["bufferViews"][view]["byteStride"] = 4.into();
    let targets: Value = json!([{ "NORMAL": turned }, { "POSITION": sparse }, { "POSITION": bytes }]);
    model.json["meshes"][0]["primitives"][0]["targets"] = targets;
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 3.0], [0.0, 2.0, 0.0]];
    let normal = Vec3::new(1.0, 0.0, 1.0).normalize();
    let mut fixed = Model { json: model.json.clone(), binary: model.binary.clone() };
    fixed.json["meshes"][0]["weights"] = json!([1, 1, 1]);
    let fixed = fixed.scene();
    assert_near(&vertices_of(&fixed, 0, 0.0), expected);
    assert!(fixed.meshes[0].normals[0].abs_diff_eq(normal, 1e-6));
    let (input, output) = (model.floats("SCALAR", &[0., 1.]), model.floats("SCALAR", &[0., 0., 0., 1., 1., 1.]));
    model.channel(0, "weights", "LINEAR", input, output);
    let scene = model.scene();
    assert_near(&vertices_of(&scene, 0, 1.0), expected);
    assert!(scene.meshes_at(1.0)[0].normals[0].abs_diff_eq(normal, 1e-6));
    assert_eq!(scene.meshes_at(0.0)[0].normals[0], Vec3::Z);
}

/// A mesh without normals gets them from its triangles. Its targets get theirs from the displaced triangles.
#[test]
fn normals_that_are_computed_follow_their_triangle() {
    let mut model = Model::triangle();
    // The third vertex goes from +y to +z: the triangle faces -y then, not +z.
    add_target(&mut model, &[0., 0., 0., 0., 0., 0., 0., -1., 1.]);
    let (input, output) = (model.floats("SCALAR", &[0., 1.]), model.floats("SCALAR", &[0., 1.]));
    model.channel(0, "weights", "LINEAR", input, output);
    let scene = model.scene();
    let normal = |seconds: f64| scene.meshes_at(seconds)[0].normals[1];
    assert!(normal(0.0).abs_diff_eq(Vec3::Z, 1e-6) && normal(1.0).abs_diff_eq(Vec3::NEG_Y, 1e-6), "{}", normal(1.0));
    assert!(normal(0.5).abs_diff_eq(Vec3::new(0.0, -1.0, 1.0).normalize(), 1e-6));
}

#[test]
fn broken_weights_are_refused() {
    let error = |weights: &[f32]| played("LINEAR", &[0., 1.], weights).error();
    let few = error(&[0., 0., 1.]);
    assert_says(
        &few,
        "animation 0, channel 0: node 0 'face': 3 weights for 2 keys of 2 morph targets, which need 1 each",
    );
    assert_says(&error(&[0., 0., f32::NAN, 1.]), "node 0 'face': a time or value is not a finite number");
    assert_says(&error(&[0., 0., f32::INFINITY, 1.]), "node 0 'face': a time or value is not a finite number");
    assert_says(&error(&[0., 0., 3e38, 1.]), "object 'face': morph targets can take vertex 0 beyond the range");
    assert_says(
        &played("CUBICSPLINE", &[0., 1.], &[0.; 4]).error(),
        "4 weights for 2 keys of 2 morph targets, which need 3 each",
    );
    assert_says(&played("LINEAR", &[1., 0.], &[0.; 4]).error(), "the time of key 1 is before that of key 0");
    let mut model = played("LINEAR", &[0., 1.], &[0., 0., 1., 1.]);
    model.json["accessors"][1]["count"] = 2.into();
    assert_says(
        &model.error(),
        "mesh 0, primitive 0: morph target 0: POSITION: accessor 1 has 2 elements, but there are 3",
    );
    // Weights of a mesh without targets, and of a node without a mesh, mean nothing.
    let mut model = played("LINEAR", &[0., 1.], &[0., 0., 1.]);
    model.json["meshes"][0]["primitives"][0].as_object_mut().expect("a list").remove("targets");
    assert!(!model.scene().objects[0].dynamic);
}

/// Khronos' cube: a node whose mesh has two targets, the first of which thins it along z, the second along y, in turn.
#[test]
fn the_morph_cube_of_khronos_is_played() {
    let file = "/usr/share/assimp/models/glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf";
    let scene = scenes::import(Path::new(file)).expect("Debian's assimp-testmodels");
    assert_eq!((scene.deformed.len(), scene.deformed[0].targets.len()), (1, 2));
    let size = |seconds: f64| {
        let vertices = vertices_of(&scene, 0, seconds);
        let most = vertices.iter().copied().reduce(DVec3::max).expect("a cube");
        most - vertices.iter().copied().reduce(DVec3::min).expect("a cube")
    };
    let (first, last) = scene.motion.duration_s();
    let sizes: Vec<DVec3> = (0..9).map(|step| size(first + (last - first) * f64::from(step) / 8.0)).collect();
    assert!(sizes.iter().any(|size| !size.abs_diff_eq(sizes[0], 0.3 * sizes[0].max_element())), "{sizes:?}");
}
