//! Laws of primitive modes and indices.

use crate::model::{assert_says, Model, U16, U32, U8};
use scenes::Topology::{self, Lines, Points, Triangles};
use serde_json::json;

/// Five corners of a pentagon, with indices of a component type or none, drawn in a mode.
fn pentagon(mode: u32, component: Option<u32>, list: &[u32]) -> Model {
    let mut model = Model::new();
    let positions = model.floats("VEC3", &[0., 0., 0., 2., 0., 0., 3., 2., 0., 1., 3., 0., -1., 2., 0.]);
    let mut primitive = json!({ "attributes": { "POSITION": positions }, "mode": mode });
    if let Some(component) = component {
        let size = match component {
            U8 => 1,
            U16 => 2,
            _ => 4,
        };
        let bytes: Vec<u8> = list.iter().flat_map(|index| index.to_le_bytes()[..size].to_vec()).collect();
        primitive["indices"] = model.accessor(&bytes, component, "SCALAR", list.len()).into();
    }
    model.mesh(primitive);
    model.node(json!({ "mesh": 0 }), true);
    model
}

#[test]
fn every_primitive_mode_becomes_points_lines_or_triangles() {
    let cases: [(u32, &[u32], Topology, &[u32]); 7] = [
        (0, &[4, 2], Points, &[4, 2]),
        (1, &[0, 1, 3, 2], Lines, &[0, 1, 3, 2]),
        (2, &[0, 1, 2], Lines, &[0, 1, 1, 2, 2, 0]),
        (3, &[0, 1, 2], Lines, &[0, 1, 1, 2]),
        (4, &[0, 1, 2, 0, 2, 3], Triangles, &[0, 1, 2, 0, 2, 3]),
        (5, &[0, 1, 2, 3, 4], Triangles, &[0, 1, 2, 1, 3, 2, 2, 3, 4]),
        (6, &[0, 1, 2, 3], Triangles, &[1, 2, 0, 2, 3, 0]),
    ];
    for (mode, list, topology, indices) in cases {
        for component in [U8, U16, U32] {
            let scene = pentagon(mode, Some(component), list).scene();
            assert_eq!(scene.meshes[0].topology, topology, "mode {mode}");
            assert_eq!(scene.meshes[0].indices, indices, "mode {mode}, component {component}");
        }
    }
    assert_eq!(pentagon(3, None, &[]).scene().meshes[0].indices, [0, 1, 1, 2, 2, 3, 3, 4]);
}

#[test]
fn strips_keep_the_side_that_faces_the_eye() {
    let mesh = pentagon(5, Some(U8), &[0, 1, 4, 2, 3]).scene().meshes.remove(0);
    for triangle in mesh.indices.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| mesh.positions[triangle[corner] as usize]);
        assert!((b - a).cross(c - a).z > 0.0, "{triangle:?}");
    }
}

#[test]
fn counts_that_form_no_primitive_are_refused() {
    let cases: [(u32, &[u32], &str); 7] = [
        (1, &[0, 1, 2], "lines"),
        (2, &[0], "a line loop"),
        (3, &[0], "a line strip"),
        (4, &[0, 1, 2, 3], "triangles"),
        (5, &[0, 1], "a triangle strip"),
        (6, &[0, 1], "a triangle fan"),
        (7, &[0, 1, 2], "mode 7"),
    ];
    for (mode, list, text) in cases {
        assert_says(&pentagon(mode, Some(U8), list).error(), text);
    }
}

#[test]
fn an_index_out_of_range_is_refused_with_its_place() {
    let message = pentagon(4, Some(U16), &[0, 1, 65535]).error();
    assert_says(&message, "mesh 0, primitive 0: index 2 (accessor 1) refers to vertex 65535, but it has 5");
}

#[test]
fn missing_and_meaningless_normals_become_unit_vectors() {
    let mut model = Model::triangle();
    let normals = model.floats("VEC3", &[0., 0., 0., f32::NAN, 0., 0., 0., 3e38, 0.]);
    assert!(model.scene().meshes[0].normals.iter().all(|normal| *normal == glam::Vec3::Z));
    model.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals.into();
    assert_eq!(model.scene().meshes[0].normals, [glam::Vec3::Z, glam::Vec3::Z, glam::Vec3::Y]);
}

#[test]
fn materials_give_colour_and_blending() {
    let mut model = Model::triangle();
    let material =
        |mode| json!({ "alphaMode": mode, "pbrMetallicRoughness": { "baseColorFactor": [0.5, 2.0, -1.0, 0.25] } });
    model.json["materials"] = json!([material("BLEND"), material("MASK"), material("SMOKE")]);
    let with = |model: &mut Model, index: usize| model.json["meshes"][0]["primitives"][0]["material"] = index.into();
    with(&mut model, 0);
    let object = model.scene().objects.remove(0);
    assert_eq!((object.colour, object.translucent, object.masked), ([0.5, 1.0, 0.0, 0.25], true, false));
    with(&mut model, 1);
    let object = model.scene().objects.remove(0);
    assert_eq!((object.translucent, object.masked), (false, true));
    with(&mut model, 2);
    assert_says(&model.error(), "alphaMode 'SMOKE'");
    with(&mut model, 3);
    assert_says(&model.error(), "material 3, but the file has 3");
}
