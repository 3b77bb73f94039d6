//! Bounds of what moves, had in each of four ways (GPU Gems 29.5.2): no exact method loses anything by them, the device has them as the host
//! does, and what they save is saved.

use culling::eovc::Tree;
use culling::World;
use harness::sessions::faults;
use harness::{assert_caught, assert_none, gpu};
use scenes::{export_glb, import_bytes, MovingBounds, Scene, SceneOptions};
use sightline::run::session::{Session, SessionOptions};
use sightline::run::truth::RunTruth;
use std::path::Path;

const LOOSER: [MovingBounds; 3] = [MovingBounds::PerAnimation, MovingBounds::Union, MovingBounds::InPlace];

/// Exact methods that test bounds of objects in different ways: planes, two trees, pyramids, rasterised boxes, warped depth, queries.
const METHODS: [&str; 9] =
    ["frustum", "frustum-bvh", "hzb", "hzb-iterative", "roc", "eovc", "woc-exact", "query-wait", "chc++"];

fn scene(name: &str, scale: f64) -> Scene {
    scenes::open(name, &SceneOptions { scale, seed: 1, ..SceneOptions::default() }).unwrap()
}

/// `moving-boxes` as a file: nodes with keys, and a box for each animation.
fn file() -> Scene {
    let glb = export_glb(&scene("moving-boxes", 0.5), None, 0).unwrap();
    import_bytes(Path::new("moving.glb"), &glb).unwrap()
}

fn session(gpu: &engine::Gpu, scene: Scene, path: &str, bounds: MovingBounds, frames: usize) -> Session {
    let path = Some(path.into());
    let options =
        SessionOptions { path, whole_path: true, frames, size: [160, 90], bounds, ..SessionOptions::default() };
    Session::with_scene(gpu, scene, options).unwrap()
}

fn in_every_way(scene: &Scene, path: &str) {
    let gpu = gpu();
    for mode in LOOSER {
        let mut session = session(&gpu, scene.clone(), path, mode, 4);
        for method in METHODS {
            assert_none(&faults(&mut session, method, &[]));
        }
    }
}

#[test]
fn boxes_that_move_are_never_lost() {
    in_every_way(&scene("moving-boxes", 0.5), "rotate");
}

#[test]
fn balloons_are_never_lost() {
    in_every_way(&scene("moving-balloons", 0.01), "walk");
}

#[test]
fn what_a_file_moves_is_never_lost() {
    in_every_way(&file(), "rotate");
}

/// Bounds of time 0 that are never moved, taken for those of all times: what moves out of them is lost, by whichever method. In twelve frames:
/// four showed a single lost object, and on a device with a coarser vertex grid, where boxes reach farther, none to most methods.
#[test]
fn bounds_that_stay_behind_are_caught() {
    let gpu = gpu();
    let moving = scene("moving-boxes", 0.5);
    // The scene that the world was made of rests, and so its bounds are those of time 0; what is drawn of it moves.
    let mut rests = session(&gpu, moving.clone(), "rotate", MovingBounds::PerFrame, 12);
    let mut still = moving;
    let places = still.motion.dynamic_objects();
    let scenes::Motion::Orbits(orbits) = &mut still.motion else { panic!("boxes move in orbits") };
    orbits.iter_mut().for_each(|orbit| (orbit.radians_per_s, orbit.bob_period_s) = (0.0, 0.0));
    assert!(!places.is_empty());
    rests.world = World::with_bounds(&gpu, &still, culling::Shading::of(&still), MovingBounds::Union).unwrap();
    METHODS.iter().for_each(|method| assert_caught(&faults(&mut rests, method, &[]), "false negatives"));
}

/// Where things are does not depend on how their bounds are had: the truth itself would move with transforms that were not brought.
#[test]
fn every_way_shows_the_same_pictures() {
    let gpu = gpu();
    for (scene, path) in
        [(scene("moving-boxes", 0.5), "rotate"), (scene("moving-balloons", 0.01), "walk"), (file(), "rotate")]
    {
        let pictures = |mode| {
            let mut session = session(&gpu, scene.clone(), path, mode, 4);
            let truth = RunTruth::draw(&mut session, || ()).unwrap();
            let frames = 0..session.frames();
            frames.map(|frame| truth.frame(&mut session, frame).unwrap().images().clone()).collect::<Vec<_>>()
        };
        let expected = pictures(MovingBounds::PerFrame);
        assert!(expected[0] != expected[expected.len() - 1], "nothing changes, so this proves nothing");
        for mode in LOOSER {
            assert!(pictures(mode) == expected, "{}, {mode:?}", scene.name);
        }
    }
}

/// The device has the host's bounds after each frame, however many times have passed between frames.
#[test]
fn the_device_has_the_bounds_of_the_host() {
    let gpu = gpu();
    let scene = file();
    let (_, last) = scene.motion.duration_s();
    for mode in MovingBounds::ALL {
        let mut world = World::with_bounds(&gpu, &scene, culling::Shading::of(&scene), mode).unwrap();
        // Three times to a frame: what changes at one that no frame sees must still be brought.
        for step in 0..12 {
            for part in 0..3 {
                world.set_time(&scene, last * 1.2 * f64::from((5 * step + part) % 12) / 11.0 - 0.05 * last).unwrap();
            }
            let mut f = gpu.frame();
            world.update(&mut f);
            f.finish().unwrap();
            let on_device = world.read_bounds().unwrap();
            let wrong = world.moving_bounds().filter(|(object, bounds)| on_device[*object as usize] != *bounds);
            assert_eq!(wrong.count(), 0, "{mode:?}, step {step}");
        }
    }
}

/// What each way brings to the device, and what a tree is fitted to, frame by frame.
#[test]
fn a_union_is_never_touched_and_the_rest_is_as_little_as_changes() {
    let gpu = gpu();
    let scene = scene("moving-boxes", 0.5);
    let moving = scene.motion.dynamic_objects().len() as u64;
    let mut brought = Vec::new();
    for mode in MovingBounds::ALL {
        let mut world = World::with_bounds(&gpu, &scene, culling::Shading::of(&scene), mode).unwrap();
        let mut tree = Tree::new(&gpu, &world, scenes::bvh::Split::Sah).unwrap();
        let mut sum = (0, 0);
        for frame in 1..=4 {
            world.set_time(&scene, 0.1 * f64::from(frame)).unwrap();
            let mut f = gpu.frame();
            world.update(&mut f);
            f.finish().unwrap();
            tree.follow(&world).unwrap();
            sum = (sum.0 + world.bounds_brought(), sum.1 + tree.refitted());
        }
        tree.follow(&world).unwrap();
        assert_eq!(tree.refitted(), 0, "{mode:?}: nothing has changed since");
        brought.push((mode, sum));
    }
    let of = |wanted| brought.iter().find(|(mode, _)| *mode == wanted).map(|(_, sum)| *sum).unwrap();
    assert_eq!(of(MovingBounds::PerFrame).0, 4 * moving);
    assert!(of(MovingBounds::PerFrame).1 > 0);
    // An orbit is one animation without an end.
    assert_eq!(of(MovingBounds::Union), (0, 0));
    assert_eq!(of(MovingBounds::PerAnimation), (0, 0));
    // A third of them turns about its own middle, which stays where it is but for what rounding makes of it.
    let in_place = of(MovingBounds::InPlace).0;
    assert!(0 < in_place && in_place <= 4 * moving, "{in_place} of {}", 4 * moving);
}
