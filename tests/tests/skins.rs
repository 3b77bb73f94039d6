//! Meshes that skeletons bend: the device bends them as its twin does, exact methods lose nothing of them whichever way their bounds are had, and
//! what stays as it was is not bent again.

use culling::world::twin;
use culling::{Shading, World};
use glam::Vec3;
use harness::sessions::faults;
use harness::{assert_caught, assert_none, gpu};
use scenes::animation::{AnimatedNode, Local, NodeAnimation};
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

fn simple_skin() -> Scene {
    import(Path::new("/usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf")).expect("install assimp-testmodels")
}

fn session(gpu: &engine::Gpu, scene: Scene, path: &str, bounds: MovingBounds) -> Session {
    let path = Some(path.to_owned());
    let options =
        SessionOptions { path, whole_path: true, frames: 5, size: [160, 90], bounds, ..SessionOptions::default() };
    Session::with_scene(gpu, scene, options).unwrap()
}

#[test]
fn what_skeletons_bend_is_never_lost() {
    let gpu = gpu();
    let mut lost = Vec::new();
    for mode in MovingBounds::ALL {
        for path in ["walk", "rotate"] {
            let mut session = session(&gpu, tentacles(0.3), path, mode);
            for (method, set) in METHODS {
                lost.extend(faults(&mut session, method, set));
            }
        }
    }
    assert_none(&lost);
}

/// All objects bent, so that there is nothing whose mesh lies before them; and a file.
#[test]
fn a_file_of_nothing_else_is_never_lost() {
    let gpu = gpu();
    for mode in MovingBounds::ALL {
        let mut session = session(&gpu, simple_skin(), "closing-in", mode);
        for (method, set) in METHODS {
            assert_none(&faults(&mut session, method, set));
        }
    }
}

/// The scene with its skeletons as they are at time 0, for ever.
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
    scene.motion = Motion::Nodes(frozen);
    scene
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
    let mut planted = Session::with_scene(&gpu, tentacles(1.0), options).unwrap();
    let frozen = frozen(tentacles(1.0));
    // The scene that the world was made of rests, and so its bounds are those of time 0; what is drawn of it bends.
    planted.world = World::with_bounds(&gpu, &frozen, Shading::of(&frozen), MovingBounds::Union).unwrap();
    for method in ["hzb", "roc", "chc"] {
        assert_caught(&faults(&mut planted, method, &[]), "false negatives");
    }
}

/// However bounds are had, and whether textures are drawn or not, the truth is the same; and it changes from frame to frame.
#[test]
fn every_way_shows_the_same_pictures() {
    let gpu = gpu();
    let pictures = |mode| {
        let mut session = session(&gpu, tentacles(0.3), "still", mode);
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

/// Vertices of bent objects as the device has them are those of the twin; all others are as they were.
fn assert_bent(world: &World, rest: &[ObjectsVertex], place: &str) {
    let (found, bent) = (world.read_vertices().unwrap(), world.bent_vertices().unwrap().unwrap());
    assert!(found[..bent.first] == rest[..bent.first], "{place}: what nothing bends has changed");
    let expected = twin::skin_vertices(&bent.rest, &bent.places);
    assert_eq!(found.len() - bent.first, expected.len());
    for (found, expected) in found[bent.first..].iter().zip(&expected) {
        assert_eq!(found.position.map(f32::to_bits), expected.position.map(f32::to_bits), "{place}");
    }
}

/// Vertices that skeletons bend, in the order of their meshes.
fn host_shapes(scene: &Scene, seconds: f64) -> Vec<Vec3> {
    let mut bent: Vec<_> = scene.skinned.iter().map(|it| scene.objects[it.object as usize].mesh as usize).collect();
    bent.sort_unstable();
    let meshes = scene.meshes_at(seconds);
    bent.iter().flat_map(|mesh| meshes[*mesh].positions.iter().copied()).collect()
}

fn device_shapes(world: &World) -> Vec<Vec3> {
    let first = world.bent_vertices().unwrap().unwrap().first;
    world.read_vertices().unwrap()[first..].iter().map(|vertex| vertex.position.into()).collect()
}

#[test]
fn the_device_has_the_shapes_of_the_host() {
    let gpu = gpu();
    for scene in [tentacles(0.2), simple_skin()] {
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
    let mesh = scene.objects[scene.skinned[0].object as usize].mesh as usize;
    scene.meshes[mesh].colours = vec![[255, 200, 100, 255]; scene.meshes[mesh].positions.len()];
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
    assert_eq!(skipped(&still.unwrap(), &gpu), ["no skins"]);
    let scene = simple_skin();
    let mut world = World::new(&gpu, &scene).unwrap();
    let mut at = |seconds: f64| {
        world.set_time(&scene, seconds).unwrap();
        skipped(&world, &gpu)
    };
    let (ran, still) = ([""; 0], ["no joint has moved"]);
    assert_eq!(at(0.0), ran, "the first frame");
    assert_eq!(at(1.0), ran);
    assert_eq!(at(1.0), ran, "another method's frame of the same time costs the same");
    // The last key is at 5.5 s.
    assert_eq!(at(6.0), ran);
    assert_eq!(at(7.0), still);
    assert_eq!(at(8.0), still);
    assert_eq!(at(2.0), ran);
}
