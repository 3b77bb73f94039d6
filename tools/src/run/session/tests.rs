//! Visible sets in the cache are told apart by everything that decides them.

use super::*;
use std::collections::BTreeSet;

const DEVICE: [&str; 2] = ["a device", "D32_SFLOAT"];

fn scene(options: &SessionOptions) -> Scene {
    let SessionOptions { scale, seed, detail, .. } = *options;
    let mut scene = scenes::open(&options.scene, &SceneOptions { scale, seed, detail }).unwrap();
    // A camera of a certain aspect would bring the size into the key by the way of the path.
    scene.cameras[0].aspect = None;
    scene
}

fn key(options: &SessionOptions, device: [&str; 2]) -> String {
    let scene = scene(options);
    picture_key(&scene, &path_of(&scene, options).unwrap(), options, device)
}

fn base() -> SessionOptions {
    SessionOptions { scene: "rooms".into(), scale: 0.05, size: [96, 64], ..SessionOptions::default() }
}

#[test]
fn each_setting_that_decides_pictures_is_in_the_key() {
    type Change = fn(&mut SessionOptions);
    let changes: [(&str, Change); 13] = [
        ("nothing", |_| ()),
        ("another scene", |o| o.scene = "city-block".into()),
        ("scale", |o| o.scale = 0.1),
        ("seed", |o| o.seed = 2),
        ("path", |o| o.path = Some("still".into())),
        ("speed", |o| o.speed = 2.0),
        ("whole path", |o| o.whole_path = true),
        ("frames", |o| o.frames = 31),
        ("width", |o| o.size = [97, 64]),
        ("height", |o| o.size = [96, 65]),
        ("width for height", |o| o.size = [64, 96]),
        ("shading", |o| o.shading = Some(Shading::Textured)),
        ("samples", |o| o.samples = 4),
    ];
    let mut keys = BTreeSet::new();
    for (name, change) in changes {
        let mut options = base();
        change(&mut options);
        assert!(keys.insert(key(&options, DEVICE)), "{name} is not in the key");
    }
    for (name, device) in [("device", ["another", DEVICE[1]]), ("depth format", [DEVICE[0], "D16_UNORM"])] {
        assert!(keys.insert(key(&base(), device)), "{name} is not in the key");
    }
}

#[test]
fn the_fit_of_a_camera_is_in_the_key() {
    let mut scene = scene(&base());
    scene.cameras[0].aspect = Some(4.0);
    let key = |fit| {
        let options = SessionOptions { fit, ..base() };
        picture_key(&scene, &path_of(&scene, &options).unwrap(), &options, DEVICE)
    };
    assert_ne!(key(Fit::Inside), key(Fit::Height));
}

#[test]
fn settings_that_leave_pictures_alone_are_not_in_the_key() {
    let same = key(&base(), DEVICE);
    assert_eq!(key(&base(), DEVICE), same);
    let of_scene = SessionOptions { shading: Some(Shading::of(&scene(&base()))), ..base() };
    let named = SessionOptions { path: Some(CameraPath::names(&scene(&base()))[0].into()), ..base() };
    let bounds = SessionOptions { bounds: MovingBounds::Union, ..base() };
    for options in [of_scene, named, bounds] {
        assert_eq!(key(&options, DEVICE), same, "{options:?}");
    }
}

#[test]
fn shaders_that_decide_pictures_are_in_the_key() {
    let deciding = ["draw/objects", "world/move_objects", "translucent/write_commands", "engine/spread_samples"];
    assert!(deciding.into_iter().all(decides_pictures));
    assert!(!["hzb/reduce_depth", "pack/scan", "warp/search", "drawn/objects"].into_iter().any(decides_pictures));
    let folders: BTreeSet<&str> = shaders::STAGES.iter().filter_map(|stage| stage.name.split('/').next()).collect();
    assert!(["draw", "world", "translucent", "engine"].iter().all(|folder| folders.contains(folder)), "{folders:?}");
}
