//! Laws held by the glTF models of the Debian package assimp-testmodels.

use crate::model::assert_says;
use glam::{DMat4, DQuat, DVec3, Vec3};
use scenes::Scene;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn model(name: &str) -> PathBuf {
    let folder = Path::new("/usr/share/assimp/models/glTF2");
    assert!(folder.is_dir(), "{} is missing; run: sudo apt-get install assimp-testmodels", folder.display());
    folder.join(name)
}

fn scene(name: &str) -> Scene {
    scenes::import(&model(name)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_legal_model_is_read() {
    let cases = [
        ("2CylinderEngine-glTF-Binary/2CylinderEngine.glb", 115, 121_496),
        ("BoxBadNormals-glTF-Binary/BoxBadNormals.glb", 1, 12),
        ("BoxTexcoords-glTF/boxTexcoords.gltf", 1, 12),
        ("BoxTextured-glTF/BoxTextured.gltf", 1, 12),
        ("BoxTextured-glTF-Binary/BoxTextured.glb", 1, 12),
        ("BoxTextured-glTF-Embedded/BoxTextured.gltf", 1, 12),
        ("BoxTextured-glTF-pbrSpecularGlossiness/BoxTextured.gltf", 1, 12),
        ("ClearCoat-glTF/ClearCoatTest.gltf", 27, 37_116),
        ("TestNoRootNode/NoScene.gltf", 0, 0),
        ("TestNoRootNode/SceneWithoutNodes.gltf", 0, 0),
        ("cameras/Cameras.gltf", 1, 2),
        ("glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf", 1, 12),
        ("issue_3269/texcoord_crash.gltf", 5, 10),
        ("simple_skin/simple_skin.gltf", 1, 8),
        ("textureTransform/TextureTransformTest.gltf", 12, 24),
    ];
    for (name, objects, triangles) in cases {
        let scene = scene(name);
        let indices: usize = scene.objects.iter().map(|object| scene.meshes[object.mesh as usize].indices.len()).sum();
        assert_eq!((scene.objects.len(), indices / 3), (objects, triangles), "{name}");
        for mesh in &scene.meshes {
            assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5), "{name}: '{}'", mesh.name);
        }
    }
}

/// Draco drops triangles that have a corner twice, and rounds positions; the rest is the same.
#[test]
fn the_engine_that_draco_has_compressed_is_the_engine() {
    let [plain, compressed] =
        ["2CylinderEngine-glTF-Binary/2CylinderEngine.glb", "draco/2CylinderEngine.gltf"].map(scene);
    assert_eq!(plain.objects.len(), compressed.objects.len());
    let triangles = |scene: &Scene| -> usize {
        scene.objects.iter().map(|object| scene.meshes[object.mesh as usize].indices.len() / 3).sum()
    };
    assert_eq!((triangles(&plain), triangles(&compressed)), (121_496, 110_336));
    for (a, b) in plain.objects.iter().zip(&compressed.objects) {
        assert_eq!((&a.name, a.colour), (&b.name, b.colour));
        assert!(a.world_from_object.abs_diff_eq(b.world_from_object, 1e-12), "{}", a.name);
        let [a, b] = [(&plain, a), (&compressed, b)].map(|(scene, object)| scene.meshes[object.mesh as usize].bounds());
        let most = (a.max - a.min).max_element() / 2048.0;
        assert!(a.min.abs_diff_eq(b.min, most) && a.max.abs_diff_eq(b.max, most), "{a:?} {b:?}");
    }
}

#[test]
fn every_primitive_mode_of_the_asset_generator_is_read() {
    for index in 0..16 {
        scene(&format!("glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_{index:02}.gltf"));
    }
}

#[test]
fn every_broken_model_is_refused_with_its_fault() {
    let cases = [
        ("BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "the position of vertex 0 is not finite"),
        ("IncorrectVertexArrays/Cube.gltf", "mesh 1 'TruncatedCube', primitive 0: 35 vertices cannot form triangles"),
        ("IndexOutOfRange/AllIndicesOutOfRange.gltf", "refers to vertex 65535, but it has 24"),
        ("IndexOutOfRange/IndexOutOfRange.gltf", "refers to vertex 255, but it has 24"),
        ("MissingBin/BoxTextured.gltf", "'BoxTextured0.bin'"),
        ("RecursiveNodes/RecursiveNodes.gltf", "node 0 is its own ancestor"),
        ("SchemaFailures/sceneWrongType.gltf", "string \"hello\", expected an index at line 6"),
        ("wrongTypes/badArray.gltf", "expected a sequence at line 44"),
        ("wrongTypes/badExtension.gltf", "\"Not an object\", expected an object at line 130"),
        ("wrongTypes/badNumber.gltf", "\"not a number\", expected a number at line 132"),
        ("wrongTypes/badObject.gltf", "at line 125"),
        ("wrongTypes/badString.gltf", "`42`, expected a string at line 12"),
        ("wrongTypes/badUint.gltf", "`-1`, expected an index at line 128"),
        ("BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf", "KHR_technique_webgl is not supported; "),
    ];
    for (name, text) in cases {
        let path = model(name);
        let message = scenes::import(&path).expect_err(name).to_string();
        assert_says(&message, text);
        assert!(message.contains(path.to_str().expect("UTF-8")) && !message.contains('\n'), "{message}");
    }
}

/// A .glb's JSON and data.
fn parts(file: &[u8]) -> (Value, &[u8]) {
    let length = u32::from_le_bytes(file[12..16].try_into().expect("four bytes")) as usize;
    let json = serde_json::from_slice(&file[20..20 + length]).expect("JSON");
    (json, &file[20 + length + 8..])
}

/// The bytes from the start of an accessor's data on, and how many elements there are.
fn data<'a>(json: &Value, binary: &'a [u8], accessor: &Value) -> (&'a [u8], usize) {
    let accessor = &json["accessors"][accessor.as_u64().expect("an index") as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().expect("an index") as usize];
    let offset = |value: &Value| value["byteOffset"].as_u64().unwrap_or(0) as usize;
    (&binary[offset(view) + offset(accessor)..], accessor["count"].as_u64().expect("a count") as usize)
}

/// World from node, for the node and all below it.
fn places(json: &Value, node: usize, world_from_parent: DMat4, found: &mut BTreeMap<usize, DMat4>) {
    let at = &json["nodes"][node];
    let numbers =
        |key: &str| -> Vec<f64> { at[key].as_array().into_iter().flatten().filter_map(Value::as_f64).collect() };
    let local = <[f64; 16]>::try_from(numbers("matrix")).map_or_else(
        |_| {
            let vector = |key: &str, otherwise| <[f64; 3]>::try_from(numbers(key)).map_or(otherwise, DVec3::from_array);
            let turn = <[f64; 4]>::try_from(numbers("rotation")).map_or(DQuat::IDENTITY, DQuat::from_array);
            DMat4::from_scale_rotation_translation(
                vector("scale", DVec3::ONE),
                turn,
                vector("translation", DVec3::ZERO),
            )
        },
        |columns| DMat4::from_cols_array(&columns),
    );
    found.insert(node, world_from_parent * local);
    for child in at["children"].as_array().into_iter().flatten() {
        places(json, child.as_u64().expect("an index") as usize, world_from_parent * local, found);
    }
}

/// The same files read here, byte by byte, which shares no code with the import or the `gltf` crate. All are of floats and 16-bit
/// indices without strides.
#[test]
fn positions_indices_and_places_are_those_of_the_bytes() {
    for name in ["2CylinderEngine-glTF-Binary/2CylinderEngine.glb", "BoxTextured-glTF-Binary/BoxTextured.glb"] {
        let file = std::fs::read(model(name)).expect("a model");
        let (json, binary) = parts(&file);
        let mut found = BTreeMap::new();
        for root in json["scenes"][0]["nodes"].as_array().expect("roots") {
            places(&json, root.as_u64().expect("an index") as usize, DMat4::IDENTITY, &mut found);
        }
        let scene = scene(name);
        let mut objects = scene.objects.iter();
        for (node, world_from_node) in found {
            let Some(mesh) = json["nodes"][node]["mesh"].as_u64() else { continue };
            for primitive in json["meshes"][mesh as usize]["primitives"].as_array().expect("primitives") {
                let object = objects.next().expect("as many objects");
                let read = &scene.meshes[object.mesh as usize];
                let (bytes, count) = data(&json, binary, &primitive["attributes"]["POSITION"]);
                let float = |at: usize| f32::from_le_bytes(bytes[4 * at..4 * at + 4].try_into().expect("four bytes"));
                let positions = (0..count).map(|at| Vec3::new(float(3 * at), float(3 * at + 1), float(3 * at + 2)));
                assert_eq!(read.positions, positions.collect::<Vec<_>>(), "{name}: '{}'", object.name);
                let (bytes, count) = data(&json, binary, &primitive["indices"]);
                let indices = (0..count).map(|at| u32::from(bytes[2 * at]) | u32::from(bytes[2 * at + 1]) << 8);
                assert_eq!(read.indices, indices.collect::<Vec<_>>(), "{name}: '{}'", object.name);
                let place = DMat4::from(object.world_from_object);
                assert!(
                    place.abs_diff_eq(world_from_node, 1e-9),
                    "{name}: '{}' {place} {world_from_node}",
                    object.name
                );
            }
        }
        assert!(objects.next().is_none());
    }
}
