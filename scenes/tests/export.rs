//! What is written as glTF reads back the same.

use glam::{DAffine3, DQuat, DVec3, Vec3};
use scenes::animation::{AnimatedNode, Attachment, Interpolation, Local, NodeAnimation, Track};
use scenes::{
    export_glb, import_bytes, open, CameraPath, Mesh, Motion, Projection, Scene, SceneOptions, Surface, Texture, Wrap,
};
use std::path::Path;

fn make(name: &str, scale: f64) -> Scene {
    open(name, &SceneOptions { scale, seed: 4, ..Default::default() }).expect("a procedural scene opens")
}

fn read(file: &[u8]) -> Scene {
    import_bytes(Path::new("exported.glb"), file).expect("what Sightline writes, it reads")
}

fn assert_same_objects(written: &Scene, read: &Scene) {
    assert_eq!(written.objects.len(), read.objects.len());
    for (a, b) in written.objects.iter().zip(&read.objects) {
        assert_eq!(a.name, b.name);
        assert_eq!(
            a.world_from_object.to_cols_array().map(f64::to_bits),
            b.world_from_object.to_cols_array().map(f64::to_bits),
            "{}",
            a.name
        );
        assert_eq!((a.colour, a.dynamic, a.translucent, a.masked), (b.colour, b.dynamic, b.translucent, b.masked));
        // Textures come back in the order in which objects use them.
        let texture = |scene: &Scene, surface: &Surface| surface.texture.map(|at| scene.textures[at as usize].clone());
        assert!(texture(written, &a.surface) == texture(read, &b.surface), "texture of {}", a.name);
        let rest = |surface: &Surface| Surface { texture: None, ..*surface };
        assert_eq!(rest(&a.surface), rest(&b.surface), "{}", a.name);
        assert_same_mesh(&written.meshes[a.mesh as usize], &read.meshes[b.mesh as usize]);
    }
}

fn assert_same_mesh(written: &Mesh, read: &Mesh) {
    assert_eq!((&written.name, written.topology), (&read.name, read.topology));
    assert!(written.positions == read.positions, "positions of {}", written.name);
    assert_eq!(written.declared_bounds, read.declared_bounds, "{}", written.name);
    assert!(written.indices == read.indices, "indices of {}", written.name);
    assert!(written.texture_coordinates == read.texture_coordinates, "texture coordinates of {}", written.name);
    assert!(written.colours == read.colours, "colours of {}", written.name);
    // The import scales normals to length 1 once more, which may change their last bit.
    let close = |(a, b): (&Vec3, &Vec3)| a.abs_diff_eq(*b, 2e-7);
    assert!(written.normals.len() == read.normals.len(), "normals of {}", written.name);
    assert!(written.normals.iter().zip(&read.normals).all(close), "normals of {}", written.name);
}

/// Gives an object a mesh and a texture of its own.
fn dress(scene: &mut Scene, object: usize) {
    let mut mesh = scene.meshes[scene.objects[object].mesh as usize].clone();
    mesh.texture_coordinates = mesh.positions.iter().map(|at| 1.5 * at.truncate()).collect();
    mesh.colours = (0..mesh.positions.len()).map(|vertex| [1.0 / (1 + vertex) as f32, 1.0, 0.027, 0.35]).collect();
    scene.meshes.push(mesh);
    let texels = (0..6u8).map(|texel| [texel, 2 * texel, 200, 40 * texel]).collect();
    let (wrap, texture) = ([Wrap::Mirror, Wrap::Clamp], scene.textures.len() as u32);
    scene.textures.push(Texture { name: "checks".into(), size: [3, 2], texels, wrap });
    scene.objects[object].mesh = (scene.meshes.len() - 1) as u32;
    scene.objects[object].surface = Surface { texture: Some(texture), single_sided: true, ..Surface::default() };
}

#[test]
fn scenes_read_back_identical() {
    for (name, scale) in [("boxes", 1.0), ("city-block", 0.01), ("rooms", 0.1), ("bad-bounds", 0.1), ("forest", 0.02)] {
        let mut scene = make(name, scale);
        scene.objects[3].translucent = true;
        scene.objects[3].colour[3] = 0.25;
        scene.objects[4].masked = true;
        scene.objects[4].surface.cutoff = 0.625;
        dress(&mut scene, 5);
        let back = read(&export_glb(&scene, None, 0).expect("it can be written"));
        assert_same_objects(&scene, &back);
        assert!(!back.textures.is_empty() && back.textures.len() <= scene.textures.len(), "textures of {name}");
        assert_eq!(back.cameras.len(), 1);
        assert_eq!(back.cameras[0].name, scene.cameras[0].name);
        assert_eq!(back.cameras[0].projection, scene.cameras[0].projection);
        assert!(back.cameras[0].pose.position.distance(scene.cameras[0].pose.position) < 1e-12);
        assert!(back.cameras[0].pose.rotation.angle_between(scene.cameras[0].pose.rotation) < 1e-7);
    }
}

#[test]
fn the_path_reads_back_as_the_default_path() {
    let scene = make("city-block", 0.01);
    let path = CameraPath::named(&scene, Some("walk"), 1.0).expect("a walk");
    let frames = 31;
    let back = read(&export_glb(&scene, Some(&path), frames).expect("it can be written"));
    let played = CameraPath::named(&back, None, 1.0).expect("a path");
    assert_eq!(played.name(), "camera");
    for frame in 0..frames {
        let (a, b) = (path.sample(frame, frames), played.sample(frame, frames));
        assert!(a.pose.position.distance(b.pose.position) < 1e-4, "frame {frame}");
        assert!(a.pose.rotation.angle_between(b.pose.rotation) < 1e-3, "frame {frame}");
        assert_eq!(a.projection, b.projection);
    }
}

#[test]
fn orbits_read_back_at_every_frame() {
    let scene = make("moving-boxes", 0.5);
    let path = CameraPath::named(&scene, Some("pan"), 1.0).expect("a path");
    let frames = 41;
    let back = read(&export_glb(&scene, Some(&path), frames).expect("it can be written"));
    assert_same_objects(&scene, &back);
    assert!(matches!(back.motion, Motion::Nodes(_)));
    let played = CameraPath::named(&back, None, 1.0).expect("a path");
    let (mut written, mut read) = (Vec::new(), Vec::new());
    for frame in 0..frames {
        scene.motion.transforms_at(path.sample(frame, frames).seconds, &mut written);
        back.motion.transforms_at(played.sample(frame, frames).seconds, &mut read);
        assert_eq!(written.len(), read.len());
        for (a, b) in written.iter().zip(&read) {
            assert_eq!(a.0, b.0);
            assert!(a.1.abs_diff_eq(b.1, 1e-4), "frame {frame}, object {}: {:?} {:?}", a.0, a.1, b.1);
        }
    }
}

/// Asserts that each moving object has the same place in both scenes at some times. Each number may differ by less than a bound.
fn assert_same_places(a: &Scene, b: &Scene, times: &[f64], most: f64) {
    for &seconds in times {
        let (mut of_a, mut of_b) = (Vec::new(), Vec::new());
        a.motion.transforms_at(seconds, &mut of_a);
        b.motion.transforms_at(seconds, &mut of_b);
        assert_eq!(of_a.len(), of_b.len(), "{seconds} s");
        for (a, b) in of_a.iter().zip(&of_b) {
            assert_eq!(a.0, b.0, "{seconds} s");
            assert!(a.1.abs_diff_eq(b.1, most), "{seconds} s, object {}: {:?} {:?}", a.0, a.1, b.1);
        }
    }
}

/// Reads the keys of a property from an exported file's JSON and data, without the import.
fn keys(file: &[u8], property: &str) -> Vec<[f32; 4]> {
    let length = u32::from_le_bytes(file[12..16].try_into().expect("four bytes")) as usize;
    let json: serde_json::Value = serde_json::from_slice(&file[20..20 + length]).expect("JSON");
    let data = &file[20 + length + 8..];
    let animation = &json["animations"][0];
    let channels = animation["channels"].as_array().expect("channels").iter();
    let mut keys = Vec::new();
    for channel in channels.filter(|channel| channel["target"]["path"] == property) {
        let sampler = &animation["samplers"][channel["sampler"].as_u64().expect("an index") as usize];
        let accessor = &json["accessors"][sampler["output"].as_u64().expect("an index") as usize];
        let view = &json["bufferViews"][accessor["bufferView"].as_u64().expect("an index") as usize];
        let (start, count) =
            (view["byteOffset"].as_u64().expect("a place"), accessor["count"].as_u64().expect("a count"));
        let number = |at: usize| f32::from_le_bytes(data[at..at + 4].try_into().expect("four bytes"));
        keys.extend(
            (0..count as usize).map(|key| std::array::from_fn(|axis| number(start as usize + 16 * key + 4 * axis))),
        );
    }
    keys
}

/// Objects of a flattened parent stood still the second time, and shear was lost.
#[test]
fn node_motion_can_be_written_again() {
    let scene = make("moving-boxes", 0.2);
    let once = read(&export_glb(&scene, None, 21).expect("it can be written"));
    let twice = read(&export_glb(&once, None, 21).expect("it can be written"));
    assert_same_objects(&once, &twice);
    assert_same_places(&once, &twice, &[0.0, 2.5, 5.0, 10.0], 1e-4);
}

/// Each place at which a tree stands got all nodes of the tree. Only those that carry something are needed.
#[test]
fn only_nodes_that_carry_something_are_written_at_each_place() {
    let track = || {
        let values = vec![DVec3::ZERO, DVec3::X];
        Track::new(Interpolation::Linear, vec![0.0, 1.0], values).expect("a legal track")
    };
    let node = |index: usize| AnimatedNode {
        parent: (index == 2).then_some(1),
        world_from_root: DAffine3::IDENTITY,
        local: Local::Parts { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE },
        translation: Some(track()),
        rotation: None,
        scale: None,
    };
    let mut scene = make("boxes", 0.1);
    scene.objects.truncate(24);
    let places = 8;
    let on = |object: u32| Attachment {
        world_from_tree: DAffine3::from_translation(DVec3::Y * f64::from(object % places)),
        ..Attachment::new(object, 2)
    };
    let objects: Vec<Attachment> = (0..24).map(on).collect();
    scene.motion = Motion::Nodes(NodeAnimation::new((0..500).map(node).collect(), objects).expect("a legal animation"));
    let mut transforms = Vec::new();
    scene.motion.transforms_at(0.0, &mut transforms);
    for (object, transform) in transforms {
        let object = &mut scene.objects[object as usize];
        (object.world_from_object, object.dynamic) = (transform, true);
    }
    let file = export_glb(&scene, None, 3).expect("it can be written");
    let length = u32::from_le_bytes(file[12..16].try_into().expect("four bytes")) as usize;
    let json: serde_json::Value = serde_json::from_slice(&file[20..20 + length]).expect("JSON");
    // Two nodes at each place, and one above them that holds the place; the objects and cameras.
    let others = scene.objects.len() + scene.cameras.len();
    assert_eq!(json["nodes"].as_array().map(Vec::len), Some(3 * places as usize - 1 + others));
    let back = read(&file);
    assert_same_objects(&scene, &back);
    assert_same_places(&scene, &back, &[0.0, 0.5, 1.0], 1e-5);
}

/// A mesh that turns and moves below a parent whose matrix shears it was written with rotation keys of length 0.983.
#[test]
fn shear_of_a_parent_is_kept() {
    let child = |node: serde_json::Value| {
        let times: Vec<u8> = [0.0_f32, 1.0, 2.0].iter().flat_map(|time| time.to_le_bytes()).collect();
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let turns = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half], [half, 0.0, 0.0, half]];
        let turns: Vec<u8> = turns.as_flattened().iter().flat_map(|number: &f32| number.to_le_bytes()).collect();
        let scales = [[1.0, 1.0, 1.0], [2.0, 0.5, 1.0], [0.0, 1.0, -3.0_f32]];
        let scales: Vec<u8> = scales.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
        let corners: Vec<u8> =
            [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32].iter().flat_map(|number| number.to_le_bytes()).collect();
        let data = [times, turns, scales, corners];
        let mut offset = 0;
        let views: Vec<serde_json::Value> = data
            .iter()
            .map(|bytes| {
                let view = serde_json::json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() });
                offset += bytes.len();
                view
            })
            .collect();
        let accessor = |view: usize, kind: &str| serde_json::json!({ "bufferView": view, "componentType": 5126, "count": 3, "type": kind });
        let escaped: String = data.concat().iter().map(|byte| format!("%{byte:02x}")).collect();
        let json = serde_json::json!({
            "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }],
            "nodes": [node, { "mesh": 0, "children": [2], "translation": [1, 2, 3], "name": "turning" },
                { "mesh": 0, "matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1], "name": "below" }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 3 } }] }],
            "animations": [{ "samplers": [{ "input": 0, "output": 1 }, { "input": 0, "output": 2 }],
                "channels": [{ "sampler": 0, "target": { "node": 1, "path": "rotation" } }, { "sampler": 1, "target": { "node": 1, "path": "scale" } }] }],
            "accessors": [accessor(0, "SCALAR"), accessor(1, "VEC4"), accessor(2, "VEC3"), accessor(3, "VEC3")],
            "bufferViews": views,
            "buffers": [{ "byteLength": offset, "uri": format!("data:,{escaped}") }],
        });
        read(json.to_string().as_bytes())
    };
    for parent in [
        serde_json::json!({ "children": [1], "matrix": [1, 0, 0, 0, 0.7, 0.8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }),
        serde_json::json!({ "children": [1], "scale": [1, 3, 0.25], "rotation": [0.6, 0, 0, 0.8] }),
        serde_json::json!({ "children": [1], "scale": [-1, 1, 1], "translation": [1, 2, 3] }),
        serde_json::json!({ "children": [1], "scale": [1, 0, 1] }),
        serde_json::json!({ "children": [1] }),
    ] {
        let scene = child(parent);
        // A key for each of the file's, and one between.
        let file = export_glb(&scene, None, 5).expect("it can be written");
        let rotations = keys(&file, "rotation");
        assert_eq!(rotations.len(), 5);
        for rotation in rotations {
            let length: f64 = rotation.iter().map(|part| f64::from(*part).powi(2)).sum::<f64>().sqrt();
            assert!((length - 1.0).abs() < 1e-6, "{rotation:?} has length {length}");
        }
        let back = read(&file);
        assert_same_objects(&scene, &back);
        assert_same_places(&scene, &back, &[0.0, 0.5, 1.0, 1.5, 2.0, 3.0], 1e-5);
    }
}

#[test]
fn a_camera_beyond_gltf_is_refused_by_name() {
    let mut scene = make("boxes", 0.1);
    scene.cameras[0].projection = Projection::Custom(glam::DMat4::IDENTITY);
    let message = export_glb(&scene, None, 1).expect_err("glTF has no such camera").to_string();
    assert!(message.contains("camera 'front'"), "{message}");
}

#[test]
fn an_empty_scene_can_be_written() {
    let back = read(&export_glb(&Scene::default(), None, 0).expect("it can be written"));
    assert!(back.objects.is_empty() && back.cameras.is_empty());
}

/// Returns the vertices of each deformed object in the world at a time.
fn deformed_vertices(scene: &Scene, seconds: f64) -> Vec<DVec3> {
    let (meshes, mut transforms) = (scene.meshes_at(seconds), Vec::new());
    scene.motion.transforms_at(seconds, &mut transforms);
    let of_object = |(object, world_from_object): &(u32, DAffine3)| {
        let mesh = scene.objects[*object as usize].mesh;
        let positions = scene.deformation_of(mesh).map(|_| meshes[mesh as usize].positions.iter());
        let place = |position: &Vec3| world_from_object.transform_point3(position.as_dvec3());
        positions.into_iter().flatten().map(place).collect::<Vec<_>>()
    };
    transforms.iter().flat_map(of_object).collect()
}

/// Writes a scene of deformed meshes, reads it back, and compares it at some of the keys.
fn reads_back_at_every_key(scene: &Scene) {
    let (first, last) = scene.motion.duration_s();
    let frames = 33;
    let back = read(&export_glb(scene, None, frames).expect("it can be written"));
    assert_eq!((back.skins.len(), back.deformed.len()), (scene.skins.len(), scene.deformed.len()));
    for (a, b) in scene.objects.iter().zip(&back.objects) {
        assert_eq!((&a.name, a.colour, a.dynamic), (&b.name, b.colour, b.dynamic));
        let [a, b] = [(scene, a), (&back, b)].map(|(scene, object)| &scene.meshes[object.mesh as usize]);
        assert!(a.indices == b.indices, "{}", a.name);
    }
    for frame in [0, 7, 20, 32] {
        let seconds = first + (last - first) * f64::from(frame) / (frames - 1) as f64;
        let (written, read) = (deformed_vertices(scene, seconds), deformed_vertices(&back, seconds));
        assert_eq!(written.len(), read.len());
        for (a, b) in written.iter().zip(&read) {
            assert!(a.abs_diff_eq(*b, 1e-4), "frame {frame}: {a} {b}");
        }
    }
    assert_ne!(deformed_vertices(scene, 0.0), deformed_vertices(scene, 0.5));
}

#[test]
fn skeletons_read_back_at_every_key() {
    reads_back_at_every_key(&make("tentacles", 0.1));
}

/// Targets, their animated weights, and skeletons on top of them.
#[test]
fn morph_targets_read_back_at_every_key() {
    let scene = make("jellyfish", 0.1);
    reads_back_at_every_key(&scene);
    let back = read(&export_glb(&scene, None, 33).expect("it can be written"));
    for (a, b) in scene.deformed.iter().zip(&back.deformed) {
        assert_eq!((a.targets.len(), a.skin.is_some()), (b.targets.len(), b.skin.is_some()));
        for (a, b) in a.targets.iter().zip(&b.targets) {
            let near =
                a.displacements.iter().zip(&b.displacements).all(|(a, b)| {
                    a.vertex == b.vertex && a.position == b.position && a.normal.abs_diff_eq(b.normal, 1e-6)
                });
            assert!(near && a.displacements.len() == b.displacements.len());
        }
    }
}
