//! Laws of materials: what of them decides where a surface leaves fragments, and its colours.

use crate::corpus::png;
use crate::model::{Model, U8};
use glam::Vec2;
use image::{ImageFormat, Rgb, RgbImage};
use scenes::{Scene, Wrap};
use serde_json::{json, Value};
use std::io::Cursor;
use std::path::Path;

/// A triangle with texture coordinates, whose material is `material` and whose texture is `picture`.
fn textured(material: Value, picture: &[u8]) -> Model {
    let mut model = Model::triangle();
    let coordinates = model.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.25, 0.75]);
    model.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = coordinates.into();
    model.json["meshes"][0]["primitives"][0]["material"] = 0.into();
    model.json["materials"] = json!([material]);
    model.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    model.json["samplers"] = json!([{ "wrapS": 33_071, "wrapT": 33_648 }]);
    let view = model.view(picture);
    model.json["images"] = json!([{ "name": "leaf", "bufferView": view, "mimeType": "image/png" }]);
    model
}

fn textured_material() -> Value {
    json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } })
}

/// Drawn, but without its texture.
fn is_plain(scene: &Scene) -> bool {
    scene.objects.len() == 1 && scene.objects[0].surface.texture.is_none() && scene.textures.is_empty()
}

#[test]
fn a_png_becomes_its_texels() {
    let scene = textured(textured_material(), &png()).scene();
    let texture = &scene.textures[scene.objects[0].surface.texture.expect("a texture") as usize];
    assert_eq!((texture.name.as_str(), texture.size, texture.wrap), ("leaf", [3, 2], [Wrap::Clamp, Wrap::Mirror]));
    let expected: Vec<[u8; 4]> = (0..6u8).map(|at| [at % 3 * 10, at / 3 * 20, 7, at / 3 * 100]).collect();
    assert_eq!(texture.texels, expected);
    let corners = [Vec2::ZERO, Vec2::X, Vec2::new(0.25, 0.75)];
    assert_eq!(scene.meshes[0].texture_coordinates, corners);
}

#[test]
fn a_jpeg_becomes_its_texels() {
    let picture = RgbImage::from_pixel(16, 8, Rgb([200, 100, 50]));
    let mut file = Cursor::new(Vec::new());
    picture.write_to(&mut file, ImageFormat::Jpeg).expect("it can be written");
    let scene = textured(textured_material(), &file.into_inner()).scene();
    let texture = &scene.textures[0];
    assert_eq!(texture.size, [16, 8]);
    // JPEG loses a little of every colour.
    assert!(texture
        .texels
        .iter()
        .all(|texel| texel[0].abs_diff(200) < 6 && texel[2].abs_diff(50) < 6 && texel[3] == 255));
}

#[test]
fn sides_and_cutoff_are_read() {
    let surface = |material: Value| {
        let scene = textured(material, &png()).scene();
        (scene.objects[0].surface.single_sided, scene.objects[0].surface.cutoff)
    };
    assert_eq!(surface(json!({})), (true, 0.5));
    assert_eq!(surface(json!({ "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.75 })), (false, 0.75));
    assert!(Model::triangle().scene().objects[0].surface.single_sided, "without a material, glTF's default");
}

#[test]
fn vertex_colours_of_every_format_are_read() {
    let with = |accessor: fn(&mut Model) -> usize| {
        let mut model = Model::triangle();
        let colours = accessor(&mut model);
        model.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colours.into();
        model.scene().meshes.remove(0).colours
    };
    let three = with(|model| model.floats("VEC3", &[0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 2.0, -1.0, 1.0]));
    assert_eq!(three, [[0.0, 0.5, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 1.0, 1.0]]);
    let bytes = with(|model| {
        let accessor = model.accessor(&[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], U8, "VEC4", 3);
        model.json["accessors"][accessor]["normalized"] = true.into();
        accessor
    });
    assert_eq!(
        bytes,
        [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]].map(|colour| colour.map(|byte| byte as f32 / 255.0))
    );
    let few = with(|model| model.floats("VEC3", &[0.0, 0.5, 1.0]));
    assert!(few.is_empty(), "too few to be of use");
}

#[test]
fn a_texture_transform_is_done() {
    let transform = json!({ "offset": [0.5, 0.25], "rotation": std::f64::consts::FRAC_PI_2, "scale": [2.0, 4.0] });
    let info = json!({ "index": 0, "extensions": { "KHR_texture_transform": transform } });
    let scene = textured(json!({ "pbrMetallicRoughness": { "baseColorTexture": info } }), &png()).scene();
    // As the extension says: scaled, turned counter-clockwise with y down, moved.
    let expected = [Vec2::new(0.5, 0.25), Vec2::new(0.5, -1.75), Vec2::new(3.5, -0.25)];
    for (read, expected) in scene.meshes[0].texture_coordinates.iter().zip(expected) {
        assert!(read.abs_diff_eq(expected, 1e-6), "{read} {expected}");
    }
}

#[test]
fn what_cannot_be_read_costs_the_texture_alone() {
    let broken: [fn(&mut Model); 7] = [
        |model| model.json["images"][0] = json!({ "uri": "not-there.png" }),
        |model| model.json["images"][0] = json!({}),
        |model| model.json["images"][0]["bufferView"] = 99.into(),
        |model| model.json["textures"][0]["source"] = 7.into(),
        |model| model.json["textures"] = json!([]),
        |model| model.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 0.into(),
        |model| {
            let few = model.floats("VEC2", &[0.0, 1.0]);
            model.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = few.into();
        },
    ];
    for (index, change) in broken.iter().enumerate() {
        let mut model = textured(textured_material(), &png());
        change(&mut model);
        assert!(is_plain(&model.scene()), "change {index}");
    }
    let whole = png();
    for picture in [&b"no picture"[..], &whole[..whole.len() / 2], &[]] {
        assert!(is_plain(&textured(textured_material(), picture).scene()));
    }
    // A picture that says it is larger than memory.
    let mut huge = whole.clone();
    huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    assert!(is_plain(&textured(textured_material(), &huge).scene()));
}

#[test]
fn debian_s_textured_models_have_their_textures() {
    let folder = Path::new("/usr/share/assimp/models/glTF2");
    let forms = [
        "BoxTextured-glTF/BoxTextured.gltf",
        "BoxTextured-glTF-Binary/BoxTextured.glb",
        "BoxTextured-glTF-Embedded/BoxTextured.gltf",
    ];
    let sizes = forms.map(|form| {
        let scene = scenes::import(&folder.join(form)).unwrap_or_else(|error| panic!("{error}"));
        let texture = &scene.textures[scene.objects[0].surface.texture.expect("a texture") as usize];
        assert_eq!(scene.meshes[scene.objects[0].mesh as usize].texture_coordinates.len(), 24, "{form}");
        (texture.size, texture.texels.clone())
    });
    assert_eq!(sizes[0].0, [211, 211]);
    assert!(sizes[0] == sizes[1] && sizes[0] == sizes[2], "beside the file, within it, or as text: the same texels");
}

/// A seed whose material is not read would fuzz nothing of it.
#[test]
fn the_fuzzer_s_seeds_are_textured_masked_and_translucent() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/seeds"));
    for (name, masked, translucent, coloured) in
        [("textured", false, false, false), ("mask", true, false, true), ("blend", false, true, true)]
    {
        let scene = scenes::import(&folder.join(name).with_extension("gltf")).unwrap_or_else(|error| panic!("{error}"));
        let object = &scene.objects[0];
        assert_eq!((object.masked, object.translucent), (masked, translucent), "{name}");
        assert_eq!(scene.textures[object.surface.texture.expect("a texture") as usize].size, [4, 4], "{name}");
        assert_eq!(!scene.meshes[0].colours.is_empty(), coloured, "{name}");
    }
}
