//! Recorded frames as text, without a device: stages, resources and barriers, as `tests/golden/` has them.

use culling::{Setup, View, VisibleSets, World};
use engine::{Format, Frame, Gpu, Image, Target};
use harness::hazards::hazards;
use harness::{assert_caught, assert_none, golden, worlds};
use std::sync::Arc;

const SIZE: [u32; 2] = [640, 360];

/// Methods that read back when they are made or in the middle of a frame.
const NEED_A_DEVICE: [&str; 9] =
    ["ref", "eovc", "auto", "frustum-bvh", "query-wait", "query-lag", "chc", "chc++", "nohc"];

/// Records a method's frames over a case; the third frame and those after it see what the second saw.
fn recorded(id: &str, case: &worlds::Case, frames: usize, mut look: impl FnMut(usize, &Frame)) {
    let gpu = Gpu::without_device();
    let mut world = World::new(&gpu, &case.scene).unwrap();
    let image = |name: &str, format| Image::new(&gpu, name, format, SIZE).unwrap();
    let (colour, depth) = (image("target.colour", Format::Colour), image("target.depth", Format::Depth));
    let target = Target {
        size: SIZE,
        colour: Some((colour.view(), Format::Colour)),
        item: None,
        depth: depth.view(),
        depth_read_only: false,
        strictly_nearer: false,
        samples: None,
    };
    let items = image("target.item", Format::Item);
    let entry = culling::find(id).unwrap();
    let mut sets = VisibleSets::new(world.len());
    (0..frames).for_each(|_| sets.push_items(&[0]));
    let options = entry.default_options();
    let setup = Setup { gpu: &gpu, world: &world, options: &options, visible: Some(Arc::new(sets)) };
    let made = (entry.make)(&setup);
    // `ref` and `eovc` take a device to be made, and so does `auto`, which holds an `eovc`: what they read back is theirs alone to be tested
    // with one.
    assert!(made.is_ok() || NEED_A_DEVICE.contains(&id), "{id} cannot be recorded without a device");
    let Ok(mut method) = made else { return };
    for frame in 0..frames {
        let shot = case.shots[[0, 2][frame.min(1)]];
        let seconds = frame.min(1) as f64;
        world.set_time(&case.scene, seconds).unwrap();
        let view = View::new(&shot, SIZE, frame, 1.0 / 256.0);
        let mut f = gpu.frame();
        let item = method.needs_items(&world, &view).then(|| items.view());
        match method.frame(&mut f, &world, &view, &Target { item, ..target }) {
            Ok(()) => look(frame, &f),
            // What is recorded up to the first answer that it waits for.
            Err(culling::Error::Engine(engine::Error::RecordingOnly)) if NEED_A_DEVICE.contains(&id) => {
                return look(frame, &f);
            }
            Err(error) => panic!("{id}: {error}"),
        }
    }
}

fn frames_keep_their_text(id: &str) {
    let mut text = String::new();
    recorded(id, &worlds::special::topologies(), 6, |frame, f| {
        let title =
            ["first frame", "second frame, the camera has moved", "", "", "", "a frame after the camera has stopped"]
                [frame];
        if !title.is_empty() {
            text += &format!("== {title}\n{}\n", f.text());
        }
    });
    assert!(!text.is_empty(), "{id} recorded nothing");
    golden::compare(id, &text);
}

#[test]
fn none_keeps_its_frames() {
    frames_keep_their_text("none");
}

#[test]
fn frustum_keeps_its_frames() {
    frames_keep_their_text("frustum");
}

#[test]
fn hzb_keeps_its_frames() {
    frames_keep_their_text("hzb");
}

fn moving() -> worlds::Case {
    let scene =
        scenes::open("moving-boxes", &scenes::SceneOptions { scale: 0.1, seed: 1, ..Default::default() }).unwrap();
    worlds::Case { scene, ..worlds::walled(2) }
}

#[test]
fn every_conflict_has_a_barrier_in_between() {
    for case in [worlds::walled(70), worlds::special::topologies(), moving()] {
        for entry in culling::METHODS {
            recorded(entry.id, &case, 6, |frame, f| {
                let faults = hazards(f.recorded());
                assert!(faults.is_empty(), "{}, frame {frame}: {faults:#?}\n{}", entry.id, f.text());
            });
        }
    }
}

#[test]
fn every_barrier_is_needed_and_its_loss_is_noticed() {
    for case in [worlds::special::topologies(), moving()] {
        recorded("hzb", &case, 2, |_, f| {
            let barriers = (0..f.recorded().len()).filter(|step| f.recorded()[*step].barrier.is_some());
            let mut seen = 0;
            for step in barriers {
                let mut without = f.recorded().to_vec();
                without[step].barrier = None;
                assert_caught(&hazards(&without), "conflict");
                seen += 1;
            }
            assert!(seen > 5, "only {seen} barriers");
        });
    }
}

#[test]
fn a_barrier_that_waits_for_too_little_is_noticed() {
    recorded("hzb", &moving(), 2, |_, f| {
        assert_none(&hazards(f.recorded()));
        let mut weak = f.recorded().to_vec();
        weak.iter_mut().filter_map(|step| step.barrier.as_mut()).for_each(|barrier| barrier.written = 0);
        assert_caught(&hazards(&weak), "conflict");
    });
}

#[test]
fn without_a_device_frames_are_not_run() {
    let gpu = Gpu::without_device();
    let buffer = engine::Buffer::<u32>::new(&gpu, "words", 4, engine::Placement::Storage).unwrap();
    let mut f = gpu.frame();
    f.fill("test/fill", &buffer, 1);
    assert!(matches!(f.finish(), Err(engine::Error::RecordingOnly)));
}
