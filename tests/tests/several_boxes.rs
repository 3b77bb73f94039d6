//! Objects asked about by several boxes (GPU Gems 29.5.1): nothing is lost, the boxes hold their objects where the device draws them, no
//! more is drawn than with one box, and planted errors are caught.

#[path = "several_boxes/planted.rs"]
mod planted;

use culling::World;
use engine::Gpu;
use glam::{DVec3, Vec3};
use harness::sessions::{self, faults};
use harness::{assert_none, gpu, laws, worlds, Case, Lab, Subject};
use scenes::{Aabb, MovingBounds, SceneOptions, Topology};
use sightline::run::session::{Session, SessionOptions};

const METHODS: [&str; 4] = ["query-wait", "chc", "chc++", "nohc"];

/// Three frames of one of the bench's scenes and paths.
fn of_a_session(gpu: &Gpu, run: (&str, f64, &str)) -> Case {
    let session = sessions::open(gpu, run, 3);
    let shots = (0..3).map(|frame| session.path().sample(frame, 3)).collect();
    Case { name: run.0.into(), scene: session.scene.clone(), shots, size: [320, 180] }
}

#[test]
fn no_visible_object_is_culled_in_worlds_of_every_kind() {
    let gpu = gpu();
    for case in worlds::special() {
        for (method, boxes) in [("query-wait", "8"), ("query-wait", "4"), ("chc", "8"), ("chc++", "4"), ("nohc", "8")] {
            let subject = Subject::named(method).with("boxes", boxes);
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
    }
}

#[test]
fn two_runs_give_the_same_bytes() {
    let gpu = gpu();
    for method in METHODS {
        let (subject, case) =
            (Subject::named(method).with("boxes", "4"), of_a_session(&gpu, ("monsters", 0.05, "walk")));
        assert_none(&laws::two_runs_give_the_same_bytes(&gpu, &subject, &case));
        assert_none(&laws::decisions_do_not_depend_on_the_pass(&gpu, &subject, &case));
    }
}

/// On the bench's scenes and paths, things that move among them.
#[test]
fn sessions_lose_nothing() {
    let gpu = gpu();
    for run in sessions::RUNS.iter().filter(|(_, _, path)| ["walk", "rotate", "zoom", "pan"].contains(path)) {
        let mut session = sessions::open(&gpu, *run, 4);
        for (method, boxes) in [("query-wait", "8"), ("chc", "4"), ("chc++", "8")] {
            assert_none(&faults(&mut session, method, &[("boxes", boxes)]));
        }
    }
    for scene in ["forest", "satellite"] {
        let mut session = sessions::open(&gpu, (scene, 0.01, "walk"), 4);
        assert_none(&faults(&mut session, "query-wait", &[("boxes", "8")]));
        assert_none(&faults(&mut session, "nohc", &[("boxes", "8")]));
    }
}

/// Boxes of what moves follow it however its one box is had.
#[test]
fn what_moves_is_not_lost_with_any_bounds() {
    let gpu = gpu();
    for bounds in MovingBounds::ALL {
        let scene = scenes::open("moving-boxes", &SceneOptions { scale: 0.5, ..SceneOptions::default() }).unwrap();
        let path = Some("rotate".into());
        let options =
            SessionOptions { path, whole_path: true, frames: 4, size: [160, 90], bounds, ..SessionOptions::default() };
        let mut session = Session::with_scene(&gpu, scene, options).unwrap();
        for method in ["query-wait", "chc"] {
            assert_none(&faults(&mut session, method, &[("boxes", "8")]));
        }
    }
}

/// Before a camera that stands still, what is hidden is asked about by its boxes, and nothing is missing.
#[test]
fn query_lag_is_exact_before_a_still_camera() {
    let gpu = gpu();
    let subject = Subject::named("query-lag").with("boxes", "8");
    for case in worlds::special() {
        assert_none(&harness::approximate::a_still_camera_is_exact(&gpu, &subject, &case));
        assert_none(&harness::approximate::a_first_frame_is_exact(&gpu, &subject, &case));
    }
}

/// `query-wait` asks about the same objects in the same batches. What more boxes cull adds nothing to the depth if it is drawn, so that by
/// induction the picture of depth is the same at each batch, and what is drawn with more boxes is drawn with fewer.
#[test]
fn what_is_drawn_with_more_boxes_is_drawn_with_fewer() {
    let gpu = gpu();
    let mut fewer_in_all = 0;
    for run in [("rooms", 0.1, "walk"), ("city-block", 0.02, "walk"), ("forest", 0.02, "walk"), ("boxes", 1.0, "pan")] {
        let case = of_a_session(&gpu, run);
        let mut lab = Lab::new(&gpu, &case);
        let mut drawn = |boxes: &str| {
            let (_, sets) = lab.truths(&case.shots);
            let mut method = lab.make(&Subject::named("query-wait").with("boxes", boxes).with("batch", "8"), &sets);
            let take = |(frame, shot)| lab.take(&mut *method, shot, frame).drawn.objects;
            case.shots.iter().enumerate().flat_map(take).collect::<Vec<bool>>()
        };
        let [one, four, eight] = ["1", "4", "8"].map(&mut drawn);
        let beyond =
            |more: &[bool], fewer: &[bool]| more.iter().zip(fewer).filter(|(more, fewer)| **more && !**fewer).count();
        assert_eq!(beyond(&four, &one), 0, "{run:?}: drawn with 4 boxes and not with 1");
        assert_eq!(beyond(&eight, &four), 0, "{run:?}: drawn with 8 boxes and not with 4");
        let count = |drawn: &[bool]| drawn.iter().filter(|drawn| **drawn).count();
        println!("{run:?}: {} drawn with 1 box, {} with 4, {} with 8", count(&one), count(&four), count(&eight));
        fewer_in_all += count(&one) - count(&eight);
    }
    assert!(fewer_in_all > 0, "8 boxes cull nothing that one does not, so this proves nothing");
}

/// Points of an object's triangles that none of its boxes holds, at a time of the scene. The device turns vertices in f32, and adds the place
/// in f64's precision; between corners, only weighing them rounds.
fn points_outside(world: &World, case: &Case, most: u32, spoil: impl Fn(&mut Vec<Aabb>)) -> usize {
    let meshes = world.boxes_of_meshes(most).unwrap();
    let mut outside = 0;
    for object in 0..world.len() as u32 {
        let mut boxes: Vec<Aabb> = world.gpu_boxes_of_object(object, &meshes).map(|bounds| aabb(&bounds)).collect();
        spoil(&mut boxes);
        let mesh = &case.scene.meshes[case.scene.objects[world.scene_object(object as usize)].mesh as usize];
        let placed = world.host_objects()[object as usize];
        let [x, y, z] = [placed.column_x, placed.column_y, placed.column_z].map(Vec3::from);
        let at = Vec3::from(placed.origin_high).as_dvec3() + Vec3::from(placed.origin_low).as_dvec3();
        let turned = |corner: Vec3| (x * corner.x + y * corner.y + z * corner.z).as_dvec3() + at;
        for corners in mesh.primitives() {
            let [a, b, c] = corners.map(turned);
            let weights = (0..=4).flat_map(|u| (0..=4 - u).map(move |v| (f64::from(u) / 4.0, f64::from(v) / 4.0)));
            let points = weights.map(|(u, v)| (1.0 - u - v) * a + u * b + v * c);
            let rounding = DVec3::splat(8.0 * f64::EPSILON * a.abs().max(b.abs()).max(c.abs()).max_element());
            let out = |point: &DVec3| !boxes.iter().any(|box_| box_.widened(rounding).contains(*point));
            outside += points.filter(out).count();
        }
    }
    outside
}

fn aabb(bounds: &shaders::types::Bounds) -> Aabb {
    let [high, low, half] =
        [bounds.centre_high, bounds.centre_low, bounds.half_extent].map(|part| Vec3::from(part).as_dvec3());
    Aabb { min: high + low - half, max: high + low + half }
}

fn cases_of_boxes() -> [Case; 2] {
    [worlds::special::topologies(), worlds::special::stepping_into_boxes()]
}

/// Where objects are turned, reflected and skewed; of triangles, lines and points.
#[test]
fn boxes_hold_their_objects_where_the_device_draws_them() {
    let gpu = gpu();
    let mut cases = Vec::from(cases_of_boxes());
    for (name, path) in [("boxes", "pan"), ("moving-boxes", "rotate"), ("monsters", "walk")] {
        cases.push(of_a_session(&gpu, (name, 0.1, path)));
    }
    let lines = cases.iter().flat_map(|case| &case.scene.meshes).filter(|mesh| mesh.topology == Topology::Lines);
    assert!(lines.count() > 0, "no lines, so this proves nothing of them");
    for case in &cases {
        let mut lab = Lab::new(&gpu, case);
        for (frame, shot) in case.shots.iter().take(3).enumerate() {
            lab.look(shot, frame);
            for most in [4, 8] {
                assert_eq!(points_outside(&lab.world, case, most, |_| ()), 0, "{}, {most} boxes", case.name);
            }
        }
        let meshes = lab.world.boxes_of_meshes(8).unwrap();
        let several = meshes.iter().flatten().filter(|boxes| boxes.len() > 1).count();
        assert!(several > 0, "{}: each mesh has one box, so this proves nothing", case.name);
        let shrunk = |boxes: &mut Vec<Aabb>| {
            boxes.iter_mut().for_each(|box_| box_.max = box_.min.lerp(box_.max, 0.9));
        };
        assert!(points_outside(&lab.world, case, 8, shrunk) > 0, "{}: shrunk boxes", case.name);
        assert!(points_outside(&lab.world, case, 8, |boxes| _ = boxes.pop()) > 0, "{}: a box is lost", case.name);
    }
}

/// Boxes that are shown are boxes that are counted; they lie in their objects' one box, and of leaves alone are there several.
#[test]
fn boxes_shown_are_boxes_counted() {
    let gpu = gpu();
    let case = of_a_session(&gpu, ("monsters", 0.1, "walk"));
    let mut lab = Lab::new(&gpu, &case);
    let (_, sets) = lab.truths(&case.shots);
    for method in METHODS.into_iter().chain(["query-lag"]) {
        let mut count = |boxes: &str| {
            let mut method = lab.make(&Subject::named(method).with("boxes", boxes), &sets);
            let (mut boxes, mut queries) = (0, 0);
            for (frame, shot) in case.shots.iter().enumerate() {
                method.count_work(true);
                lab.take(&mut *method, shot, frame);
                let (work, shown) = (method.work().unwrap(), method.tested_boxes(&lab.world).unwrap().unwrap());
                assert_eq!((shown.groups.len() + shown.singles.len()) as u64, work.boxes);
                // Rounded outward for the device.
                let owns: Vec<Aabb> =
                    lab.world.host_bounds().iter().map(|own| own.widened(DVec3::splat(1e-4))).collect();
                let strange =
                    shown.singles.iter().filter(|one| !owns.iter().any(|own| own.union(**one) == *own)).count();
                assert_eq!(strange, 0, "boxes lie in no object's own");
                (boxes, queries) = (boxes + work.boxes, queries + work.queries);
            }
            (boxes, queries)
        };
        let (one, several) = (count("1"), count("8"));
        println!("{method}: {one:?} boxes and queries with one box, {several:?} with eight");
        if method == "query-wait" {
            assert!(several.0 > one.0 && several.1 <= one.1, "{one:?} and {several:?}");
        }
    }
}

#[test]
fn meshes_with_a_declared_box_keep_it() {
    let gpu = gpu();
    let scene = scenes::open("bad-bounds", &SceneOptions { scale: 0.05, ..SceneOptions::default() }).unwrap();
    let world = World::new(&gpu, &scene).unwrap();
    let meshes = world.boxes_of_meshes(8).unwrap();
    let mut declared = 0;
    for object in 0..world.len() {
        let mesh = scene.objects[world.scene_object(object)].mesh as usize;
        let boxes: Vec<Aabb> = world.boxes_of_object(object as u32, &meshes).collect();
        if scene.meshes[mesh].honoured_bounds().is_some() {
            declared += 1;
            assert_eq!(boxes, [world.host_bounds()[object]]);
        }
    }
    assert!(declared > 0);
}
