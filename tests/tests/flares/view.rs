//! Flares in the window of `sightline view`, without the window.

use culling::flares::{Light, Settings, When};
use glam::DVec3;
use harness::gpu;
use scenes::{CameraPath, Scene, SceneOptions};
use sightline::run::methods::parse_methods;
use sightline::run::session::SessionOptions;
use sightline::view::camera::FlyCamera;
use sightline::view::controls::Controls;
use sightline::view::lab::Lab;

/// The window shows the flare; while it compares with the truth, it shows what is compared: the picture below.
#[test]
fn a_window_shows_the_flare_unless_it_compares_pictures() {
    let gpu = gpu();
    let scene: Scene = scenes::open("city-block", &SceneOptions { scale: 0.02, ..SceneOptions::default() }).unwrap();
    let shot = CameraPath::named(&scene, Some("walk"), 1.0).unwrap().sample(0, 6);
    let flares = Settings { when: When::Same, light: Light::Towards(shot.pose.rotation * DVec3::new(0.0, 0.2, -1.0)) };
    let shown = |flares: Option<Settings>, truth: bool| {
        let options = SessionOptions { size: [320, 180], flares, ..SessionOptions::default() };
        let methods = parse_methods("frustum", &[]).unwrap();
        let mut lab = Lab::new(&gpu, scene.clone(), options, methods).unwrap();
        let mut controls = Controls::new(FlyCamera::new(&scene, &shot.pose), 1);
        controls.truth = truth;
        (0..2).for_each(|_| lab.frame(&controls, &shot).unwrap());
        // The last byte of a pixel is its alpha, which is not shown.
        let mut pixels = lab.picture().read().unwrap();
        pixels.chunks_exact_mut(4).for_each(|pixel| pixel[3] = 255);
        pixels
    };
    let plain = shown(None, false);
    assert!(shown(Some(flares), false) != plain, "there is no flare");
    assert!(shown(Some(flares), true) == plain, "the flare is in the way of the comparison");
}
