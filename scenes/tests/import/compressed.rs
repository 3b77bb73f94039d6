//! Laws of compressed geometry: it reads like the uncompressed data, within the rounding of the codec, and nothing in a stream or
//! beside it is trusted.

use crate::corpus::{draco, draco_positions, draco_stream, grid, meshopt};
use crate::model::{assert_says, warnings, Model};
use base64::engine::general_purpose::STANDARD;
use base64::Engine;
use glam::Vec3;
use scenes::Scene;
use serde_json::{json, Value};

const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// A .gltf with its data in base64.
pub fn with_text(json: &str, data: &[u8]) -> Vec<u8> {
    let uri = format!("\"uri\":\"data:;base64,{}\",\"byteLength\":", STANDARD.encode(data));
    let (before, after) = json.split_once("\"buffers\":[{").expect("a buffer");
    format!("{before}\"buffers\":[{{{}", after.replacen("\"byteLength\":", &uri, 1)).into_bytes()
}

/// The corners of each triangle, in order, each triangle from its smallest corner on.
fn triangles(scene: &Scene, object: usize) -> Vec<[[i32; 3]; 3]> {
    let mesh = &scene.meshes[scene.objects[object].mesh as usize];
    let whole = |position: Vec3| (position * 1000.0).round().as_ivec3().to_array();
    let corner = |index: u32| whole(mesh.positions[index as usize]);
    let mut all: Vec<[[i32; 3]; 3]> =
        mesh.indices.chunks_exact(3).map(|face| [corner(face[0]), corner(face[1]), corner(face[2])]).collect();
    for corners in &mut all {
        let least = (0..3).min_by_key(|at| corners[*at]).unwrap_or(0);
        corners.rotate_left(least);
    }
    all.sort_unstable();
    all
}

/// The grid without compression.
fn plain() -> Scene {
    let (corners, triangles) = grid();
    let mut model = Model::new();
    let positions = model.floats("VEC3", corners.as_flattened());
    let bytes: Vec<u8> = triangles.iter().flat_map(|corner| corner.to_le_bytes()).collect();
    let indices = model.accessor(&bytes, 5125, "SCALAR", triangles.len());
    model.mesh(json!({ "attributes": { "POSITION": positions }, "indices": indices }));
    model.node(json!({ "mesh": 0 }), true);
    model.scene()
}

#[test]
fn meshopt_reads_as_what_was_compressed() {
    for extension in MESHOPT {
        let scene = meshopt(extension).scene();
        assert_eq!(triangles(&scene, 0), triangles(&plain(), 0), "{extension}");
        assert_eq!(triangles(&scene, 1).len(), 4, "the strip");
        let mesh = &scene.meshes[0];
        assert!(mesh.normals.iter().all(|normal| normal.abs_diff_eq(Vec3::new(0.0, 0.6, 0.8), 0.02)), "octahedral");
        if extension.starts_with("KHR") {
            assert!(
                mesh.colours
                    .iter()
                    .all(|colour| colour.iter().zip([0.0, 1.0, 0.0, 1.0]).all(|(a, b)| (a - b).abs() < 0.008)),
                "{:?}",
                mesh.colours
            );
        }
        // At half of the time, half of the half turn about y of its quaternions.
        let mut places = Vec::new();
        scene.motion.transforms_at(0.5, &mut places);
        assert!(places[0].1.transform_vector3(glam::DVec3::X).abs_diff_eq(glam::DVec3::NEG_Z, 1e-3), "quaternions");
    }
}

#[test]
fn draco_reads_as_what_was_compressed() {
    for speed in [0, 3, 6, 10] {
        let scene = draco(speed).scene();
        assert_eq!(triangles(&scene, 0).len(), triangles(&plain(), 0).len(), "speed {speed}");
        let (mesh, skinned) = (&scene.meshes[0], &scene.deformed[0]);
        for (at, vertex) in skinned.rest.iter().enumerate() {
            // Positions are rounded to 14 bits; the other attributes tell which vertex it is.
            let [x, y] = [vertex.position.x, vertex.position.y].map(|number| (number * 4.0).round() as usize);
            assert!(vertex.position.abs_diff_eq(Vec3::from(grid().0[y * 5 + x]), 1e-3), "speed {speed}");
            assert_eq!((vertex.joints[0], vertex.weights[0]), (((y * 5 + x) % 2) as u32, 1.0), "speed {speed}");
            assert!(vertex.normal.abs_diff_eq(Vec3::new(0.0, 0.6, 0.8), 0.02), "speed {speed}");
            assert!(mesh.indices.iter().any(|index| *index as usize == at), "speed {speed}: vertex {at}");
        }
    }
}

#[test]
fn primitives_may_share_streams_but_not_mix_them() {
    let mut model = draco(6);
    let half: Vec<[f32; 3]> = grid().0.iter().map(|corner| corner.map(|number| number / 2.0)).collect();
    let other = model.view(&draco_stream(&half, &grid().1, 6));
    let mut primitive = model.json["meshes"][0]["primitives"][0].clone();
    model.mesh(primitive.clone());
    primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = other.into();
    model.mesh(primitive);
    for mesh in [1, 2] {
        model.node(json!({ "mesh": mesh }), true);
    }
    let scene = model.scene();
    let width = |object: usize| scene.meshes[scene.objects[object].mesh as usize].bounds().max.x;
    // The first object is bent.
    assert!((width(1) - 1.0).abs() < 1e-3 && (width(2) - 0.5).abs() < 1e-3, "{} {}", width(1), width(2));
}

#[test]
fn uncompressed_copies_are_read_where_there_are_any() {
    // Draco, used and not required: a primitive whose accessors have bytes needs no stream.
    let mut model = Model::triangle();
    model.json["meshes"][0]["primitives"][0]["extensions"] =
        json!({ "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": { "POSITION": 0 } } });
    model.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    assert_eq!(model.scene().meshes, Model::triangle().scene().meshes);
    model.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    assert_says(&model.error(), "mesh 0, primitive 0: KHR_draco_mesh_compression: its stream cannot be decoded");
    // Meshopt: the stream is broken, and the uncompressed copy is there.
    let mut model = Model::triangle();
    model.json["bufferViews"][0]["extensions"] = json!({ "EXT_meshopt_compression": {
        "buffer": 0, "byteLength": 20, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES" } });
    let (scene, warnings) = warnings(|| model.scene());
    assert_eq!(scene.meshes, Model::triangle().scene().meshes);
    assert_says(&warnings.join("|"), "its uncompressed copy is read instead: buffer view 0");
}

#[test]
fn fallback_buffers_may_be_missing() {
    for uri in [None, Some("gone.bin"), Some("https://example.invalid/gone.bin")] {
        let mut model = meshopt("EXT_meshopt_compression");
        if let Some(uri) = uri {
            model.json["buffers"][1]["uri"] = uri.into();
        }
        assert_eq!(model.scene().objects.len(), 2, "{uri:?}");
    }
    // A fallback buffer does not take the data chunk.
    let mut model = meshopt("EXT_meshopt_compression");
    let stored = model.json["buffers"][0].clone();
    let data = STANDARD.encode(&model.binary);
    model.json["buffers"] = json!([model.json["buffers"][1], stored]);
    model.json["buffers"][1]["uri"] = format!("data:;base64,{data}").into();
    for view in model.json["bufferViews"].as_array_mut().expect("a list") {
        view["buffer"] = (1 - view["buffer"].as_u64().expect("an index")).into();
        if let Some(compressed) = view.pointer_mut("/extensions/EXT_meshopt_compression/buffer") {
            *compressed = 1.into();
        }
    }
    assert_eq!(model.scene().objects.len(), 2);
}

#[test]
fn broken_meshopt_is_refused_by_its_view() {
    let cases: [(&str, Value, &str); 10] = [
        ("byteLength", json!(10), "cannot be decoded"),
        ("count", json!(2500), "2500 elements of 12 bytes in mode ATTRIBUTES cannot be decoded"),
        ("count", json!(1_u64 << 40), "it decodes to more than 256 times its size"),
        ("byteStride", json!(13), "cannot be decoded"),
        ("mode", json!("POINTS"), "its mode 'POINTS' is none of"),
        ("filter", json!("BLUR"), "its filter 'BLUR' is none of"),
        ("filter", json!("QUATERNION"), "cannot be decoded"),
        ("buffer", json!(7), "it refers to buffer 7, but the file has 2"),
        ("buffer", json!(1), "buffer 1 has no data"),
        ("byteLength", json!(1_000_000), "do not fit into buffer 0"),
    ];
    for (key, value, text) in cases {
        let mut model = meshopt("EXT_meshopt_compression");
        model.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
        let message = model.error();
        assert_says(&message, "EXT_meshopt_compression");
        assert_says(&message, text);
    }
    // A decoded index beyond the vertices is refused like any other.
    let mut model = meshopt("EXT_meshopt_compression");
    model.json["accessors"][0]["count"] = 3.into();
    model.json["accessors"][1]["count"] = 3.into();
    assert_says(&model.error(), "refers to vertex");
    model.json["accessors"][0]["count"] = 26.into();
    assert_says(&model.error(), "do not fit into buffer view 0");
}

#[test]
fn broken_draco_is_refused_by_its_primitive() {
    type Change = fn(&mut Model);
    let cases: [(Change, &str); 7] = [
        (|model| model.json["accessors"][0]["count"] = 3.into(), ""),
        (
            |model| (0..5).for_each(|at| model.json["accessors"][at]["count"] = 3.into()),
            "has 25 vertices, but its accessors have 3",
        ),
        (|model| model.json["accessors"][5]["count"] = 9.into(), "its stream holds more than its accessors say"),
        (|model| model.json["accessors"][0]["type"] = "VEC2".into(), "it has 3 numbers a vertex instead of 2"),
        (
            |model| model.json["accessors"][0]["componentType"] = 5121.into(),
            "does not fit its accessor's component type",
        ),
        (|model| extension(model)["attributes"]["POSITION"] = 77.into(), "its stream has no attribute 77"),
        (|model| extension(model)["bufferView"] = 77.into(), "it refers to buffer view 77"),
    ];
    for (change, text) in cases {
        let mut model = draco(6);
        change(&mut model);
        match model.import() {
            // A wrong count of one attribute is corrected.
            Ok(scene) => assert_eq!((text, scene.objects.len()), ("", 1)),
            Err(error) => {
                assert_says(&error.to_string(), text);
                assert_says(&error.to_string(), "mesh 0, primitive 0: KHR_draco_mesh_compression");
            }
        }
    }
}

fn extension(model: &mut Model) -> &mut Value {
    &mut model.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
}

/// A regular grid of equal positions takes very few bytes, so a small stream could ask for any amount of memory.
#[test]
fn a_small_stream_cannot_ask_for_much_memory() {
    const SIDE: u32 = 1200;
    let corners = vec![[1.0, 2.0, 3.0]; (SIDE * SIDE) as usize];
    let cells = (0..(SIDE - 1) * (SIDE - 1)).map(|at| at % (SIDE - 1) + at / (SIDE - 1) * SIDE);
    let triangles: Vec<u32> = cells.flat_map(|a| [a, a + 1, a + SIDE, a + 1, a + SIDE + 1, a + SIDE]).collect();
    let mut model = draco(6);
    let stream = draco_positions(&corners, &triangles, 0);
    assert!(stream.len() < 100_000, "{}", stream.len());
    extension(&mut model)["bufferView"] = model.view(&stream[..]).into();
    extension(&mut model)["attributes"] = json!({ "POSITION": 0 });
    model.json["meshes"][0]["primitives"][0]["attributes"] = json!({ "POSITION": 0 });
    model.json["nodes"][0] = json!({ "mesh": 0 });
    model.json["accessors"][0]["count"] = corners.len().into();
    model.json["accessors"][5]["count"] = triangles.len().into();
    let message = model.error();
    assert!(
        message.contains("256 times its size") || message.contains("than a file of this size may decode to"),
        "{message}"
    );
}

/// Many views over the same bytes cost the time to read these, even if each stream is broken and has an uncompressed copy.
#[test]
fn broken_streams_spend_the_budget_too() {
    let with = |views: usize| {
        let mut model = Model::triangle();
        let stream = model.view(&[0; 100_000]);
        let offset = model.json["bufferViews"][stream]["byteOffset"].clone();
        let compressed = json!({ "buffer": 0, "byteOffset": offset, "byteLength": 100_000, "byteStride": 4, "count": 3,
            "mode": "ATTRIBUTES" });
        let view = json!({ "buffer": 0, "byteLength": 12, "extensions": { "EXT_meshopt_compression": compressed } });
        model.json["bufferViews"].as_array_mut().expect("a list").extend(vec![view; views]);
        model
    };
    let (scene, warnings) = warnings(|| with(10).scene());
    assert_eq!((scene.objects.len(), warnings.len()), (1, 10));
    assert_says(&with(400).error(), "256 times its size");
}
