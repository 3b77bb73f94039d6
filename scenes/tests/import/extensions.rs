//! Laws of extensions: each is drawn, ignored, or refused by its name.

use crate::corpus::{self, png, webp};
use crate::model::{assert_says, warnings, Model};
use scenes::Scene;
use serde_json::{json, Value};

fn with_material(material: Value) -> Scene {
    material_model(material).scene()
}

fn material_model(material: Value) -> Model {
    let mut model = corpus::textured(&png());
    model.json["materials"] = json!([material]);
    model
}

/// The factor and texture of KHR_materials_pbrSpecularGlossiness were ignored without a word: a mask had no holes.
#[test]
fn specular_glossiness_decides_colour_and_holes() {
    let transform = json!({ "scale": [2, 2] });
    let texture = json!({ "index": 0, "extensions": { "KHR_texture_transform": transform } });
    let specular = json!({ "diffuseFactor": [0, 1, 0, 0.75], "diffuseTexture": texture });
    let material = json!({ "alphaMode": "MASK", "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1] },
        "extensions": { "KHR_materials_pbrSpecularGlossiness": specular } });
    let scene = with_material(material.clone());
    let object = &scene.objects[0];
    assert_eq!((object.colour, object.masked), ([0.0, 1.0, 0.0, 0.75], true));
    assert_eq!(scene.textures[object.surface.texture.expect("a texture") as usize].size, [3, 2]);
    assert_eq!(scene.meshes[0].texture_coordinates[1], glam::Vec2::new(2.0, 0.0), "the transform of its texture");
    // The extension's own defaults hold, not the factors of the core material.
    let mut bare = material;
    bare["extensions"] = json!({ "KHR_materials_pbrSpecularGlossiness": {} });
    let scene = with_material(bare.clone());
    assert_eq!((scene.objects[0].colour, scene.objects[0].surface.texture), ([1.0; 4], None));
    bare["extensions"] = json!({ "KHR_materials_pbrSpecularGlossiness": { "diffuseFactor": "green" } });
    let (scene, warnings) = warnings(|| with_material(bare));
    assert_eq!(scene.objects[0].colour, [1.0, 0.0, 0.0, 1.0]);
    assert_says(&warnings.join("|"), "material 0 is drawn without its KHR_materials_pbrSpecularGlossiness");
}

#[test]
fn surfaces_that_transmit_light_hide_nothing() {
    for name in ["KHR_materials_transmission", "ADOBE_materials_thin_transparency"] {
        let glass = |factor: Value, colour: [f32; 4]| {
            let scene = with_material(json!({ "pbrMetallicRoughness": { "baseColorFactor": colour },
                "extensions": { name: { "transmissionFactor": factor } } }));
            (scene.objects[0].translucent, scene.objects[0].colour)
        };
        assert_eq!(glass(json!(1), [1.0; 4]), (true, [1.0, 1.0, 1.0, 0.0]), "clear glass");
        assert_eq!(
            glass(json!(1), [0.0, 0.0, 0.0, 0.5]),
            (true, [0.0, 0.0, 0.0, 1.0]),
            "black glass; alpha means nothing"
        );
        assert_eq!(glass(json!(0.5), [1.0; 4]), (true, [1.0, 1.0, 1.0, 0.5]));
        assert_eq!(glass(json!(0), [1.0; 4]), (false, [1.0; 4]), "no glass");
    }
}

#[test]
fn hidden_nodes_and_all_below_them_are_not_drawn() {
    let mut model = Model::triangle();
    let hide = |visible: Value| json!({ "KHR_node_visibility": { "visible": visible } });
    model.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1 } }]);
    model.json["nodes"] = json!([
        { "children": [1], "extensions": hide(json!(false)) },
        { "children": [2], "mesh": 0, "extensions": hide(json!(true)) },
        { "mesh": 0, "camera": 0 },
        { "mesh": 0, "name": "shown", "extensions": hide(json!(true)) },
        { "mesh": 0, "name": "shown too", "extensions": { "KHR_node_visibility": {} } },
    ]);
    model.json["scenes"][0]["nodes"] = json!([0, 3, 4]);
    model.json["extensionsRequired"] = json!(["KHR_node_visibility"]);
    let scene = model.scene();
    let names: Vec<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!((names, scene.cameras.len()), (vec!["shown", "shown too"], 1));
}

/// Any name that began with `KHR_materials_` was let through.
#[test]
fn required_extensions_are_known_by_name() {
    let mut model = Model::triangle();
    for name in [
        "KHR_materials_acme",
        "KHR_materials_pbrSpecularGlossiness2",
        "EXT_mesh_primitive_restart",
        "NV_materials_mdl",
        "KHR_interactivity",
        "MOZ_hubs_components",
        "CESIUM_RTC",
        "khr_materials_unlit",
        "",
    ] {
        model.json["extensionsRequired"] = json!(["KHR_materials_unlit", name]);
        assert_says(&model.error(), &format!("the required extension {name} is not supported; "));
    }
    for name in [
        "KHR_materials_variants",
        "MSFT_lod",
        "EXT_texture_avif",
        "KHR_xmp_json_ld",
        "AGI_articulations",
        "GODOT_single_root",
    ] {
        model.json["extensionsRequired"] = json!([name]);
        assert_eq!(model.scene().objects.len(), 1, "{name}");
    }
}

#[test]
fn used_extensions_that_are_not_drawn_are_warned_of_once() {
    let mut model = Model::triangle();
    model.json["extensionsUsed"] = json!([
        "KHR_materials_ior",
        "KHR_animation_pointer",
        "EXT_primitive_voxels",
        "KHR_animation_pointer",
        "ACME_any"
    ]);
    let (scene, warnings) = warnings(|| model.scene());
    assert_eq!(scene.objects.len(), 1);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert_says(&warnings[0], "are not supported: EXT_primitive_voxels, KHR_animation_pointer");
}

/// The warning for a texture without a source named image 4294967295.
#[test]
fn textures_that_only_an_extension_names_are_left_out_by_its_name() {
    for name in ["KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"] {
        let mut model = corpus::textured(&png());
        model.json["textures"] = json!([{ "extensions": { name: { "source": 0 } } }]);
        model.json["extensionsRequired"] = json!([name, "KHR_materials_pbrSpecularGlossiness"]);
        let (scene, warnings) = warnings(|| model.scene());
        assert_eq!((scene.objects.len(), scene.textures.len()), (1, 0));
        assert_says(&warnings.join("|"), &format!("texture 0 is not drawn: only the extension {name} names its image"));
        assert!(!warnings.join("|").contains("4294967295"), "{warnings:?}");
        // With a source of its own the texture is read.
        model.json["textures"][0]["source"] = 0.into();
        assert_eq!(model.scene().textures.len(), 1, "{name}");
    }
}

#[test]
fn pictures_of_other_formats_are_left_out_by_name() {
    let ktx = b"\xabKTX 20\xbb\r\n\x1a\n\0\0\0\0";
    for (file, name) in [
        (&ktx[..], "KTX, of KHR_texture_basisu"),
        (b"DDS \x7c\0\0\0", "DDS, of MSFT_texture_dds"),
        (b"\0\0\0\x20ftypavif\0\0\0\0", "AVIF, of EXT_texture_avif"),
    ] {
        let mut model = corpus::textured(file);
        model.json["textures"] = json!([{ "source": 0 }]);
        let (scene, warnings) = warnings(|| model.scene());
        assert_eq!((scene.objects.len(), scene.textures.len()), (1, 0));
        assert_says(&warnings.join("|"), &format!("texture 0 is not drawn: its format, {name}, is not read"));
    }
}

/// Each of a thousand textures would have been decoded up to its broken end, which takes minutes.
#[test]
fn pictures_that_are_broken_at_their_end_do_not_add_up() {
    let mut file = Vec::new();
    let texels = vec![9; 4 * 8000 * 2000];
    image_webp::WebPEncoder::new(&mut file).encode(&texels, 8000, 2000, image_webp::ColorType::Rgba8).expect("a file");
    file.truncate(file.len() - 4);
    let mut model = corpus::textured(&file);
    let texture = model.json["textures"][0].clone();
    model.json["textures"] = Value::Array(vec![texture; 1000]);
    let materials = (0..1000).map(|at| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": at } } }));
    model.json["materials"] = materials.collect();
    let primitive = model.json["meshes"][0]["primitives"][0].clone();
    let primitives = (0..1000).map(|at| {
        let mut primitive = primitive.clone();
        primitive["material"] = at.into();
        primitive
    });
    model.json["meshes"][0]["primitives"] = primitives.collect();
    let (scene, warnings) = warnings(|| model.scene());
    assert_eq!((scene.objects.len(), scene.textures.len()), (1000, 0));
    let over = warnings.iter().filter(|line| line.contains("more than 134217728 texels")).count();
    assert_eq!((over, warnings.len()), (992, 1000), "eight of 16 million texels are within the bound");
}

#[test]
fn webp_textures_are_read() {
    let scene = corpus::textured(&webp()).scene();
    let expected = corpus::textured(&png()).scene();
    assert_eq!(scene.textures[0].texels, expected.textures[0].texels, "lossless, by another format");
    assert_eq!((scene.textures[0].size, scene.objects[0].masked), ([3, 2], true));
    let texture = |text: &str| corpus::textured(&corpus::decoded(text)).scene().textures.remove(0);
    // As libwebp decodes it, but for the rounding of chroma.
    let lossy = texture(corpus::LOSSY_WEBP);
    assert_eq!(lossy.size, [16, 16]);
    let first = lossy.texels[0];
    assert!([235, 2, 8, 255].iter().zip(first).all(|(a, b)| b.abs_diff(*a) < 4), "{first:?}");
    let alpha = texture(corpus::LOSSY_ALPHA_WEBP);
    assert!(alpha.texels[0][3] == 0 && alpha.texels[8 * 16 + 8][3] > 200, "{:?}", alpha.texels[8 * 16 + 8]);
}

#[test]
fn of_two_images_the_one_that_can_be_decoded_is_drawn() {
    let mut model = corpus::textured(&webp());
    let png = model.view(&png());
    let broken = model.view(b"no picture");
    model.json["images"] =
        json!([{ "bufferView": 1 }, { "bufferView": png }, { "bufferView": broken }, { "uri": "gone.png" }]);
    let picture = model.json["accessors"].as_array().expect("a list").len();
    model.json["images"][0]["bufferView"] = picture.into();
    let size = |own: Value, webp: Value| {
        let mut model = Model { json: model.json.clone(), binary: model.binary.clone() };
        model.json["textures"] = json!([{ "source": own, "extensions": { "EXT_texture_webp": { "source": webp } } }]);
        model.scene().textures.first().map(|texture| texture.size)
    };
    for (own, webp) in [(1, 0), (1, 2), (2, 0), (3, 0), (2, 1), (1, 99), (99, 0)] {
        assert_eq!(size(json!(own), json!(webp)), Some([3, 2]), "{own} {webp}");
    }
    assert_eq!(size(json!(2), json!(3)), None);
}

/// EXT_texture_webp: a client that supports the extension loads its image, and all others fall back to the texture's own.
#[test]
fn the_image_of_webp_comes_before_its_fallback() {
    let mut model = corpus::textured(&webp());
    let fallback = model.view(&png());
    let view = model.json["images"][0]["bufferView"].clone();
    model.json["images"] = json!([{ "name": "webp", "bufferView": view }, { "name": "png", "bufferView": fallback }]);
    let mut drawn = |texture: Value| {
        model.json["textures"] = json!([texture]);
        model.scene().textures.remove(0).name
    };
    assert_eq!(drawn(json!({ "source": 1, "extensions": { "EXT_texture_webp": { "source": 0 } } })), "webp");
    assert_eq!(drawn(json!({ "source": 1 })), "png");
}

#[test]
fn broken_webp_costs_the_texture_alone() {
    let whole = corpus::decoded(corpus::LOSSY_ALPHA_WEBP);
    let mut huge = webp();
    // VP8L: 14 bits of width and of height, less one.
    huge[21..25].copy_from_slice(&[0xff, 0xff, 0xff, 0x1f]);
    for file in [&whole[..whole.len() / 2], &whole[..20], b"RIFF\0\0\0\0WEBP", &huge] {
        let (scene, warnings) = warnings(|| corpus::textured(file).scene());
        assert_eq!((scene.objects.len(), scene.textures.len()), (1, 0));
        assert_says(&warnings.join("|"), "texture 0 is not drawn");
    }
}
