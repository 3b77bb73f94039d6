//! The law that nothing in a file makes the import panic.

use crate::materials::png;
use crate::model::{import, Model, U16, U8};
use proptest::prelude::*;
use serde_json::json;

/// A file that uses most of what the import reads.
fn rich() -> Model {
    let mut model = Model::triangle();
    let indices = model.accessor(&[0, 0, 1, 0, 2, 0], U16, "SCALAR", 3);
    let deltas = model.floats("VEC3", &[0.5; 9]);
    let (at, value) = (model.view(&[1]), model.view(&[0; 12]));
    let model_coordinates = model.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.25, 0.75]);
    let model_colours = model.floats("VEC4", &[0.5; 12]);
    model.json["accessors"][deltas]["sparse"] = json!({ "count": 1, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": value } });
    let primitive = &mut model.json["meshes"][0]["primitives"][0];
    primitive["indices"] = indices.into();
    primitive["attributes"]["NORMAL"] = deltas.into();
    primitive["targets"] = json!([{ "POSITION": deltas }]);
    primitive["mode"] = 5.into();
    primitive["material"] = 0.into();
    primitive["attributes"]["TEXCOORD_0"] = model_coordinates.into();
    primitive["attributes"]["COLOR_0"] = model_colours.into();
    let mut glass = primitive.clone();
    glass["material"] = 1.into();
    model.json["meshes"][0]["primitives"].as_array_mut().expect("a list").push(glass);
    model.json["meshes"][0]["weights"] = json!([0.5]);
    let transform = json!({ "offset": [0.5, 0.25], "rotation": 0.5, "scale": [2, 4] });
    let texture = json!({ "index": 0, "texCoord": 0, "extensions": { "KHR_texture_transform": transform } });
    model.json["materials"] = json!([
        { "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1], "baseColorTexture": texture } },
        { "alphaMode": "BLEND", "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0.5], "baseColorTexture": texture } },
    ]);
    model.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    model.json["samplers"] = json!([{ "wrapS": 33_071, "wrapT": 33_648 }]);
    let picture = model.view(&png());
    model.json["images"] = json!([{ "bufferView": picture, "mimeType": "image/png" }]);
    model.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1 } }]);
    let places = model.floats("VEC3", &[1., 2., 3., 4., 5., 6.]);
    let instancing = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    model.json["nodes"] = json!([
        { "children": [1, 2], "rotation": [0, 0, 0, 1] },
        { "mesh": 0, "extensions": instancing },
        { "camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] },
        { "mesh": 0, "skin": 0 },
    ]);
    model.json["scenes"][0]["nodes"] = json!([0, 3]);
    let identity = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    let inverse_binds = model.floats("MAT4", &[identity, identity].concat());
    model.json["skins"] = json!([{ "joints": [2, 0], "inverseBindMatrices": inverse_binds }]);
    let joints = model.accessor(&[0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0], U8, "VEC4", 3);
    let weights = model.floats("VEC4", &[0.5, 0.5, 0., 0., 1., 0., 0., 0., 1., 0., 0., 0.]);
    for primitive in model.json["meshes"][0]["primitives"].as_array_mut().expect("a list") {
        primitive["attributes"]["JOINTS_0"] = joints.into();
        primitive["attributes"]["WEIGHTS_0"] = weights.into();
    }
    let (input, output) = (model.floats("SCALAR", &[0., 1.]), model.floats("VEC4", &[0., 0., 0., 1., 0., 1., 0., 0.]));
    model.channel(0, "rotation", "LINEAR", input, output);
    model
}

fn check(file: &[u8]) {
    match import(file) {
        Ok(scene) => {
            let mut places = Vec::new();
            scene.motion.transforms_at(0.3, &mut places);
            let joints = scene.joints_at(0.3);
            for skinned in &scene.skinned {
                assert!(skinned
                    .rest
                    .iter()
                    .all(|vertex| vertex.joints.iter().all(|joint| (*joint as usize) < joints.of(skinned.skin).len())));
            }
            for object in &scene.objects {
                assert!((object.mesh as usize) < scene.meshes.len() && object.world_from_object.is_finite());
            }
            for mesh in &scene.meshes {
                assert_eq!(mesh.positions.len(), mesh.normals.len());
                assert!(mesh.indices.iter().all(|&index| (index as usize) < mesh.positions.len()));
                assert!(mesh.positions.iter().chain(&mesh.normals).all(|vector| vector.is_finite()));
                assert!([0, mesh.positions.len()].contains(&mesh.texture_coordinates.len()));
                assert!([0, mesh.positions.len()].contains(&mesh.colours.len()));
            }
            for texture in &scene.textures {
                assert_eq!(texture.texels.len(), texture.size[0] as usize * texture.size[1] as usize);
            }
            let textures = scene.objects.iter().filter_map(|object| object.surface.texture);
            assert!(textures.into_iter().all(|texture| (texture as usize) < scene.textures.len()));
        }
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
}

#[test]
fn the_file_to_mutate_is_legal() {
    let scene = rich().scene();
    // Two places of a mesh of two materials, and a skin that bends it.
    assert_eq!((scene.objects.len(), scene.cameras.len(), scene.motion.dynamic_objects().len()), (6, 1, 6));
    assert_eq!((scene.skins.len(), scene.skinned.len()), (1, 2));
    let count = |of: fn(&scenes::Object) -> bool| scene.objects.iter().filter(|object| of(object)).count();
    let counts = (count(|o| o.masked), count(|o| o.translucent), count(|o| o.surface.texture.is_some()));
    assert_eq!(counts, (3, 3, 6), "masked, translucent, textured");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_changed_or_cut_byte_makes_it_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..8), length in any::<prop::sample::Index>(), cut in prop::bool::weighted(0.1),
    ) {
        let mut file = rich().glb();
        for (at, byte) in changes {
            let at = at.index(file.len());
            file[at] = byte;
        }
        if cut {
            file.truncate(length.index(file.len()));
        }
        check(&file);
    }

    /// Most changed bytes break the JSON; changed numbers reach what is behind it.
    #[test]
    fn no_changed_number_makes_it_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop_oneof![
            (0_u64..8).prop_map(|number| number.to_string()), (5119_u64..5128).prop_map(|number| number.to_string()),
            any::<u64>().prop_map(|number| number.to_string()), any::<f64>().prop_map(|number| format!("{number:e}")),
        ]), 1..4),
    ) {
        let mut model = rich();
        let mut json = model.json.to_string();
        for (at, number) in changes {
            let bounds: Vec<(usize, usize)> = numbers(&json);
            let (start, end) = bounds[at.index(bounds.len())];
            json.replace_range(start..end, &number);
        }
        if let Ok(json) = serde_json::from_str(&json) {
            model.json = json;
            check(&model.glb());
        }
    }
}

/// Start and end of each number in the text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let part = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
    let bytes = text.as_bytes();
    let starts = (1..bytes.len()).filter(|&at| bytes[at].is_ascii_digit() && b":[,".contains(&bytes[at - 1]));
    starts.map(|start| (start, start + bytes[start..].iter().take_while(|&&byte| part(byte)).count())).collect()
}
