//! Laws of the papers' benchmark scenes: the papers' numbers, levels of detail, and what the camera sees and hides.

#[path = "support/places.rs"]
mod places;
mod support;

use glam::DVec3;
use places::{farthest_motion_px, may_be_in_view, InsideTest};
use scenes::procedural::{Entry, MOST_DETAIL, SCENES};
use scenes::{open, CameraPath, Scene, SceneOptions, Shot, WorldBounds};
use std::collections::HashSet;
use support::ItemBuffer;

fn make(name: &str, scale: f64, detail: u32) -> Scene {
    open(name, &SceneOptions { scale, seed: 3, detail }).expect("a procedural scene opens")
}

fn benchmark_scenes() -> impl Iterator<Item = &'static Entry> {
    SCENES.iter().filter(|entry| entry.by_detail)
}

fn path(scene: &Scene, name: &str) -> CameraPath {
    CameraPath::named(scene, Some(name), 1.0).expect("every scene has it").whole()
}

#[test]
fn each_has_the_objects_that_its_paper_says() {
    let published = [
        ("balloons", 35_000),
        ("moving-balloons", 35_000),
        ("powerplant", 8_868),
        ("monsters", 6_300),
        ("yeahrights", 60),
        ("fantasy", 7_437),
        ("factory", 46_600),
        ("radial-city", 73_812),
        ("satellite", 120_000),
    ];
    assert_eq!(
        published.map(|(name, _)| name).to_vec(),
        benchmark_scenes().map(|entry| entry.name).collect::<Vec<_>>()
    );
    for (name, objects) in published {
        assert_eq!(make(name, 1.0, 0).objects.len(), objects, "{name}");
        for scale in [0.2, 0.5, 2.0] {
            let expected = (objects as f64 * scale).round() as usize;
            assert_eq!(make(name, scale, 0).objects.len(), expected, "{name} at {scale}");
        }
    }
}

#[test]
fn the_way_leaves_room_for_all_balloons_of_small_swarms() {
    for scale in [0.0007_f64, 0.001, 0.003, 0.01, 0.03, 0.1] {
        let expected = (35_000.0 * scale).round() as usize;
        assert_eq!(make("balloons", scale, 0).objects.len(), expected.max(24), "at {scale}");
    }
}

/// Table 1 of the EOVC thesis, and Kim 2015, V, at the level of detail that our documentation names.
#[test]
fn at_the_right_level_they_have_about_the_papers_triangles() {
    let published = [
        ("powerplant", 4, 153e6),
        ("fantasy", 2, 17_879_189.0),
        ("factory", 1, 5_718_850.0),
        ("radial-city", 1, 1_272_764.0),
        ("satellite", 4, 807_172_000.0),
    ];
    for (name, level, triangles) in published {
        let ours = make(name, 1.0, level).triangles() as f64;
        assert!((ours / triangles - 1.0).abs() < 0.1, "{name} at level {level}: {ours}, not {triangles}");
    }
}

#[test]
fn a_level_has_about_four_times_the_triangles_of_the_one_before() {
    for entry in benchmark_scenes() {
        let triangles = |level| make(entry.name, 0.1, level).triangles() as f64;
        for level in 1..MOST_DETAIL {
            let times = triangles(level + 1) / triangles(level);
            assert!((3.0..4.5).contains(&times), "{} from level {level}: {times} times", entry.name);
        }
        assert!(triangles(0) <= triangles(1), "{}", entry.name);
    }
    let refused = open("balloons", &SceneOptions { detail: MOST_DETAIL + 1, ..SceneOptions::default() });
    assert!(refused.expect_err("a level too high").to_string().contains("detail level '5'; choose one of: 0, 1"));
}

#[test]
fn levels_change_neither_places_nor_colours() {
    for entry in benchmark_scenes() {
        let (coarse, fine) = (make(entry.name, 0.05, 0), make(entry.name, 0.05, 2));
        let places = |scene: &Scene| {
            scene
                .objects
                .iter()
                .map(|object| (object.mesh, object.world_from_object, object.colour))
                .collect::<Vec<_>>()
        };
        assert!(places(&coarse) == places(&fine), "{}", entry.name);
        assert_eq!((coarse.cameras, coarse.walk), (fine.cameras, fine.walk), "{}", entry.name);
    }
}

/// Vertices and indices of all meshes: what a level of detail costs on the device, whatever the number of objects.
#[test]
fn the_finest_meshes_fit_into_one_gibibyte() {
    for entry in benchmark_scenes() {
        let scene = make(entry.name, 1.0, MOST_DETAIL);
        let bytes: usize = scene.meshes.iter().map(|mesh| 24 * mesh.positions.len() + 4 * mesh.indices.len()).sum();
        assert!(bytes < 1 << 30, "{}: {} MiB", entry.name, bytes >> 20);
    }
}

#[test]
fn no_triangle_is_flat_and_no_two_objects_are_in_one_place() {
    for entry in benchmark_scenes() {
        for level in [0, 1, 2] {
            for mesh in make(entry.name, 0.1, level).meshes {
                let corner = |index: u32| mesh.positions[index as usize].as_dvec3();
                for triangle in mesh.indices.chunks_exact(3) {
                    let [a, b, c] = [0, 1, 2].map(|number| corner(triangle[number]));
                    let area = (b - a).cross(c - a).length();
                    assert!(
                        area > 1e-12,
                        "{}, level {level}: a triangle of '{}' at {a}: {area}",
                        entry.name,
                        mesh.name
                    );
                }
            }
        }
        let scene = make(entry.name, 1.0, 0);
        let places: HashSet<_> = scene
            .objects
            .iter()
            .map(|object| (object.mesh, object.world_from_object.to_cols_array().map(f64::to_bits)))
            .collect();
        assert_eq!(places.len(), scene.objects.len(), "{}", entry.name);
    }
}

#[test]
fn the_camera_sees_something_in_every_frame() {
    for entry in benchmark_scenes() {
        let scene = make(entry.name, 0.1, 0);
        for name in ["walk", "closing-in", "rotate"] {
            let path = path(&scene, name);
            for frame in 0..9 {
                let picture = ItemBuffer::draw(&scene, &path.sample(frame, 9), 80, 45);
                let (visible, covered) = (picture.visible(), picture.covered());
                // A few tangles can be looked past, but not their ground.
                let least = if scene.objects.len() < 10 { 1 } else { 4 };
                assert!(
                    visible >= least && covered > 0.02,
                    "{} {name}, frame {frame}: {visible}, {covered}",
                    entry.name
                );
            }
        }
    }
}

#[test]
fn the_camera_is_in_no_solid() {
    for entry in benchmark_scenes() {
        for scale in [0.02, 0.2, 1.0] {
            let scene = make(entry.name, scale, 1);
            let test = InsideTest::new(&scene);
            for (name, frames) in [("walk", 200), ("closing-in", 60)] {
                let path = path(&scene, name);
                for frame in 0..frames {
                    let shot = path.sample(frame, frames);
                    let solid = test.solid_around(shot.pose.position, shot.seconds);
                    let solid = solid.map(|object| &scene.objects[object].name);
                    assert_eq!(solid, None, "{} {name} at {scale}, frame {frame}", entry.name);
                }
            }
        }
    }
}

#[test]
fn a_place_within_a_solid_is_noticed() {
    let scene = make("moving-balloons", 0.02, 1);
    let test = InsideTest::new(&scene);
    let mut later = Vec::new();
    scene.motion.transforms_at(3.0, &mut later);
    // 2 m above its origin is the middle of a balloon, 9 m below it that of its basket, and in between is air.
    for (pair, place) in later.chunks_exact(2).enumerate() {
        let found = |up: f64| test.solid_around(place[0].1.transform_point3(DVec3::Y * up), 3.0);
        let both = (Some(2 * pair), Some(2 * pair + 1), None);
        assert_eq!((found(2.0), found(-9.1), found(-6.5)), both, "pair {pair}");
    }
}

/// Objects seen, and objects whose boxes are at least partly in the view.
fn seen_of_those_in_view(scene: &Scene, shot: &Shot) -> (usize, usize) {
    let bounds = WorldBounds::new(scene);
    let boxes = scene.objects.iter().map(|object| bounds.of(object.mesh, &object.world_from_object));
    let in_view = boxes.filter(|bounds| may_be_in_view(bounds, shot, 16.0 / 9.0)).count();
    (ItemBuffer::draw(scene, shot, 320, 180).visible(), in_view)
}

/// How much of what is in view shows where the camera comes to rest: in the open scenes much, among houses and halls little.
#[test]
fn scenes_are_as_open_as_their_papers_say() {
    let most_seen = [("factory", 0.5, 0.06), ("radial-city", 0.2, 0.2), ("fantasy", 1.0, 0.25)];
    for (name, scale, most) in most_seen {
        let scene = make(name, scale, 0);
        let (seen, in_view) = seen_of_those_in_view(&scene, &path(&scene, "still").sample(0, 1));
        assert!((seen as f64) < most * in_view as f64, "{name}: {seen} of {in_view}");
    }
    // "Which has many unoccluded spaces", and of Kim's monsters "culling is generally not effective".
    let least_seen = [("satellite", 0.02, 0.2), ("monsters", 0.5, 0.1), ("fantasy", 0.5, 0.1)];
    for (name, scale, least) in least_seen {
        let scene = make(name, scale, 0);
        let (seen, in_view) = seen_of_those_in_view(&scene, &path(&scene, "closing-in").sample(0, 3));
        assert!(seen as f64 > least * in_view as f64, "{name}: {seen} of {in_view}");
    }
}

/// "The averages of maximal per-frame motion in the scenes are 16, 35, 26, and 29 pixels/frame for YR, MO, BL, and CB" (Lee et
/// al. 2018, 4.1).
#[test]
fn walks_move_the_picture_as_fast_as_the_papers_do() {
    for (name, scale, published) in [("yeahrights", 1.0, 16.0), ("monsters", 1.0, 35.0), ("balloons", 0.3, 26.0)] {
        let scene = make(name, scale, 0);
        let walk = CameraPath::named(&scene, Some("walk"), 1.0).expect("a walk");
        let frames = (1..24).map(|sample| 40 * sample);
        let motion: Vec<f64> = frames
            .map(|frame| farthest_motion_px(&scene, &walk.sample(frame - 1, 960), &walk.sample(frame, 960)))
            .collect();
        let mean = motion.iter().sum::<f64>() / motion.len() as f64;
        assert!((0.75..1.33).contains(&(mean / published)), "{name}: {mean} px a frame, not {published}");
    }
}

#[test]
fn ninety_nine_in_a_hundred_objects_of_the_factory_are_hidden() {
    let scene = make("factory", 1.0, 0);
    let walk = path(&scene, "walk");
    for frame in 0..4 {
        let seen = ItemBuffer::draw(&scene, &walk.sample(frame, 4), 160, 90).visible();
        assert!(seen * 100 < scene.objects.len() && seen > 20, "frame {frame}: {seen} seen");
    }
}

#[test]
fn all_balloons_move_and_take_their_baskets_along() {
    let scene = make("moving-balloons", 0.05, 0);
    assert!(scene.objects.iter().all(|object| object.dynamic));
    let (mut now, mut later) = (Vec::new(), Vec::new());
    scene.motion.transforms_at(0.0, &mut now);
    scene.motion.transforms_at(2.5, &mut later);
    assert_eq!(now.len(), scene.objects.len());
    for (pair, (before, after)) in now.chunks_exact(2).zip(later.chunks_exact(2)).enumerate() {
        let moved = after[0].1.translation.distance(before[0].1.translation);
        assert!((1e-3..4.0).contains(&moved), "balloon {pair} moved by {moved} m");
        // A point in the basket keeps its place below the balloon.
        let (balloon, basket) = (after[0].1, after[1].1);
        let below = DVec3::new(0.4, -9.0, 0.2);
        assert!(balloon.transform_point3(below).distance(basket.transform_point3(below)) < 1e-6, "pair {pair}");
    }
    let still = make("balloons", 0.05, 0);
    assert!(still.objects.iter().zip(&scene.objects).all(|(a, b)| a.world_from_object == b.world_from_object));
}
