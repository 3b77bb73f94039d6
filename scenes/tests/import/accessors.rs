//! Laws of accessors: sparse, strided, quantised, and those that do not fit.

use crate::model::{assert_says, Model, FLOAT, U16, U8};
use glam::Vec3;
use serde_json::json;

#[test]
fn sparse_accessors_replace_their_elements() {
    for with_base in [true, false] {
        let mut model = Model::triangle();
        let indices = model.view(&[1, 2]);
        let values = model.view(&[5_f32, 6., 7., 0., 8., 0.].map(f32::to_le_bytes).concat());
        let accessor = &mut model.json["accessors"][0];
        accessor["sparse"] = json!({
            "count": 2, "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values },
        });
        if !with_base {
            accessor.as_object_mut().expect("an object").remove("bufferView");
        }
        assert_eq!(model.scene().meshes[0].positions, [Vec3::ZERO, Vec3::new(5., 6., 7.), Vec3::new(0., 8., 0.)]);
        model.json["accessors"][0]["sparse"]["count"] = 3.into();
        assert_says(&model.error(), "do not fit");
    }
}

#[test]
fn a_sparse_value_beyond_the_end_is_refused() {
    let mut model = Model::triangle();
    let (indices, values) = (model.view(&[3]), model.view(&[0; 12]));
    model.json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values },
    });
    assert_says(&model.error(), "accessor 0: a sparse value is for element 3 of 3");
}

#[test]
fn strides_and_offsets_are_followed() {
    let mut model = Model::triangle();
    let view = model.view(
        &[[9_f32; 4], [1., 2., 3., 9.], [4., 5., 6., 9.], [7., 8., 1., 9.]]
            .concat()
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect::<Vec<_>>(),
    );
    model.json["bufferViews"][view]["byteStride"] = 16.into();
    model.json["accessors"][0]["bufferView"] = view.into();
    model.json["accessors"][0]["byteOffset"] = 16.into();
    let expected = [Vec3::new(1., 2., 3.), Vec3::new(4., 5., 6.), Vec3::new(7., 8., 1.)];
    assert_eq!(model.scene().meshes[0].positions, expected);
    // The last element may end short of a whole stride, but not short of its own size.
    model.json["bufferViews"][view]["byteLength"] = 60.into();
    assert_eq!(model.scene().meshes[0].positions, expected);
    model.json["bufferViews"][view]["byteLength"] = 59.into();
    assert_says(&model.error(), "do not fit into buffer view 1 of 59 bytes");
    model.json["bufferViews"][view]["byteStride"] = 8.into();
    assert_says(&model.error(), "stride of 8 bytes, less than an element's 12");
}

#[test]
fn quantized_positions_are_whole_numbers_or_fractions() {
    let cases: [(u32, bool, &[u8], [f32; 3]); 6] = [
        (5120, false, &[127, 129, 128], [127., -127., -128.]),
        (5120, true, &[127, 129, 128], [1., -1., -1.]),
        (5121, true, &[255, 0, 51], [1., 0., 0.2]),
        (5122, true, &[255, 127, 0, 128, 0, 0], [1., -1., 0.]),
        (5123, false, &[255, 255, 1, 0, 0, 1], [65535., 1., 256.]),
        (5123, true, &[255, 255, 0, 0, 0, 0], [1., 0., 0.]),
    ];
    for (component, normalized, bytes, expected) in cases {
        let mut model = Model::triangle();
        let positions = model.accessor(&bytes.repeat(3), component, "VEC3", 3);
        model.json["accessors"][positions]["normalized"] = normalized.into();
        model.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = positions.into();
        model.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        assert_eq!(
            model.scene().meshes[0].positions[2].to_array(),
            expected,
            "component {component}, normalized {normalized}"
        );
    }
}

#[test]
fn positions_that_are_not_finite_are_refused() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut model = Model::triangle();
        let positions = model.floats("VEC3", &[0., 0., 0., 1., bad, 0., 0., 1., 0.]);
        model.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = positions.into();
        assert_says(&model.error(), "mesh 0, primitive 0: the position of vertex 1 is not finite");
    }
}

#[test]
fn what_does_not_fit_is_refused_before_it_is_allocated() {
    let cases = [
        ("/accessors/0/count", json!(4), "do not fit into buffer view 0 of 36 bytes"),
        ("/accessors/0/count", json!(u64::MAX), "do not fit"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "do not fit"),
        ("/accessors/0/bufferView", json!(7), "buffer view 7, but the file has 1"),
        ("/accessors/0/type", json!("VEC2"), "its type is 'VEC2', but VEC3 is needed here"),
        ("/accessors/0/componentType", json!(5130), "component type 5130"),
        ("/accessors/0/componentType", json!(5125), "component type 5125 is not allowed here"),
        ("/bufferViews/0/buffer", json!(1), "buffer 1, but the file has 1"),
        ("/bufferViews/0/byteLength", json!(37), "do not fit into buffer 0 of 36 bytes"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "do not fit into buffer 0"),
        ("/bufferViews/0/byteStride", json!(u64::MAX), "do not fit into buffer view 0"),
        ("/bufferViews/0/byteStride", json!(0), "a stride of 0 bytes"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(9), "accessor 9, but the file has 1"),
        ("/buffers/0/byteLength", json!(1_u64 << 60), "buffer 0: it should have"),
    ];
    for (place, value, text) in cases {
        let mut model = Model::triangle();
        model.json["bufferViews"][0]["byteStride"] = 12.into();
        model.json["bufferViews"][0]["byteOffset"] = 0.into();
        model.json["accessors"][0]["byteOffset"] = 0.into();
        *model.json.pointer_mut(place).expect(place) = value;
        let message = model.error();
        assert!(message.contains(text) || message.contains("more than 2147483648 elements"), "{place}: {message}");
    }
}

#[test]
fn zeros_without_data_are_limited() {
    let mut model = Model::triangle();
    let huge = model.bare_accessor(json!({ "componentType": FLOAT, "type": "VEC3", "count": 1_u32 << 30 }));
    model.json["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": huge } } });
    assert_says(&model.error(), "more than 16777216 objects");
    model.json["accessors"][huge]["count"] = (1 << 23).into();
    assert_says(&model.error(), "8388608 elements without data");
    model.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = huge.into();
    assert_says(&model.error(), "8388608 elements without data");
}

#[test]
fn morph_targets_are_applied_at_their_default_weights() {
    let mut model = Model::triangle();
    let deltas = model.floats("VEC3", &[0., 0., 4., 0., 0., 4., 0., 0., 4.]);
    model.json["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": deltas }]);
    assert_eq!(model.scene().meshes[0].positions[0].z, 0.0);
    model.json["meshes"][0]["weights"] = json!([0.25]);
    assert_eq!(model.scene().meshes[0].positions[0].z, 1.0);
    // A node's own weights come before the mesh's, for that node only.
    model.node(json!({ "mesh": 0, "weights": [0.5] }), true);
    let scene = model.scene();
    let height = |object: usize| scene.meshes[scene.objects[object].mesh as usize].positions[0].z;
    assert_eq!((height(0), height(1)), (1.0, 2.0));
    model.json["accessors"][deltas]["count"] = 2.into();
    assert_says(&model.error(), "morph target 0: accessor 1 has 2 elements, but there are 3 positions");
}

#[test]
fn indices_must_be_unsigned() {
    let mut model = Model::triangle();
    let indices = model.accessor(&[0, 0, 1, 0, 2, 0], U16, "SCALAR", 3);
    model.json["meshes"][0]["primitives"][0]["indices"] = indices.into();
    assert_eq!(model.scene().meshes[0].indices, [0, 1, 2]);
    model.json["accessors"][indices]["componentType"] = 5122.into();
    assert_says(&model.error(), "indices: accessor 1: indices of component type 5122; they must be unsigned");
}

/// Zeros have no bytes behind them, so a small file could ask for hours of work. The work of a file is bounded by its size.
#[test]
fn a_small_file_cannot_ask_for_much_work() {
    let with = |targets: usize, vertices: u64| {
        let mut model = Model::new();
        let zeros = model.bare_accessor(json!({ "componentType": FLOAT, "type": "VEC3", "count": vertices }));
        model.mesh(
            json!({ "attributes": { "POSITION": zeros }, "targets": vec![json!({ "POSITION": zeros }); targets] }),
        );
        model.json["meshes"][0]["weights"] = json!(vec![1.0; targets]);
        model.node(json!({ "mesh": 0 }), true);
        model
    };
    assert_eq!(with(16, 3 << 14).scene().objects.len(), 1);
    // A scene that is not refused is too large to print.
    let message = with(150, 3 << 19).import().map(drop).expect_err("too much work").to_string();
    assert_says(&message, "the file reads more than 67");
    assert_says(&message, "too many for its size; export fewer copies");
}
