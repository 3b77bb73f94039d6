//! Frames: stages, labels, times, statistics, read-backs in the middle.

use culling::{View, World};
use engine::{
    Buffer, Error, Extra, Faces, Format, Frame, FrameReport, Gpu, GpuOptions, Image, IndexedIndirect, Placement,
    Primitives, Surface, Target, TimerMode,
};
use harness::worlds::{cube, dust, shot, sized, square, wires, Maker};
use harness::{gpu, options, worlds, Lab, Random, Subject};
use scenes::Projection;
use shaders::engine::{SpinPixels, SpinWords};
use shaders::types::DrawCommand;
use sightline::run::targets::Targets;
use std::time::Instant;

/// Twin of `engine/spin_words`.
pub fn spun(word: u32) -> u32 {
    (0..8).fold(word, |word, _| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223))
}

fn words(gpu: &Gpu, data: &[u32]) -> Buffer<u32> {
    Buffer::with_data(gpu, "test.words", data, Placement::Storage).unwrap()
}

fn spin(words: &Buffer<u32>) -> SpinWords {
    SpinWords { words: words.all(), word_count: words.len() as u32 }
}

#[test]
fn a_grid_of_any_length_runs_each_invocation_once() {
    let gpu = gpu();
    // One group more than a grid has in one dimension.
    for count in [1, 63, 64, 65, 65_536 * 64 + 1] {
        let data: Vec<u32> = (0..count).collect();
        let buffer = words(&gpu, &data);
        let mut f = gpu.frame();
        f.dispatch(spin(&buffer), count);
        f.finish().unwrap();
        let found = buffer.read().unwrap();
        let wrong: Vec<usize> = (0..data.len()).filter(|at| found[*at] != spun(data[*at])).collect();
        assert!(
            wrong.is_empty(),
            "{count} invocations: {} wrong from {:?} on, to {:?}; not run: {}",
            wrong.len(),
            wrong[0],
            wrong.last(),
            wrong.iter().filter(|at| found[**at] == data[**at]).count()
        );
    }
}

#[test]
fn an_indirect_dispatch_runs_the_groups_that_the_gpu_says() {
    let gpu = gpu();
    for (groups, expected) in [(0u32, 0usize), (1, 64), (3, 192)] {
        let buffer = words(&gpu, &[7; 200]);
        let grid = words(&gpu, &[groups, 1, 1]);
        let mut f = gpu.frame();
        f.dispatch_indirect(spin(&buffer), grid.all());
        f.finish().unwrap();
        let found = buffer.read().unwrap();
        assert!(
            found[..expected].iter().all(|word| *word == spun(7)) && found[expected..].iter().all(|word| *word == 7)
        );
    }
}

#[test]
fn fills_copies_and_reads_in_the_middle_come_in_order() {
    let gpu = gpu();
    let (one, other) = (words(&gpu, &[1; 64]), words(&gpu, &[2; 64]));
    let mut f = gpu.frame();
    f.dispatch(spin(&one), 64);
    f.copy("test/copy", one.all(), other.all());
    f.fill("test/fill", &one, 9);
    assert_eq!(f.read(&other).unwrap(), [spun(1); 64], "a read sees what was recorded before it");
    f.dispatch(spin(&one), 64);
    f.copy("test/copy", one.all(), other.all());
    let report = f.finish().unwrap();
    assert_eq!(other.read().unwrap(), [spun(9); 64]);
    assert_eq!(report.submissions, 2);
    let labels: Vec<&str> = report.stages.iter().map(|stage| stage.label.as_str()).collect();
    let expected = ["engine/spin_words", "test/copy", "test/fill", "frame/read_back", "engine/spin_words", "test/copy"];
    assert_eq!(labels, expected, "the wait for a read is a row of its own");
}

#[test]
fn what_the_host_does_for_the_device_counts_as_the_frames_time() {
    let gpu = gpu();
    let buffer = words(&gpu, &[1; 64]);
    let long = std::time::Duration::from_millis(40);
    let work = || std::thread::sleep(long);
    let long_ms = long.as_secs_f64() * 1e3;

    let begun = Instant::now();
    let mut f = gpu.frame();
    f.on_host("frame/work", work);
    f.dispatch(spin(&buffer), 64);
    let before = (f.finish().unwrap(), begun.elapsed());
    let begun = Instant::now();
    let mut f = gpu.frame();
    f.dispatch(spin(&buffer), 64);
    f.read(&buffer).unwrap();
    f.on_host("frame/work", work);
    f.dispatch(spin(&buffer), 64);
    let between = (f.finish().unwrap(), begun.elapsed());
    for (report, took) in [before, between] {
        let row = report.stages.iter().find(|stage| stage.label == "frame/work").expect("a row of its own");
        assert!(row.ms >= long_ms && report.frame_ms >= row.ms, "{} of {}", row.ms, report.frame_ms);
        assert!(report.frame_ms < 2.0 * row.ms, "counted twice: {} ms", report.frame_ms);
        let recording_and_work = report.host_ms + row.ms;
        assert!(
            recording_and_work <= took.as_secs_f64() * 1e3,
            "{recording_and_work} ms of {took:?}: it is no recording"
        );
    }
    let mut f = gpu.frame();
    work();
    f.dispatch(spin(&buffer), 64);
    let recording = f.finish().unwrap();
    assert!(recording.host_ms >= long_ms && recording.frame_ms < long_ms, "recording is no part of the frame's time");
}

#[test]
fn labels_name_the_stage_and_its_part_of_the_frame() {
    let gpu = gpu();
    let buffer = words(&gpu, &[1; 64]);
    let mut f = gpu.frame();
    f.dispatch(spin(&buffer), 64);
    f.part("early");
    f.dispatch(spin(&buffer), 64);
    f.dispatch(spin(&buffer), 0);
    f.skip("test/never", "there is no need");
    f.part("");
    f.fill("test/fill", &buffer, 0);
    let report = f.finish().unwrap();
    let labels: Vec<&str> = report.stages.iter().map(|stage| stage.label.as_str()).collect();
    assert_eq!(labels, ["engine/spin_words", "engine/spin_words:early", "test/fill"]);
    let skips: Vec<_> = report.skips.iter().map(|skip| (skip.label.as_str(), skip.reason)).collect();
    assert_eq!(skips, [("engine/spin_words:early", "nothing to do"), ("test/never:early", "there is no need")]);
}

#[test]
fn an_empty_frame_is_no_error() {
    let gpu = gpu();
    let report = gpu.frame().finish().unwrap();
    assert_eq!((report.submissions, report.stages.len()), (0, 0));
}

/// A frame with a heavy drawing and then a light dispatch.
fn heavy_and_light(gpu: &Gpu) -> FrameReport {
    let size = [512; 2];
    let colour = Image::new(gpu, "test.colour", Format::Colour, size).unwrap();
    let depth = Image::new(gpu, "test.depth", Format::Depth, size).unwrap();
    let target = Target {
        size,
        colour: Some((colour.view(), Format::Colour)),
        item: None,
        depth: depth.view(),
        depth_read_only: false,
        strictly_nearer: false,
        samples: None,
    };
    let corners = words(gpu, &[0, 1, 2]);
    let command = DrawCommand { index_count: 3, instance_count: 1, ..DrawCommand::default() };
    let commands = Buffer::with_data(gpu, "test.commands", &[command], Placement::Storage).unwrap();
    let draw = IndexedIndirect {
        vertices: corners.all().into(),
        instances: corners.all().into(),
        indices: corners.all().into(),
        commands: commands.all().into(),
        count: None,
        max_draws: 1,
        primitives: Primitives::Triangles,
        faces: Faces::Both,
        surface: Surface::Opaque,
    };
    let light = words(gpu, &[1; 64]);
    let run = || {
        let mut f = gpu.frame();
        f.clear(&target);
        f.draw(SpinPixels {}, draw, &target);
        f.draw(SpinPixels {}, draw, &target);
        f.draw(SpinPixels {}, draw, &target);
        f.dispatch(spin(&light), 64);
        f.finish().unwrap()
    };
    run();
    run()
}

#[test]
fn time_is_charged_to_the_stage_that_takes_it() {
    let gpu = gpu();
    // What else runs on the device can lengthen a frame and its stages, and shortens neither: the run it disturbed least counts.
    let sum_of = |report: &FrameReport| report.stages.iter().map(|stage| stage.ms).sum::<f64>();
    let missing = |report: &FrameReport| (report.frame_ms - sum_of(report)).abs();
    let runs = (0..8).map(|_| heavy_and_light(&gpu));
    let report = runs.min_by(|one, other| missing(one).total_cmp(&missing(other))).unwrap();
    let sum = sum_of(&report);
    let light = report.stages.last().unwrap().ms;
    assert!(
        light < 0.2 * sum,
        "the light stage got {light} of {sum} ms with {}: {:?}",
        gpu.timer_mode(),
        report.stages
    );
    let tolerance = (0.05 * report.frame_ms).max(0.3);
    assert!(missing(&report) <= tolerance, "stages take {sum} ms of a frame of {} ms", report.frame_ms);
}

/// Seven squares one behind the other, drawn nearest first and then farthest first: half of each side of the picture is
/// covered, once or seven times.
#[test]
fn the_heat_picture_counts_fragments_exactly() {
    let gpu = gpu();
    let size = [64, 32];
    for (step, expected) in [(-1.0, 1), (1.0, 7)] {
        let mut maker = Maker::new("squares");
        let square = maker.mesh(square());
        for row in 0..7 {
            let at = glam::DVec3::new(0.0, 0.0, -10.0 + step * f64::from(row));
            maker.place(square, sized(at, glam::DVec3::new(2.0, 1.0, 1.0)));
        }
        let world = World::new(&gpu, &maker.scene).unwrap();
        let heat = Image::new(&gpu, "test.heat", Format::Heat, size).unwrap();
        let depth = Image::new(&gpu, "test.depth", Format::Depth, size).unwrap();
        let target = Target {
            size,
            colour: Some((heat.view(), Format::Heat)),
            item: None,
            depth: depth.view(),
            depth_read_only: false,
            strictly_nearer: false,
            samples: None,
        };
        let projection = Projection::Orthographic { half_height: 1.0, near: 0.0, far: 20.0 };
        let view = View::new(&shot(glam::DVec3::ZERO, glam::DVec3::NEG_Z, projection), size, 0, gpu.snap_px());
        let mut f = gpu.frame();
        f.clear(&target);
        world.draw_all(&mut f, &view, &target);
        f.finish().unwrap();
        let halves: Vec<u16> = bytemuck::pod_collect_to_vec(&heat.read().unwrap());
        // 1.0 and 7.0 as half floats.
        let wanted = if expected == 1 { 0x3c00 } else { 0x4700 };
        let counted = halves.iter().filter(|half| **half == wanted).count();
        let empty = halves.iter().filter(|half| **half == 0).count();
        assert_eq!((counted, empty), (32 * 16, 64 * 32 - 32 * 16), "each covered pixel counts {expected}");
    }
}

/// Primitives are counted before clipping: all of them, whatever shows.
#[test]
fn statistics_count_primitives_exactly() {
    let gpu = gpu();
    // `without.rs` holds that such a device counts nothing at all.
    if !gpu.has(Extra::PipelineStatistics) {
        return;
    }
    let size = [64, 32];
    let draw = |mesh, place| {
        let mut maker = Maker::new("one");
        let mesh = maker.mesh(mesh);
        for row in 0..7 {
            maker.place(mesh, sized(glam::DVec3::new(0.0, 0.0, -5.0 - f64::from(row)), place));
        }
        let world = World::new(&gpu, &maker.scene).unwrap();
        let targets = Targets::new(&gpu, size).unwrap();
        let projection = Projection::Orthographic { half_height: 1.0, near: 0.0, far: 20.0 };
        let view = View::new(&shot(glam::DVec3::ZERO, glam::DVec3::NEG_Z, projection), size, 0, gpu.snap_px());
        let mut f = gpu.frame();
        f.count_statistics();
        f.clear(&targets.timed());
        world.draw_all(&mut f, &view, &targets.timed());
        f.finish().unwrap().statistics.expect("a device that counts")
    };
    let half = glam::DVec3::new(2.0, 1.0, 1.0);
    let squares = draw(square(), half);
    // Half of each side is covered. Drivers may count helper fragments, and lavapipe counts whole blocks of 4x4 pixels,
    // before the early tests: the heat picture is the exact count.
    assert_eq!(squares.primitives, 7 * 2);
    assert!(squares.fragments >= 32 * 16, "{} fragments", squares.fragments);
    assert_eq!(draw(cube(), half * 1e-6).primitives, 7 * 12);
    assert_eq!(draw(wires(), half).primitives, 7 * 12);
    assert_eq!(draw(dust(&mut Random::new(1), 20), half).primitives, 7 * 20);
    let mut without = gpu.frame();
    without.fill("test/fill", &words(&gpu, &[0]), 1);
    assert_eq!(without.finish().unwrap().statistics, None);
}

#[test]
fn barriers_before_every_stage_and_either_timer_change_no_picture() {
    let gpu = gpu();
    let case = worlds::special::topologies();
    let film = |gpu: &Gpu| {
        let mut lab = Lab::new(gpu, &case);
        let mut method = lab.make(&Subject::named("hzb"), &Default::default());
        let film = lab.film(&mut *method, &case.shots);
        film.into_iter().map(|take| (take.images, take.commands)).collect::<Vec<_>>()
    };
    let expected = film(&gpu);
    for (timer, barrier_every_stage) in [(TimerMode::Split, true), (TimerMode::Plain, true), (TimerMode::Plain, false)]
    {
        let careful = Gpu::open(&GpuOptions { timer: Some(timer), barrier_every_stage, ..options() }).unwrap();
        assert!(film(&careful) == expected, "{timer}, a barrier before every stage: {barrier_every_stage}");
    }
}

#[test]
fn a_validation_message_fails_the_frame_and_names_its_stage() {
    let gpu = gpu();
    let (long, short) = (words(&gpu, &[1; 64]), words(&gpu, &[2; 8]));
    let mut f = gpu.frame();
    f.copy("test/too_long", long.all(), short.all());
    // The copy is invalid and must not run: only its recording is of interest. lavapipe runs it within its allocation.
    match f.finish() {
        Err(Error::Validation { stage, text }) => {
            assert!(stage == "test/too_long" && text.contains("VUID"), "{stage}: {text}")
        }
        other => panic!("an invalid copy passed: {other:?}"),
    }
    let _ = gpu.take_messages();
}

#[test]
fn a_frame_that_is_dropped_runs_nothing() {
    let gpu = gpu();
    let buffer = words(&gpu, &[1; 64]);
    let mut f: Frame = gpu.frame();
    f.dispatch(spin(&buffer), 64);
    drop(f);
    assert_eq!(buffer.read().unwrap(), [1; 64]);
}
