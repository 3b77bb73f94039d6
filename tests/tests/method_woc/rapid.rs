//! Rapid objects: their stages against their twins, and what drawing them first promises.

use culling::woc::twin::{find_rapid, is_rapid, leave_rapid, Ways};
use culling::View;
use engine::{Buffer, Gpu, Placement};
use glam::{DQuat, DVec3};
use harness::occludees::Occludees;
use harness::worlds::{self, PERSPECTIVE};
use harness::{assert_none, gpu, laws, Random, Subject};
use scenes::{Pose, Shot};
use shaders::types::{Bounds, CullView, DrawCommand, RAPID_INVOCATIONS};
use shaders::woc;

const SIZE: [u32; 2] = [161, 97];

/// More boxes than invocations, so that these stride.
const BOXES: usize = 3 * RAPID_INVOCATIONS as usize + 5;

struct Input {
    before: Vec<Bounds>,
    now: Vec<Bounds>,
    views: [CullView; 2],
    commands: Vec<DrawCommand>,
    kept: Vec<u32>,
}

/// Boxes by chance, a third of which moved, before a camera that did too; every other one was drawn.
fn input(random: &mut Random, gpu: &Gpu) -> Input {
    let pose = Pose { position: random.vector() * 100.0, rotation: random.turn() };
    let shot = Shot { pose, projection: PERSPECTIVE, seconds: 0.0 };
    let before = Occludees::by_chance(random, &shot, SIZE, gpu.snap_px(), BOXES);
    let turn = DQuat::from_rotation_y(0.007);
    let moved = Pose { position: pose.position + 0.1 * random.vector(), rotation: pose.rotation * turn };
    let view = View::new(&Shot { pose: moved, ..shot }, SIZE, 1, gpu.snap_px());
    let mut now = before.bounds.clone();
    for bound in now.iter_mut().step_by(3) {
        (0..3).for_each(|axis| bound.centre_low[axis] += random.range(-0.1, 0.1) as f32);
    }
    let drawn = (0..BOXES as u32).step_by(2);
    let command = |object| DrawCommand {
        instance_count: u32::from(object % 8 > 0),
        first_instance: object,
        ..DrawCommand::default()
    };
    let kept = (0..BOXES).map(|_| u32::from(random.below(4) > 0)).collect();
    Input {
        before: before.bounds,
        now,
        views: [before.view, view.cull()],
        commands: drawn.map(command).collect(),
        kept,
    }
}

fn run(gpu: &Gpu, input: &Input, threshold: f32) -> Vec<u32> {
    let storage = Placement::Storage;
    let commands = Buffer::with_data(gpu, "test.commands", &input.commands, storage).unwrap();
    let count = Buffer::with_data(gpu, "test.count", &[input.commands.len() as u32], storage).unwrap();
    let kept = Buffer::with_data(gpu, "test.kept", &input.kept, storage).unwrap();
    let before = Buffer::with_data(gpu, "test.before", &input.before, storage).unwrap();
    let now = Buffer::with_data(gpu, "test.now", &input.now, storage).unwrap();
    let views = Buffer::with_data(gpu, "test.views", &input.views, storage).unwrap();
    let rapid = Buffer::with_data(gpu, "test.rapid", &vec![0u32; BOXES], storage).unwrap();
    let stage = woc::FindRapid {
        commands: commands.all(),
        count: count.all(),
        kept: kept.all(),
        bounds_before: before.all(),
        bounds_now: now.all(),
        views: views.all(),
        rapid: rapid.all(),
        threshold,
        first_command: 0,
    };
    let mut f = gpu.frame();
    f.dispatch(stage, RAPID_INVOCATIONS);
    f.finish().unwrap();
    rapid.read().unwrap()
}

#[test]
fn rapid_objects_are_found_as_the_twin_says() {
    let gpu = gpu();
    let mut random = Random::new(61);
    let (mut all, mut rapid, mut differ) = (0, 0, 0);
    for _ in 0..8 {
        let input = input(&mut random, &gpu);
        let ways = Ways { before: &input.before, now: &input.now, views: [&input.views[0], &input.views[1]] };
        let twin = |threshold: f32| {
            let mut flags = vec![0; BOXES];
            find_rapid(&input.commands, &input.kept, &ways, threshold, &mut flags);
            flags
        };
        let found = run(&gpu, &input, 0.02);
        // Rounding may decide for boxes that are as fast as the threshold: they differ from the twin's only if a threshold a
        // little off makes the twin say the same.
        let (lower, higher) = (twin(0.02 * 0.999), twin(0.02 * 1.001));
        for object in 0..BOXES {
            assert!(found[object] == lower[object] || found[object] == higher[object], "object {object}");
        }
        all += BOXES;
        rapid += found.iter().filter(|flag| **flag != 0).count();
        differ += found.iter().zip(twin(0.02)).filter(|(found, twin)| **found != *twin).count();
    }
    println!("{rapid} of {all} rapid, {differ} differ from the twin");
    assert!(rapid > all / 30 && rapid < all / 2, "{rapid} of {all} boxes are rapid: nothing is shown");
    assert!(differ <= all / 1000, "{differ} of {all} differ");
}

#[test]
fn a_box_that_holds_still_is_not_rapid_and_one_behind_the_eye_is() {
    let gpu = gpu();
    let at = |z: f32| Bounds { centre_high: [0.0, 0.0, z], half_extent: [0.5; 3], ..Bounds::default() };
    let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO);
    let view = View::new(&Shot { pose, projection: PERSPECTIVE, seconds: 0.0 }, SIZE, 0, gpu.snap_px()).cull();
    let rapid = |before: f32, now: f32| {
        let (before, now) = (vec![at(before)], vec![at(now)]);
        is_rapid(&Ways { before: &before, now: &now, views: [&view, &view] }, 0, 0.02)
    };
    assert!(!rapid(0.0, 0.0));
    assert!(!rapid(0.0, 0.001));
    assert!(rapid(0.0, 1.0));
    assert!(rapid(5.0, 5.0), "around the eye");
}

/// It once did: a camera that turned drew half the scene first.
#[test]
fn a_camera_that_turns_makes_nothing_rapid_and_one_that_hurries_does() {
    let gpu = gpu();
    let look = |position: DVec3, turn: f64| {
        let pose = Pose { position, rotation: DQuat::from_rotation_y(turn) };
        View::new(&Shot { pose, projection: PERSPECTIVE, seconds: 0.0 }, SIZE, 0, gpu.snap_px()).cull()
    };
    let still = vec![Bounds { centre_high: [0.3, -0.2, -4.0], half_extent: [0.5; 3], ..Bounds::default() }];
    let rapid = |view: CullView| {
        let views = [&look(DVec3::ZERO, 0.0), &view];
        is_rapid(&Ways { before: &still, now: &still, views }, 0, 0.02)
    };
    for turn in [-0.6, -0.3, 0.3, 0.6] {
        assert!(!rapid(look(DVec3::ZERO, turn)), "a turn");
        assert!(!rapid(look(DVec3::X * 0.01, turn)), "a turn and a step aside");
        assert!(rapid(look(DVec3::X * 0.3, turn)), "a turn and a leap aside");
    }
    assert!(!rapid(look(DVec3::NEG_Z * 0.01, 0.0)), "a step ahead");
    assert!(rapid(look(DVec3::NEG_Z * 2.0, 0.0)), "twice as near");
}

#[test]
fn rapid_objects_are_left_out_as_the_twin_says() {
    let gpu = gpu();
    let mut random = Random::new(62);
    let count = 1000;
    let mut flags = || (0..count).map(|_| u32::from(random.unit() < 0.4)).collect::<Vec<u32>>();
    let (rapid, mut visible) = (flags(), flags());
    let buffer = |data: &[u32]| Buffer::with_data(&gpu, "flags", data, Placement::Storage).unwrap();
    let (of_rapid, of_visible, of_remaining) = (buffer(&rapid), buffer(&visible), buffer(&rapid));
    let mut f = gpu.frame();
    let stage = woc::LeaveRapid {
        rapid: of_rapid.all(),
        visible: of_visible.all(),
        remaining: of_remaining.all(),
        object_count: count,
    };
    f.dispatch(stage, count);
    f.finish().unwrap();
    let remaining = leave_rapid(&rapid, &mut visible);
    assert_eq!((of_remaining.read().unwrap(), of_visible.read().unwrap()), (remaining, visible));
}

/// Whatever is drawn first, all that shows is drawn once the second test has had its say; and nothing is drawn twice.
#[test]
fn drawing_first_loses_nothing_and_draws_nothing_twice() {
    let gpu = gpu();
    for threshold in ["0", "0.005", "0.08"] {
        for size in ["1", "2", "4"] {
            let subject = Subject::named("woc-exact").with("rapid", threshold).with("size", size);
            for case in [worlds::walled(300), worlds::special::topologies(), worlds::special::creeping()] {
                assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
                let mut lab = harness::Lab::new(&gpu, &case);
                let mut method = lab.make(&subject, &Default::default());
                for (frame, take) in lab.film(&mut *method, &case.shots).iter().enumerate() {
                    let mut drawn: Vec<u32> = take.commands.iter().map(|command| command.first_instance).collect();
                    let all = drawn.len();
                    drawn.sort_unstable();
                    drawn.dedup();
                    assert_eq!(all, drawn.len(), "{}, {}, frame {frame}", subject.options.label(), case.name);
                }
            }
        }
    }
}
