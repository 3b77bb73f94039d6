//! What `sightline view` shows, without a window: the laws of its pictures. Windows are tested in `tools/tests/view.rs`.

use culling::{Guarantee, METHODS};
use engine::Gpu;
use harness::device;
use harness::replaced::{built_in, red};
use scenes::{CameraPath, Scene, SceneOptions, Shot};
use shaders::reload::NewShader;
use shaders::ShaderKind;
use sightline::run::session::SessionOptions;
use sightline::view::camera::FlyCamera;
use sightline::view::controls::{Controls, Show};
use sightline::view::lab::Lab;

const FRAMES: usize = 6;

fn open(gpu: &Gpu, scene: &str, scale: f64) -> (Lab, Controls, CameraPath) {
    let options = SceneOptions { scale, ..SceneOptions::default() };
    let scene: Scene = scenes::open(scene, &options).unwrap();
    let path = CameraPath::named(&scene, Some("rotate"), 8.0).unwrap();
    let camera = FlyCamera::new(&scene, &path.sample(0, FRAMES).pose);
    let methods: Vec<_> = METHODS.iter().map(|entry| (entry, entry.default_options())).collect();
    let controls = Controls::new(camera, methods.len());
    let options = SessionOptions { size: [320, 180], ..SessionOptions::default() };
    (Lab::new(gpu, scene, options, methods).unwrap(), controls, path)
}

fn shown(lab: &mut Lab, controls: &Controls, shot: &Shot) -> Vec<u8> {
    lab.frame(controls, shot).unwrap_or_else(|error| panic!("{}: {error:#}", lab.label()));
    lab.picture().read().unwrap()
}

#[test]
fn every_exact_method_shows_what_is_shown_without_culling() {
    let gpu = device::gpu();
    for (scene, scale) in [("city-block", 0.02), ("moving-boxes", 1.0)] {
        let (mut lab, mut controls, path) = open(&gpu, scene, scale);
        for (place, entry) in METHODS.iter().enumerate() {
            controls.method = place;
            for frame in 0..FRAMES {
                let shot = path.sample(frame, FRAMES);
                controls.culling = true;
                let culled = shown(&mut lab, &controls, &shot);
                assert_eq!(lab.label(), entry.id);
                // Nothing is culled every other frame only, so that the method has a past.
                if frame % 2 == 1 && entry.guarantee == Guarantee::Exact {
                    controls.culling = false;
                    let all = shown(&mut lab, &controls, &shot);
                    assert_eq!(lab.label(), "none");
                    assert!(culled == all, "{scene}: {} shows something else in frame {frame}", entry.id);
                }
            }
        }
    }
}

#[test]
fn frozen_lists_show_the_same_objects_to_the_same_eye_and_stay_as_they_are() {
    let gpu = device::gpu();
    for entry in METHODS.iter().filter(|entry| entry.guarantee == Guarantee::Exact) {
        let (mut lab, mut controls, path) = open(&gpu, "city-block", 0.02);
        controls.method = METHODS.iter().position(|other| other.id == entry.id).unwrap();
        controls.show = Show::Items;
        let [shot, elsewhere] = [1, 4].map(|frame| path.sample(frame, FRAMES));
        shown(&mut lab, &controls, &path.sample(0, FRAMES));
        let live = shown(&mut lab, &controls, &shot);
        controls.frozen = true;
        let frozen = shown(&mut lab, &controls, &shot);
        let away = shown(&mut lab, &controls, &elsewhere);
        assert!(shown(&mut lab, &controls, &shot) == frozen, "{}: a frozen list changed", entry.id);
        // White lines of the frozen view volume lie over a few pixels.
        let differing = live.chunks(4).zip(frozen.chunks(4)).filter(|(live, frozen)| live != frozen).count();
        assert!(differing < live.len() / 4 / 20, "{}: {differing} pixels differ", entry.id);
        controls.frozen = false;
        let thawed = shown(&mut lab, &controls, &elsewhere);
        if entry.id == "none" {
            assert!(away.chunks(4).zip(thawed.chunks(4)).filter(|(a, b)| a != b).count() < 5000, "none culls nothing");
        } else {
            assert!(away != thawed, "{}: from elsewhere, what was culled is not there", entry.id);
        }
    }
}

#[test]
fn every_view_says_what_its_colours_mean() {
    let gpu = device::gpu();
    let (mut lab, mut controls, path) = open(&gpu, "city-block", 0.02);
    controls.method = METHODS.iter().position(|entry| entry.id == "eovc").unwrap();
    let legends = [
        (Show::Colour, ""),
        (Show::Depth, "near is bright"),
        (Show::Farthest, "near is bright"),
        (Show::Items, "one colour an object"),
        (Show::Overdraw, "blue 1, green 4"),
        (Show::Motion, "direction as hue"),
        (Show::WarpError, "red: nearer than real"),
        (Show::Groups, "groups (orange)"),
        (Show::Boxes, "single objects (blue)"),
        (Show::FalsePositives, "drawn in vain (red)"),
    ];
    assert_eq!(legends.map(|(show, _)| show), Show::ALL);
    for (show, legend) in legends {
        controls.show = show;
        // A warp starts from the frame before.
        (0..3).for_each(|frame| drop(shown(&mut lab, &controls, &path.sample(frame, FRAMES))));
        let said = lab.caption();
        assert!(said.contains(legend) && said.is_empty() == legend.is_empty(), "{}: {said}", show.name());
    }
}

/// What draws the colour of a scene without textures.
const DRAWING: [&str; 4] =
    ["draw/objects", "draw/objects_and_items", "draw/objects_and_flags", "draw/objects_items_and_flags"];

/// What R does once shaders are compiled, under methods that leave out what a still view needs no more.
#[test]
fn new_shaders_show_before_a_still_camera_and_the_old_ones_again() {
    let gpu = device::gpu();
    let (mut lab, mut controls, path) = open(&gpu, "city-block", 0.02);
    let shot = path.sample(1, FRAMES);
    for entry in METHODS {
        controls.method = METHODS.iter().position(|other| other.id == entry.id).unwrap();
        let mut pictures = Vec::new();
        let all = |shader: &dyn Fn(&str) -> NewShader| DRAWING.map(shader).to_vec();
        for shaders in [Vec::new(), all(&red), all(&|stage| built_in(stage, ShaderKind::Fragment))] {
            lab.replace_shaders(&shaders).unwrap();
            (0..3).for_each(|_| drop(shown(&mut lab, &controls, &shot)));
            pictures.push(shown(&mut lab, &controls, &shot));
        }
        let is_red = |pixel: &&[u8]| pixel[..3] == [255, 0, 0];
        let red_pixels = |picture: &[u8]| picture.chunks(4).filter(is_red).count();
        assert_eq!(red_pixels(&pictures[0]), 0, "{}", entry.id);
        assert!(red_pixels(&pictures[1]) > 10_000, "{}: {} pixels are red", entry.id, red_pixels(&pictures[1]));
        assert!(pictures[2] == pictures[0], "{}: the old shader shows something else", entry.id);
    }
}
