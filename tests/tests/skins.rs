//! Deformed meshes: the device deforms them like its twin, exact methods lose nothing in any of the four ways of `--bounds`, and shapes
//! that stay the same are not written again.

use culling::{Shading, World};
use glam::Vec3;
use harness::sessions::faults;
use harness::{assert_caught, assert_none, gpu, laws, worlds, Case, Subject};
use scenes::animation::{AnimatedNode, Interpolation, Local, NodeAnimation, Track};
use scenes::{import, Motion, MovingBounds, Scene, SceneOptions};
use shaders::draw::ObjectsVertex;
use sightline::run::session::{Session, SessionOptions};
use sightline::run::truth::RunTruth;
use std::path::Path;

/// Exact methods that test bounds of objects in different ways: planes, two trees, pyramids, rasterised boxes, warped depth, queries.
const METHODS: [(&str, &[(&str, &str)]); 11] = [
    ("frustum", &[("test", "obb")]),
    ("frustum-bvh", &[]),
    ("hzb", &[]),
    ("hzb-iterative", &[]),
    ("hom", &[]),
    ("roc", &[]),
    ("roc-iterative", &[]),
    ("eovc", &[]),
    ("woc-exact", &[]),
    ("query-wait", &[("boxes", "8")]),
    ("chc++", &[]),
];

fn tentacles(scale: f64) -> Scene {
    scenes::open("tentacles", &SceneOptions { scale, seed: 1, ..SceneOptions::default() }).unwrap()
}

fn jellyfish(scale: f64) -> Scene {
    scenes::open("jellyfish", &SceneOptions { scale, seed: 1, ..SceneOptions::default() }).unwrap()
}

/// Two animated targets on a node that stays where it is.
fn morph_cube() -> Scene {
    let file = "/usr/share/assimp/models/glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf";
    import(Path::new(file)).expect("install assimp-testmodels")
}

fn simple_skin() -> Scene {
    import(Path::new("/usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf")).expect("install assimp-testmodels")
}

fn session(gpu: &engine::Gpu, scene: Scene, path: &str, bounds: MovingBounds) -> Session {
    let path = Some(path.into());
    let options =
        SessionOptions { path, whole_path: true, frames: 5, size: [160, 90], bounds, ..SessionOptions::default() };
    Session::with_scene(gpu, scene, options).unwrap()
}

fn lost_of(scene: &Scene) -> Vec<String> {
    let gpu = gpu();
    let mut lost = Vec::new();
    for mode in MovingBounds::ALL {
        for path in ["walk", "rotate"] {
            let mut session = session(&gpu, scene.clone(), path, mode);
            for (method, set) in METHODS {
                lost.extend(faults(&mut session, method, set));
            }
        }
    }
    lost
}

#[test]
fn what_skeletons_bend_is_never_lost() {
    assert_none(&lost_of(&tentacles(0.3)));
}

#[test]
fn what_morph_targets_displace_is_never_lost() {
    assert_none(&lost_of(&jellyfish(0.3)));
}

/// Bells that change their shapes while the camera goes about, and while it stands still.
fn deforming_case() -> Case {
    let scene = jellyfish(0.15);
    let camera = &scene.cameras[0];
    let mut shots = worlds::wander(camera.pose.position, glam::DVec3::Y, camera.projection);
    shots.iter_mut().enumerate().for_each(|(frame, shot)| shot.seconds = 0.7 * (frame / 2) as f64);
    Case::new("jellyfish", scene, shots)
}

#[test]
fn the_laws_hold_of_deformed_meshes() {
    let gpu = gpu();
    let case = deforming_case();
    let mut faults = Vec::new();
    for subject in ["frustum", "hzb", "roc", "eovc"].map(Subject::named) {
        faults.extend(laws::skipping_changes_no_pixel(&gpu, &subject, &case));
        faults.extend(laws::two_runs_give_the_same_bytes(&gpu, &subject, &case));
        faults.extend(laws::a_resize_hides_nothing(&gpu, &subject, &case));
        faults.extend(laws::a_camera_cut_hides_nothing(&gpu, &subject, &case));
        faults.extend(laws::decisions_do_not_depend_on_the_pass(&gpu, &subject, &case));
    }
    assert_none(&faults);
}

/// All objects bent, so that there is nothing whose mesh lies before them; and a file.
#[test]
fn a_file_of_nothing_else_is_never_lost() {
    let gpu = gpu();
    for scene in [simple_skin(), morph_cube()] {
        for mode in MovingBounds::ALL {
            let mut session = session(&gpu, scene.clone(), "closing-in", mode);
            for (method, set) in METHODS {
                assert_none(&faults(&mut session, method, set));
            }
        }
    }
}

/// The scene with its skeletons and weights as they are at time 0, for ever.
fn frozen(mut scene: Scene) -> Scene {
    let Motion::Nodes(nodes) = &scene.motion else { panic!("skeletons are of nodes") };
    let still = |node: &AnimatedNode| {
        let Local::Parts { translation, rotation, scale } = node.local else { panic!("bones have parts") };
        let local = Local::Parts {
            translation: node.translation.as_ref().map_or(translation, |track| track.at(0.0)),
            rotation: node.rotation.as_ref().map_or(rotation, |track| track.at(0.0)),
            scale: node.scale.as_ref().map_or(scale, |track| track.at(0.0)),
        };
        AnimatedNode { local, translation: None, rotation: None, scale: None, ..node.clone() }
    };
    let frozen = NodeAnimation::new(nodes.nodes().iter().map(still).collect(), nodes.objects().to_vec()).unwrap();
    let weights = nodes.weights().iter().map(|track| constant(track.at(0.0)));
    scene.motion = Motion::Nodes(frozen.with_weights(weights.collect()));
    scene
}

fn constant(weight: f64) -> Track<f64> {
    Track::new(Interpolation::Step, vec![0.0], vec![weight]).unwrap()
}

/// Bounds of the pose of time 0, taken for those of all times: what bends out of them is lost.
#[test]
fn bounds_of_the_first_pose_are_caught() {
    let gpu = gpu();
    let options = SessionOptions {
        path: Some("still".into()),
        whole_path: true,
        frames: 9,
        size: [320, 180],
        ..SessionOptions::default()
    };
    for scene in [tentacles(1.0), jellyfish(1.0)] {
        let frozen = frozen(scene.clone());
        let mut planted = Session::with_scene(&gpu, scene, options.clone()).unwrap();
        // The world was made of a scene at rest, so its bounds are those of time 0; its drawn meshes bend.
        planted.world = World::with_bounds(&gpu, &frozen, Shading::of(&frozen), MovingBounds::Union).unwrap();
        for method in ["hzb", "roc", "chc"] {
            assert_caught(&faults(&mut planted, method, &[]), "false negatives");
        }
    }
}

/// However bounds are had, and whether textures are drawn or not, the truth is the same; and it changes from frame to frame.
#[test]
fn every_way_shows_the_same_pictures() {
    let gpu = gpu();
    for scene in [tentacles(0.3), jellyfish(0.3)] {
        same_pictures(&gpu, &scene);
    }
}

fn same_pictures(gpu: &engine::Gpu, scene: &Scene) {
    let pictures = |mode| {
        let mut session = session(gpu, scene.clone(), "still", mode);
        let truth = RunTruth::draw(&mut session, || ()).unwrap();
        let frames = 0..session.frames();
        frames.map(|frame| truth.frame(&mut session, frame).unwrap().images().clone()).collect::<Vec<_>>()
    };
    let expected = pictures(MovingBounds::PerFrame);
    assert!(expected.windows(2).all(|pair| pair[0] != pair[1]), "nothing bends, so this proves nothing");
    for mode in MovingBounds::ALL {
        assert!(pictures(mode) == expected, "{mode:?}");
    }
}

/// Asserts that the device's vertices of deformed meshes are those of the twin, and that all others are unchanged.
fn assert_bent(world: &World, rest: &[ObjectsVertex], place: &str) {
    let (found, (by, first)) = (world.read_vertices().unwrap(), world.deformers().unwrap().unwrap());
    assert!(found[..first] == rest[..first], "{place}: what nothing deforms has changed");
    let expected = by.skin_vertices();
    assert_eq!(found.len() - first, expected.len());
    for (found, expected) in found[first..].iter().zip(&expected) {
        assert_eq!(found.position.map(f32::to_bits), expected.position.map(f32::to_bits), "{place}");
    }
}

/// Vertices of deformed meshes, in the order of these.
fn host_shapes(scene: &Scene, seconds: f64) -> Vec<Vec3> {
    let meshes = scene.meshes_at(seconds);
    scene.deformed.iter().flat_map(|it| meshes[it.mesh as usize].positions.iter().copied()).collect()
}

fn device_shapes(world: &World) -> Vec<Vec3> {
    let (_, first) = world.deformers().unwrap().unwrap();
    world.read_vertices().unwrap()[first..].iter().map(|vertex| vertex.position.into()).collect()
}

#[test]
fn the_device_has_the_shapes_of_the_host() {
    let gpu = gpu();
    for scene in [tentacles(0.2), simple_skin(), jellyfish(0.2), morph_cube()] {
        let mut world = World::new(&gpu, &scene).unwrap();
        let rest = world.read_vertices().unwrap();
        for seconds in [0.0, 1.37, 5.9, 1.37] {
            // Two times to a frame: what moves at one that no frame sees must still be brought.
            world.set_time(&scene, seconds + 0.2).unwrap();
            world.set_time(&scene, seconds).unwrap();
            let mut f = gpu.frame();
            world.update(&mut f);
            f.finish().unwrap();
            assert_bent(&world, &rest, &format!("{}, {seconds}", scene.name));
            assert!(world.read_meshes().unwrap().2 == rest, "the shapes of time 0 have changed");
            let (host, device) = (host_shapes(&scene, seconds), device_shapes(&world));
            assert_eq!(host.len(), device.len());
            let off = host.iter().zip(&device).map(|(host, device)| host.distance(*device)).fold(0.0, f32::max);
            assert!(off < 1e-4, "{}, {seconds}: {off} m from Scene::meshes_at", scene.name);
        }
    }
}

/// A world that is shaded with textures has its vertices twice, and bends them twice.
#[test]
fn textured_vertices_bend_too() {
    let gpu = gpu();
    let mut scene = tentacles(0.1);
    let mesh = scene.deformed[0].mesh as usize;
    scene.meshes[mesh].colours = vec![[1.0, 0.8, 0.4, 1.0]; scene.meshes[mesh].positions.len()];
    assert_eq!(Shading::of(&scene), Shading::Textured);
    let options = || SessionOptions {
        path: Some("still".into()),
        whole_path: true,
        frames: 4,
        size: [160, 90],
        ..SessionOptions::default()
    };
    let mut textured = Session::with_scene(&gpu, scene, options()).unwrap();
    let mut plain = Session::with_scene(&gpu, tentacles(0.1), options()).unwrap();
    assert_none(&faults(&mut textured, "hzb", &[]));
    let items = |session: &mut Session| {
        let truth = RunTruth::draw(session, || ()).unwrap();
        (0..4).map(|frame| truth.frame(session, frame).unwrap().images().items.clone()).collect::<Vec<_>>()
    };
    assert!(items(&mut textured) == items(&mut plain), "textured objects have other shapes");
}

/// Why a frame does not bend anything; empty if it does.
fn skipped(world: &World, gpu: &engine::Gpu) -> Vec<&'static str> {
    let mut f = gpu.frame();
    world.update(&mut f);
    let report = f.finish().unwrap();
    report.skips.iter().filter(|skip| skip.label == "world/skin_vertices").map(|skip| skip.reason).collect()
}

#[test]
fn what_does_not_bend_is_not_bent() {
    let gpu = gpu();
    let still = World::new(
        &gpu,
        &scenes::open("moving-boxes", &SceneOptions { scale: 0.1, ..SceneOptions::default() }).unwrap(),
    );
    assert_eq!(skipped(&still.unwrap(), &gpu), ["no deformed meshes"]);
    let scene = simple_skin();
    let mut world = World::new(&gpu, &scene).unwrap();
    let mut at = |seconds: f64| {
        world.set_time(&scene, seconds).unwrap();
        skipped(&world, &gpu)
    };
    let (ran, still) = ([""; 0], ["no joint and no weight has moved"]);
    assert_eq!(at(0.0), ran, "the first frame");
    assert_eq!(at(1.0), ran);
    assert_eq!(at(1.0), ran, "another method's frame of the same time costs the same");
    // The last key is at 5.5 s.
    assert_eq!(at(6.0), ran);
    assert_eq!(at(7.0), still);
    assert_eq!(at(8.0), still);
    assert_eq!(at(2.0), ran);
}

/// Weights alone, on a node that does not move: steps of one second, then nothing.
#[test]
fn weights_that_stay_are_not_brought_again() {
    let gpu = gpu();
    let scene = morph_cube();
    let (first, last) = scene.motion.duration_s();
    let mut world = World::new(&gpu, &scene).unwrap();
    let mut at = |seconds: f64| {
        world.set_time(&scene, seconds).unwrap();
        skipped(&world, &gpu)
    };
    let (ran, still) = ([""; 0], ["no joint and no weight has moved"]);
    assert_eq!(at(first), ran, "the first frame");
    assert_eq!(at(0.5 * (first + last)), ran);
    assert_eq!(at(last), ran);
    assert_eq!(at(last + 1.0), still);
    assert_eq!(at(last + 2.0), still);
}
