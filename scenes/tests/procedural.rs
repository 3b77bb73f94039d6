//! Laws of scenes: what holds for every procedural scene, seed and scale.

mod support;

use glam::{DVec3, Vec2};
use scenes::procedural::SCENES;
use scenes::{open, Aabb, CameraPath, Motion, Scene, SceneError, SceneOptions, Texture, WorldBounds};
use std::collections::HashSet;
use support::ItemBuffer;

fn make(name: &str, scale: f64, seed: u64) -> Scene {
    open(name, &SceneOptions { scale, seed, ..Default::default() }).expect("a procedural scene opens")
}

/// Each vertex as the GPU turns it: see `clip_from_object` in shaders/glsl/include/transform.glsl.
fn gpu_vertices(scene: &Scene, object: usize) -> impl Iterator<Item = DVec3> + '_ {
    let object = &scene.objects[object];
    let columns = object.world_from_object.matrix3.as_mat3();
    let turned = move |p: &glam::Vec3| columns.x_axis * p.x + columns.y_axis * p.y + columns.z_axis * p.z;
    let positions = scene.meshes[object.mesh as usize].positions.iter();
    positions.map(move |position| turned(position).as_dvec3() + object.world_from_object.translation)
}

#[test]
fn world_bounds_hold_every_vertex() {
    for entry in SCENES {
        let scene = make(entry.name, 0.02, 3);
        let bounds = WorldBounds::new(&scene);
        let all = scene.bounds();
        for (index, object) in scene.objects.iter().enumerate() {
            let world = bounds.of(object.mesh, &object.world_from_object);
            assert_eq!(world, scene.world_bounds(index));
            assert_eq!(all.union(world), all);
            for vertex in gpu_vertices(&scene, index) {
                assert!(world.contains(vertex), "{}: '{}' at {vertex} leaves {world:?}", entry.name, object.name);
            }
        }
    }
}

#[test]
fn the_same_options_give_the_same_scene() {
    for entry in SCENES {
        let hash = |scale, seed| make(entry.name, scale, seed).content_hash();
        assert_eq!(hash(0.1, 1), hash(0.1, 1), "{}", entry.name);
        assert_ne!(hash(0.1, 1), hash(0.1, 2), "{}: the seed does nothing", entry.name);
        assert_ne!(hash(0.1, 1), hash(0.2, 1), "{}: the scale does nothing", entry.name);
    }
}

#[test]
fn objects_grow_with_scale() {
    let standards = [
        ("city-block", 94_000.0),
        ("rooms", 4_000.0),
        ("forest", 12_000.0),
        ("boxes", 402.0),
        ("moving-boxes", 402.0),
        ("bad-bounds", 2_000.0),
    ];
    for (name, standard) in standards {
        for scale in [0.25, 1.0, 2.0] {
            let count = make(name, scale, 1).objects.len() as f64;
            assert!((count / (standard * scale) - 1.0).abs() < 0.2, "{name} at {scale}: {count}");
        }
    }
    assert_eq!(make("cb", 1.0, 1).objects.len(), 94_000);
}

#[test]
fn the_smallest_scenes_are_still_scenes() {
    for entry in SCENES {
        let scene = make(entry.name, 1e-9, 1);
        assert!((8..400).contains(&scene.objects.len()), "{}: {}", entry.name, scene.objects.len());
        for name in CameraPath::names(&scene) {
            let shot = CameraPath::named(&scene, Some(name), 1.0).expect("a path").sample(3, 8);
            assert!(shot.pose.position.is_finite() && shot.pose.rotation.is_finite());
        }
    }
}

#[test]
fn the_city_has_ten_to_twenty_five_million_triangles() {
    let triangles = make("cb", 1.0, 1).triangles();
    assert!((10_000_000..25_000_000).contains(&triangles), "{triangles}");
}

#[test]
fn from_the_street_most_of_the_city_is_hidden() {
    let city = make("cb", 0.25, 1);
    let path = CameraPath::named(&city, Some("walk"), 1.0).expect("a walk");
    for frame in [0, 30, 60] {
        let picture = ItemBuffer::draw(&city, &path.sample(frame, 61), 320, 180);
        let visible = picture.visible() as f64 / city.objects.len() as f64;
        assert!(visible < 0.05, "frame {frame}: {visible}");
        assert!(picture.visible() > 50 && picture.covered() > 0.6, "frame {frame} shows no city");
    }
}

#[test]
fn the_eye_stands_in_half_of_all_bad_boxes() {
    for (scale, seed) in [(0.1, 1), (1.0, 1), (1.0, 9), (4.0, 2)] {
        let (bad, good) = (make("bad-bounds", scale, seed), make("good-bounds", scale, seed));
        let around_the_eye = |scene: &Scene| {
            let eye = scene.cameras[0].pose.position;
            let holds = |object: &usize| scene.world_bounds(*object).contains(eye);
            (0..scene.objects.len()).filter(holds).count()
        };
        let bodies = bad.objects.iter().filter(|object| bad.meshes[object.mesh as usize].name != "block").count();
        assert_eq!(around_the_eye(&bad), bodies / 2);
        assert_eq!(around_the_eye(&good), 0);
        let drawn = |scene: &Scene| {
            let place = |object: &scenes::Object| {
                (scene.meshes[object.mesh as usize].positions.clone(), object.world_from_object)
            };
            scene.objects.iter().map(place).collect::<Vec<_>>()
        };
        assert!(drawn(&bad) == drawn(&good), "the two scenes differ in more than their boxes");
    }
}

#[test]
fn most_of_the_forest_is_masked_leaves_and_some_of_it_glass() {
    let forest = make("forest", 0.5, 1);
    let share = |chosen: fn(&scenes::Object) -> bool| {
        forest.objects.iter().filter(|object| chosen(object)).count() as f64 / forest.objects.len() as f64
    };
    assert!(share(|object| object.masked && object.surface.texture.is_some()) > 0.5);
    assert!((0.02..0.2).contains(&share(|object| object.translucent && object.colour[3] < 1.0)));
    for texture in &forest.textures {
        let holes = texture.texels.iter().filter(|texel| texel[3] == 0).count() as f64 / texture.texels.len() as f64;
        assert!((0.2..0.8).contains(&holes), "{}: {holes}", texture.name);
    }
}

#[test]
fn rooms_are_closed_but_for_their_doorways() {
    let rooms = make("rooms", 0.2, 5);
    let path = CameraPath::named(&rooms, Some("walk"), 4.0).expect("a walk");
    for frame in 0..12 {
        let picture = ItemBuffer::draw(&rooms, &path.sample(frame, 12), 160, 90);
        assert_eq!(picture.covered(), 1.0, "frame {frame} sees out of the house");
        assert!(picture.visible() < rooms.objects.len() / 5, "frame {frame} sees {}", picture.visible());
    }
}

#[test]
fn walks_meet_no_obstacle() {
    for (name, scale) in [("city-block", 0.3), ("rooms", 1.0)] {
        let scene = make(name, scale, 2);
        let path = CameraPath::named(&scene, Some("walk"), 8.0).expect("a walk");
        let bounds = WorldBounds::new(&scene);
        let boxes: Vec<Aabb> =
            scene.objects.iter().map(|object| bounds.of(object.mesh, &object.world_from_object)).collect();
        for frame in 0..200 {
            let eye = path.sample(frame, 200).pose.position;
            let hit = boxes.iter().position(|bounds| bounds.contains(eye));
            // A doorway's box holds its opening.
            let hit = hit.filter(|&object| !scene.objects[object].name.starts_with("doorway"));
            assert_eq!(hit.map(|object| &scene.objects[object].name), None, "{name}, frame {frame} at {eye}");
        }
    }
}

#[test]
fn boxes_have_every_kind_of_transform() {
    let scene = make("boxes", 1.0, 1);
    let determinants: Vec<f64> =
        scene.objects.iter().map(|object| object.world_from_object.matrix3.determinant()).collect();
    assert!(determinants.iter().filter(|&&determinant| determinant < -1e-6).count() > 10, "reflected");
    assert!(determinants.iter().filter(|determinant| determinant.abs() < 1e-9).count() > 10, "flat");
}

#[test]
fn a_third_of_the_moving_boxes_move_and_nothing_else() {
    let scene = make("moving-boxes", 1.0, 1);
    let dynamic: Vec<u32> =
        (0..scene.objects.len() as u32).filter(|&index| scene.objects[index as usize].dynamic).collect();
    assert_eq!(dynamic, scene.motion.dynamic_objects());
    assert!(matches!(scene.motion, Motion::Orbits(_)));
    assert!((0.3..0.36).contains(&(dynamic.len() as f64 / scene.objects.len() as f64)));
    let mut now = Vec::new();
    scene.motion.transforms_at(0.0, &mut now);
    for &(object, transform) in &now {
        let placed = scene.objects[object as usize].world_from_object;
        assert!(
            (transform.translation - placed.translation).length() < 1e-9,
            "at time 0 objects are where they are placed"
        );
    }
    let mut later = Vec::new();
    scene.motion.transforms_at(1.3, &mut later);
    let moved: HashSet<u32> = now.iter().zip(&later).filter(|(a, b)| a.1 != b.1).map(|(a, _)| a.0).collect();
    assert_eq!(moved.len(), dynamic.len());
}

#[test]
fn two_thirds_of_what_stands_among_the_walls_are_tentacles_and_each_sways() {
    let scene = make("tentacles", 0.5, 1);
    assert_eq!((scene.objects.len(), scene.deformed.len()), (181, 120));
    let moving = scene.motion.dynamic_objects().into_iter();
    let bent = moving.map(|object| scene.objects[object as usize].mesh);
    assert!(bent.eq(scene.deformed.iter().map(|deformed| deformed.mesh)));
    let (now, later) = (scene.joints_at(0.0), scene.joints_at(1.5));
    for skin in scene.deformed.iter().filter_map(|deformed| deformed.skin) {
        assert_ne!(now.of(skin), later.of(skin), "tentacle {skin}");
    }
}

#[test]
fn two_thirds_of_what_swims_among_the_walls_are_jellyfish_and_each_changes_its_shape() {
    let scene = make("jellyfish", 0.5, 1);
    assert_eq!((scene.objects.len(), scene.deformed.len(), scene.skins.len()), (136, 90, 30));
    let (now, later) = (scene.meshes_at(0.0), scene.meshes_at(1.5));
    for deformed in &scene.deformed {
        let mesh = deformed.mesh as usize;
        assert!(now[mesh].positions != later[mesh].positions && now[mesh].normals != later[mesh].normals);
        assert_eq!(now[mesh].positions, scene.meshes[mesh].positions, "a scene's meshes are those of time 0");
    }
    // Some swim, some stay where they are.
    let (mut before, mut after) = (Vec::new(), Vec::new());
    scene.motion.transforms_at(0.0, &mut before);
    scene.motion.transforms_at(1.5, &mut after);
    let moves = before.iter().zip(&after).filter(|(before, after)| before.1 != after.1).count();
    assert!((40..80).contains(&moves), "{moves}");
}

#[test]
fn the_hash_sees_every_change_of_a_morph() {
    let base = make("jellyfish", 0.05, 1);
    type Change = fn(&mut Scene);
    let changes: [Change; 6] = [
        |scene| scene.deformed[1].targets[2].displacements[3].position.x += 1e-6,
        |scene| scene.deformed[1].targets[2].displacements[3].normal.x += 1e-6,
        |scene| scene.deformed[1].targets[2].displacements[3].vertex += 1,
        |scene| scene.deformed[1].targets[2].weight += 1,
        |scene| scene.deformed[1].targets.swap(0, 1),
        |scene| {
            let Motion::Nodes(nodes) = &scene.motion else { panic!("jellyfish hang on nodes") };
            let mut weights = nodes.weights().to_vec();
            weights.swap(3, 4);
            scene.motion = Motion::Nodes(nodes.clone().with_weights(weights));
        },
    ];
    for (index, change) in changes.iter().enumerate() {
        let mut scene = base.clone();
        change(&mut scene);
        assert_ne!(scene.content_hash(), base.content_hash(), "change {index}");
    }
}

#[test]
fn the_hash_sees_every_change_of_a_skeleton() {
    let base = make("tentacles", 0.05, 1);
    type Change = fn(&mut Scene);
    let changes: [Change; 6] = [
        |scene| scene.deformed[1].rest[2].position.x += 1e-6,
        |scene| scene.deformed[1].rest[2].normal = -scene.deformed[1].rest[2].normal,
        |scene| scene.deformed[1].rest[2].joints.swap(0, 1),
        |scene| scene.deformed[1].rest[30].weights.swap(0, 1),
        |scene| scene.deformed.swap(0, 1),
        |scene| scene.skins.swap(0, 1),
    ];
    for (index, change) in changes.iter().enumerate() {
        let mut scene = base.clone();
        change(&mut scene);
        assert_ne!(scene.content_hash(), base.content_hash(), "change {index}");
    }
}

#[test]
fn the_hash_sees_every_change_of_a_picture() {
    let base = make("moving-boxes", 0.1, 1);
    type Change = fn(&mut Scene);
    let changes: [Change; 16] = [
        |scene| scene.meshes[1].positions[2].x += 1e-6,
        |scene| scene.meshes[1].normals[2] = -scene.meshes[1].normals[2],
        |scene| scene.meshes[1].indices.swap(0, 1),
        |scene| scene.objects[4].world_from_object.translation.y += 1e-12,
        |scene| scene.objects[4].mesh = (scene.objects[4].mesh + 1) % 5,
        |scene| scene.objects[4].colour[0] += 1e-6,
        |scene| scene.objects[4].masked = true,
        |scene| scene.objects[4].surface.cutoff += 1e-6,
        |scene| scene.objects[4].surface.single_sided = true,
        |scene| scene.objects[4].surface.texture = Some(0),
        |scene| scene.meshes[1].texture_coordinates = vec![Vec2::ZERO; scene.meshes[1].positions.len()],
        |scene| scene.meshes[1].colours = vec![[1.0; 4]; scene.meshes[1].positions.len()],
        |scene| scene.textures = vec![Texture { size: [1, 1], texels: vec![[9; 4]], ..Texture::default() }],
        |scene| scene.objects.swap(4, 5),
        |scene| scene.cameras[0].pose.position.x += 1e-9,
        |scene| match &mut scene.motion {
            Motion::Orbits(orbits) => orbits[0].bob_period_s += 1e-9,
            _ => unreachable!("moving boxes orbit"),
        },
    ];
    let hash = base.content_hash();
    for (index, change) in changes.iter().enumerate() {
        let mut scene = base.clone();
        change(&mut scene);
        assert_ne!(scene.content_hash(), hash, "change {index}");
    }
    let mut renamed = base.clone();
    renamed.objects[4].name = "other".into();
    assert_eq!(renamed.content_hash(), hash, "names do not show in a picture");
}

#[test]
fn errors_say_what_to_do() {
    let options = SceneOptions::default();
    let message = |name: &str| open(name, &options).expect_err("there is no such scene").to_string();
    let names: Vec<&str> = SCENES.iter().map(|entry| entry.name).collect();
    assert!(names.starts_with(&["city-block"]) && message("no-such-scene").contains(&names.join(", ")));
    assert!(message("missing.glb").starts_with("missing.glb: cannot read it"));
    assert!(message("missing.obj").contains("there is no scene 'missing.obj'"));
    let file = std::env::temp_dir().join(format!("sightline-{}.obj", std::process::id()));
    std::fs::write(&file, "v 0 0 0").expect("the file can be written");
    let message = message(&file.to_string_lossy());
    std::fs::remove_file(&file).expect("the file can be removed");
    assert!(message.contains(".obj is not supported; convert it"), "{message}");
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let result = open("boxes", &SceneOptions { scale, seed: 1, ..Default::default() });
        assert!(matches!(result, Err(SceneError::Unknown { .. })), "scale {scale}");
    }
}

/// Where a ray meets a triangle, in lengths of the ray.
fn meets_triangle(from: DVec3, along: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let normal = (b - a).cross(c - a);
    let at = (a - from).dot(normal) / along.dot(normal);
    let point = from + at * along;
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (*q - *p).cross(point - *p).dot(normal) >= -1e-9);
    (at.is_finite() && inside).then_some(at)
}

/// Rays from around a mesh to points in a box that are in the box before they meet the mesh.
fn rays_into(mesh: &scenes::Mesh, solid: &Aabb) -> usize {
    let mut state = 7u64;
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as f64 / (1u64 << 31) as f64
    };
    let mut into = 0;
    for _ in 0..2_000 {
        let [x, y, z] = [unit(), unit(), unit()].map(|part| 2.0 * part - 1.0);
        let from = DVec3::new(x, y, z).normalize() * 4.0;
        let point = solid.min + (solid.max - solid.min) * DVec3::new(unit(), unit(), unit());
        let along = point - from;
        let ends = [(solid.min - from) / along, (solid.max - from) / along];
        let enters = ends[0].min(ends[1]).max_element();
        let corners = |triangle: &[u32]| [0, 1, 2].map(|corner| mesh.positions[triangle[corner] as usize].as_dvec3());
        let first = mesh.indices.chunks_exact(3).filter_map(|triangle| meets_triangle(from, along, corners(triangle)));
        into += usize::from(first.fold(f64::INFINITY, f64::min) > enters + 1e-6);
    }
    into
}

#[test]
fn what_is_solid_of_a_building_is_enclosed_by_its_mesh() {
    for name in ["city-block", "radial-city"] {
        let scene = make(name, 0.05, 2);
        assert!(scene.buildings.len() > 20, "{name}: {} buildings", scene.buildings.len());
        let mut seen = HashSet::new();
        for building in &scene.buildings {
            let mesh = scene.objects[building.object as usize].mesh;
            let mesh = &scene.meshes[mesh as usize];
            if !seen.insert(&mesh.name) {
                continue;
            }
            assert_eq!(rays_into(mesh, &building.solid), 0, "{name}: '{}' is open", mesh.name);
            // A box that reaches out is caught, and so is an open mesh.
            let larger = Aabb { min: building.solid.min - 0.1, max: building.solid.max + 0.1 };
            assert!(rays_into(mesh, &larger) > 0, "{name}: '{}'", mesh.name);
        }
    }
    assert!(make("rooms", 0.1, 1).buildings.is_empty());
}

#[test]
fn buildings_that_are_none_are_refused_by_name() {
    let mut scene = make("city-block", 0.01, 1);
    scene.buildings[0].solid.max.y = 7.0;
    let fault = scene.check().unwrap_err().to_string();
    assert!(fault.contains("shell") && fault.contains("reaches out of its mesh"), "{fault}");
    scene.buildings[0].object = 1_000_000;
    assert!(scene.check().unwrap_err().to_string().contains("number 1000000"));
}
