//! Laws of what the `gltf` crate refuses, cuts or panics at, and the import must not.

use crate::compressed;
use crate::model::{assert_says, error, import, joined, Model};
use scenes::Projection;
use serde_json::json;

#[test]
fn indices_beyond_32_bits_are_refused() {
    let rich = || {
        let mut model = Model::triangle();
        let indices = model.accessor(&[0, 1, 2], 5121, "SCALAR", 3);
        model.json["meshes"][0]["primitives"][0]["indices"] = indices.into();
        model.json["meshes"][0]["primitives"][0]["material"] = 0.into();
        model.json["meshes"][0]["primitives"][0]["mode"] = 4.into();
        model.json["materials"] = json!([{}]);
        model
    };
    assert_eq!(rich().scene().objects.len(), 1);
    // Each is one that the file has, once its upper half is cut off.
    for (place, number) in [
        ("/scene", 0_u64),
        ("/scenes/0/nodes/0", 0),
        ("/nodes/0/mesh", 0),
        ("/meshes/0/primitives/0/attributes/POSITION", 0),
        ("/meshes/0/primitives/0/indices", 1),
        ("/meshes/0/primitives/0/material", 0),
        ("/meshes/0/primitives/0/mode", 4),
        ("/accessors/0/bufferView", 0),
        ("/accessors/0/componentType", 5126),
        ("/bufferViews/0/buffer", 0),
    ] {
        let mut model = rich();
        let beyond = number + (1 << 32);
        *model.json.pointer_mut(place).expect(place) = beyond.into();
        assert_says(&model.error(), &format!("of {beyond}, beyond 32 bits"));
    }
}

#[test]
fn long_numbers_that_are_no_indices_are_read() {
    let mut model = Model::triangle();
    model.json["nodes"][0]["translation"] = json!([12_345_678_901_u64, 0, 0]);
    model.json["accessors"][0]["max"] = json!([98_765_432_109_u64, 1, 0]);
    model.json["nodes"][0]["extras"] = json!({ "serial": 12_345_678_901_u64 });
    assert_eq!(model.scene().objects[0].world_from_object.translation.x, 12_345_678_901.0);
}

#[test]
fn lists_that_may_be_left_out_and_nulls_are_filled_in() {
    let mut model = Model::triangle();
    model.json["scenes"] = json!([{ "nodes": [0] }, { "name": "empty" }]);
    model.json["animations"] = json!([{ "name": "none" }, {
        "samplers": [{ "input": 0, "output": 0 }],
        "channels": [{ "sampler": 0, "target": { "path": "pointer", "extensions": { "KHR_animation_pointer": {} } } }],
    }]);
    model.json["cameras"] = json!([{ "type": "orthographic", "orthographic": { "ymag": 2, "znear": 0, "zfar": 9 } }]);
    model.json["nodes"][0]["camera"] = 0.into();
    model.json["materials"] = json!([{ "alphaMode": null, "pbrMetallicRoughness": { "baseColorFactor": null } }]);
    model.json["meshes"][0]["primitives"][0]["material"] = 0.into();
    let scene = model.scene();
    assert_eq!((scene.objects.len(), scene.objects[0].colour), (1, [1.0; 4]));
    assert_eq!(scene.cameras[0].projection, Projection::Orthographic { half_height: 2.0, near: 0.0, far: 9.0 });
    assert_eq!(scene.cameras[0].aspect, None, "it has no xmag");
    model.json["scene"] = 1.into();
    assert!(model.scene().objects.is_empty());
    // What is wrong besides is still said, not what has been filled in.
    model.json["materials"][0]["alphaMode"] = 3.into();
    let message = model.error();
    assert_says(&message, "integer `3`");
    assert!(!message.contains("missing"), "{message}");
}

#[test]
fn what_only_strangers_read_may_be_anything() {
    let mut model = Model::triangle();
    for place in ["/asset", "/nodes/0", "/meshes/0", "/meshes/0/primitives/0", "/accessors/0"] {
        let element = model.json.pointer_mut(place).expect(place);
        element["extras"] = json!("a text, not an object");
        element["extensions"] = json!({ "ACME_any": { "index": [1, 2.5, null] } });
    }
    // Attributes of unknown names, and strides and targets that break rules without harm.
    model.json["meshes"][0]["primitives"][0]["attributes"]["COLOUR"] = 77.into();
    model.json["meshes"][0]["primitives"][0]["attributes"]["_ID"] = 78.into();
    model.json["bufferViews"][0]["byteStride"] = 12.into();
    model.json["bufferViews"][0]["target"] = 7.into();
    assert_eq!(model.scene().meshes, Model::triangle().scene().meshes);
}

/// Integers written as decimals were refused (glTF 2.0, section 2.7, point 5).
#[test]
fn whole_numbers_may_be_decimals() {
    let mut model = Model::triangle();
    let indices = model.accessor(&[0, 1, 2], 5121, "SCALAR", 3);
    model.json["meshes"][0]["primitives"][0]["indices"] = indices.into();
    model.json["meshes"][0]["primitives"][0]["mode"] = 4.into();
    let places = model.floats("VEC3", &[1., 2., 3., 4., 5., 6.]);
    model.json["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    model.json["nodes"][0]["name"] = "3.0 and 4e0".into();
    let expected = model.scene();
    let text = model.json.to_string();
    let decimal = |ending: &str| {
        let mut in_string = false;
        let mut out = String::new();
        let mut letters = text.chars().peekable();
        while let Some(letter) = letters.next() {
            in_string ^= letter == '"';
            out.push(letter);
            let ends = letter.is_ascii_digit() && !letters.peek().is_some_and(char::is_ascii_digit);
            if ends && !in_string {
                out.push_str(ending);
            }
        }
        out
    };
    for ending in [".0", "e0", "E-0", ".000E+0"] {
        let json = decimal(ending);
        let scene = import(&joined(&json, &model.binary)).unwrap_or_else(|error| panic!("{ending}: {error}"));
        assert_eq!((&scene.meshes, &scene.objects), (&expected.meshes, &expected.objects), "{ending}");
        let scene = import(&compressed::with_text(&json, &model.binary)).expect("a .gltf");
        assert_eq!(scene.meshes, expected.meshes, "{ending}");
    }
    // A number that is no integer is still refused, at its place.
    for (place, number) in
        [("\"mesh\":0", "\"mesh\":0.5"), ("\"count\":3", "\"count\":3.5"), ("\"mode\":4", "\"mode\":4.25")]
    {
        let message = error(&joined(&text.replacen(place, number, 1), &model.binary));
        assert_says(&message, "floating point");
    }
}

#[test]
fn extras_and_unknown_extensions_may_hold_any_number() {
    let mut model = Model::triangle();
    model.json["extras"] = json!({ "node": 12_345_678_901_234_567_u64, "source": 1e10, "deep": { "mesh": u64::MAX } });
    model.json["nodes"][0]["extensions"] = json!({ "ACME_ids": { "node": 12_345_678_901_234_567_u64 } });
    assert_eq!(model.scene().objects.len(), 1);
}
