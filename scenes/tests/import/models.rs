//! Laws held by the glTF models of the Debian package assimp-testmodels.

use crate::model::assert_says;
use glam::{DMat4, Vec3};
use scenes::Scene;
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
        ("wrongTypes/badExtension.gltf", "\"Not an object\", expected a map at line 130"),
        ("wrongTypes/badNumber.gltf", "\"not a number\", expected a number at line 132"),
        ("wrongTypes/badObject.gltf", "at line 125"),
        ("wrongTypes/badString.gltf", "`42`, expected a string at line 12"),
        ("wrongTypes/badUint.gltf", "`-1`, expected an index at line 128"),
        ("draco/2CylinderEngine.gltf", "KHR_draco_mesh_compression is not supported; decompress it"),
        ("BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf", "KHR_technique_webgl is not supported; "),
    ];
    for (name, text) in cases {
        let path = model(name);
        let message = scenes::import(&path).expect_err(name).to_string();
        assert_says(&message, text);
        assert!(message.contains(path.to_str().expect("UTF-8")) && !message.contains('\n'), "{message}");
    }
}

/// The same files through the `gltf` crate's own reader, which shares no code with ours.
#[test]
fn positions_and_places_are_those_the_gltf_crate_reads() {
    for name in ["2CylinderEngine-glTF-Binary/2CylinderEngine.glb", "BoxTextured-glTF-Binary/BoxTextured.glb"] {
        let bytes = std::fs::read(model(name)).expect("a model");
        let file = gltf::Gltf::from_slice(&bytes).expect("a legal model");
        let mut expected = vec![None; file.nodes().len()];
        let mut open: Vec<(gltf::Node, DMat4)> =
            file.default_scene().expect("a scene").nodes().map(|node| (node, DMat4::IDENTITY)).collect();
        while let Some((node, world_from_parent)) = open.pop() {
            let local = node.transform().matrix().map(|column| column.map(f64::from));
            let world_from_node = world_from_parent * DMat4::from_cols_array_2d(&local);
            expected[node.index()] = node.mesh().map(|mesh| (mesh, world_from_node));
            open.extend(node.children().map(|child| (child, world_from_node)));
        }
        let scene = scene(name);
        let mut objects = scene.objects.iter();
        for (mesh, world_from_node) in expected.into_iter().flatten() {
            for primitive in mesh.primitives() {
                let object = objects.next().expect("as many objects");
                let reader = primitive.reader(|_| file.blob.as_deref());
                let read = &scene.meshes[object.mesh as usize];
                let positions: Vec<Vec3> = reader.read_positions().expect("positions").map(Vec3::from_array).collect();
                assert_eq!(read.positions, positions, "{name}: '{}'", object.name);
                assert_eq!(read.indices, reader.read_indices().expect("indices").into_u32().collect::<Vec<_>>());
                let place = DMat4::from(object.world_from_object);
                // The crate's transforms are f32; the model is some hundred units large.
                assert!(
                    place.abs_diff_eq(world_from_node, 1e-3),
                    "{name}: '{}' {place} {world_from_node}",
                    object.name
                );
            }
        }
        assert!(objects.next().is_none());
    }
}
