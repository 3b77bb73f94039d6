//! Laws of containers, data files and versions.

use crate::model::{assert_says, error, import, warnings, Model};
use serde_json::json;
use std::path::{Path, PathBuf};

/// An empty folder of this test run.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("import-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for test files");
    folder
}

/// The triangle as a .gltf that looks for its data at `uri`.
fn triangle_at(uri: &str) -> Model {
    let mut model = Model::triangle();
    model.json["buffers"][0]["uri"] = uri.into();
    model
}

#[test]
fn a_missing_buffer_is_named() {
    let folder = folder("missing");
    let file = folder.join("scene.gltf");
    std::fs::write(&file, triangle_at("gone.bin").json.to_string()).expect("a test file");
    let message = scenes::import(&file).expect_err("a missing buffer").to_string();
    for text in ["scene.gltf: buffer 0", "'gone.bin'", "put it in the folder", folder.to_str().expect("UTF-8")] {
        assert_says(&message, text);
    }
    let message = scenes::import(&folder.join("none.glb")).expect_err("a missing file").to_string();
    assert_says(&message, "none.glb: cannot read it");
    std::fs::remove_dir_all(folder).expect("the folder made above");
}

#[test]
fn data_files_are_found_beside_the_scene() {
    let folder = folder("beside");
    let file = folder.join("scene.gltf");
    let model = triangle_at("my%20data.bin");
    std::fs::write(&file, model.json.to_string()).expect("a test file");
    std::fs::write(folder.join("my data.bin"), [&model.binary[..], b"more"].concat()).expect("a test file");
    let scene = scenes::import(&file).expect("a legal file");
    assert_eq!((scene.name.as_str(), scene.objects.len()), ("scene", 1));
    std::fs::write(folder.join("my data.bin"), &model.binary[..30]).expect("a test file");
    let message = scenes::import(&file).expect_err("a short buffer").to_string();
    assert_says(&message, "buffer 0: it should have 36 bytes, but there are 30");
    std::fs::remove_dir_all(folder).expect("the folder made above");
}

#[test]
fn base64_data_is_read() {
    // The corners of the triangle by an independent encoder (Python's base64).
    let text = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let scene =
        import(triangle_at(&format!("data:application/octet-stream;base64,{text}")).json.to_string().as_bytes());
    assert_eq!(scene.expect("a legal file").meshes, Model::triangle().scene().meshes);
    let refused = |uri: &str| error(triangle_at(uri).json.to_string().as_bytes());
    assert_says(&refused("data:;base64,AAAA"), "it should have 36 bytes, but there are 3");
    assert_says(&refused("data:;base64,AA*A"), "illegal character at 2");
    assert_says(&refused("data:;base64"), "no comma");
}

#[test]
fn only_plain_files_beside_the_scene_are_opened() {
    let refused = |uri: &str| error(triangle_at(uri).json.to_string().as_bytes());
    assert_says(
        &refused("https://example.invalid/a.bin"),
        "data at 'https://example.invalid/a.bin' is not supported; download",
    );
    assert_says(&refused("/dev/zero"), "not given relative to the scene");
    assert_says(&refused("../scenes"), "cannot be read");
}

#[test]
fn a_glb_cut_anywhere_is_refused() {
    let file = Model::triangle().glb();
    for length in 0..file.len() {
        error(&file[..length]);
    }
    assert_says(&error(&file[..40]), "was it cut off on the way?");
}

#[test]
fn wrong_lengths_in_a_glb_are_refused() {
    let file = Model::triangle().glb();
    let with = |at: usize, word: u32| [&file[..at], &word.to_le_bytes(), &file[at + 4..]].concat();
    let short = error(&with(8, 77));
    assert_says(&short, "its header says 77 bytes");
    assert!(!short.contains("cut off"), "there is more, not less: {short}");
    // Less than the header itself: the gltf crate subtracts without looking.
    assert_says(&error(&with(8, 3)), "its header says 3 bytes");
    assert_says(&error(b"glTF\x02\0\0\0\x0c\0\0\0"), "it ends at byte 12, inside a header");
    assert_says(&error(&with(12, u32::MAX)), "its chunk of JSON says 4294967295 bytes");
    assert_says(&error(&with(12, 4)), "made/here.glb");
    assert_says(&error(&with(16, 0)), "its first chunk is not JSON");
    assert_says(&error(&with(4, 1)), "glTF version 1.0 is not supported; convert it to glTF 2.0");
    assert_says(&error(&with(4, 9)), "glb version 9");
    let no_data = with(file.len() - 36 - 4, 0);
    assert_says(&error(&no_data), "buffer 0 has no data");
}

#[test]
fn chunks_for_extensions_are_ignored() {
    let file = Model::triangle().glb();
    let json_end = 20 + u32::from_le_bytes(file[12..16].try_into().expect("four bytes")) as usize;
    let with_length = |mut file: Vec<u8>| {
        let length = file.len() as u32;
        file[8..12].copy_from_slice(&length.to_le_bytes());
        file
    };
    let extra = b"\x04\0\0\0ACMEdata";
    let after = with_length([&file[..], extra].concat());
    assert_eq!(import(&after).expect("a legal file").meshes, Model::triangle().scene().meshes);
    // Data comes second or not at all.
    let before = with_length([&file[..json_end], extra, &file[json_end..]].concat());
    assert_says(&error(&before), "buffer 0 has no data");
}

#[test]
fn other_versions_and_unknown_extensions_are_named() {
    let mut model = Model::triangle();
    model.json["asset"] = json!({ "version": "1.0" });
    assert_says(&model.error(), "glTF version 1.0 is not supported; convert");
    for (version, least) in [("2.0", "2.1"), ("2.1", "2.1"), ("2.1", "3.0"), ("2.0", "x")] {
        model.json["asset"] = json!({ "version": version, "minVersion": least });
        assert_says(&model.error(), &format!("its 'minVersion', glTF '{least}', is not supported"));
    }
    for version in ["3.0", "20", "2x", "", "two"] {
        model.json["asset"] = json!({ "version": version });
        assert_says(&model.error(), &format!("glTF version '{version}' is not supported"));
    }
    model.json["asset"] = json!({});
    assert_says(&model.error(), "'asset' has no 'version'");
    model.json["asset"] = json!({ "version": "2.0" });
    for name in ["KHR_animation_pointer", "KHR_materials_acme", "KHR_technique_webgl", "ACME_spheres"] {
        model.json["extensionsRequired"] = json!([name]);
        assert_says(&model.error(), &format!("the required extension {name} is not supported; "));
    }
    model.json["extensionsRequired"] = json!(["KHR_texture_transform", "KHR_materials_unlit", "KHR_mesh_quantization"]);
    model.json["extensionsUsed"] = json!(["ACME_spheres"]);
    assert_eq!(model.scene().objects.len(), 1);
}

/// `asset.version` 2.1 was refused. Without `minVersion` only the major version counts (glTF 2.0, 3.2).
#[test]
fn every_minor_version_is_read() {
    let mut model = Model::triangle();
    for asset in [
        json!({ "version": "2.1" }),
        json!({ "version": "2.17" }),
        json!({ "version": "2.4294967296" }),
        json!({ "version": "2" }),
        json!({ "version": "2.1", "minVersion": "2.0" }),
        json!({ "version": "2.0", "minVersion": "1.0" }),
    ] {
        model.json["asset"] = asset.clone();
        assert_eq!(model.scene().objects.len(), 1, "{asset}");
    }
}

/// A .glb with bytes behind its declared length was refused, with the question whether it was cut off.
#[test]
fn bytes_behind_a_glb_are_ignored_with_a_warning() {
    let file = Model::triangle().glb();
    for behind in [&b"\0"[..], b"\0\0\0\0", b"\r\n", &[7; 1000]] {
        let longer = [&file, behind].concat();
        let (scene, warnings) = warnings(|| import(&longer).expect("a legal file"));
        assert_eq!(scene.meshes, Model::triangle().scene().meshes);
        let expected = format!("has {} bytes behind the {}", behind.len(), file.len());
        assert!(warnings.len() == 1 && warnings[0].contains(&expected), "{warnings:?}");
    }
    assert!(warnings(|| import(&file).expect("a legal file")).1.is_empty());
}

#[test]
fn chunks_may_be_padded_in_any_way() {
    let model = Model::triangle();
    let file = |json: &[u8], said: [usize; 2], data: &[u8], after: &[u8]| {
        let word = |number: usize| (number as u32).to_le_bytes();
        let chunks = [&word(said[0]), &b"JSON"[..], json, &word(said[1]), b"BIN\0", data, after].concat();
        [&b"glTF"[..], &word(2), &word(12 + chunks.len()), &chunks].concat()
    };
    let mut json = model.json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4) + 1, b' ');
    let odd = json.clone();
    json.resize(json.len().next_multiple_of(4), b' ');
    let data = [&model.binary[..], &[0, 0, 0]].concat();
    let nulls = [model.json.to_string().as_bytes(), &[0; 8]].concat();
    let count = data.len();
    for (name, file) in [
        ("data is longer than its buffer by 3 bytes", file(&json, [json.len(), count], &data, b"")),
        ("no padding at all", file(&odd, [odd.len(), count], &data, b"")),
        ("JSON that is padded with zeros", file(&nulls, [nulls.len(), count], &data, b"")),
        ("padding that lengths leave out", file(&json, [odd.len(), count - 3], &data, b"")),
        ("padding behind the last chunk", file(&json, [json.len(), count], &data, &[0; 5])),
        ("a third chunk that is cut off", file(&json, [json.len(), count], &data, b"\xff\0\0\0ACME")),
    ] {
        assert_eq!(import(&file).unwrap_or_else(|error| panic!("{name}: {error}")).objects.len(), 1, "{name}");
    }
}

#[test]
fn errors_are_one_short_line_whatever_the_file_says() {
    let mut model = Model::triangle();
    model.json["meshes"][0]["name"] = format!("a\nb\u{1b}[31m{}", "x".repeat(100_000)).into();
    model.json["meshes"][0]["primitives"][0]["mode"] = 9.into();
    let message = model.error();
    assert!(message.len() < 600 && !message.contains(char::is_control), "{message}");
    model.json["scene"] = "y".repeat(100_000).into();
    assert!(model.error().len() < 600);
}
