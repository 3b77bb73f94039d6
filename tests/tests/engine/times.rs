//! Times of stages: each stage has its own, wherever it stands in its frame.

use engine::{Buffer, DeviceKind, Error, Extra, FrameReport, Gpu, Placement, Shapes, StageTime, Surface, TimerMode};
use harness::gpu;
use shaders::engine::{SpinPixels, SpinWords};
use std::time::Instant;

/// Words that a light stage spins: one group.
const LIGHT: u32 = 64;

/// Words of a heavy stage. A GPU needs more of them until the work outweighs the start of a stage.
fn heavy(gpu: &Gpu) -> u32 {
    match gpu.info().map(|info| info.kind) {
        Some(DeviceKind::Cpu) => 1 << 20,
        _ => 1 << 24,
    }
}

/// The stages of a frame in two submissions, of which one is heavy: first or last of the first one, or first or last of the second.
fn frame(gpu: &Gpu, words: &Buffer<u32>, place: usize) -> FrameReport {
    let other = Buffer::with_data(gpu, "test.other", &[1u32; 64], Placement::ReadBack).unwrap();
    let spin = |at: usize| {
        let count = if at == place { heavy(gpu) } else { LIGHT };
        (SpinWords { words: words.all(), word_count: count }, count)
    };
    let mut f = gpu.frame();
    let (stage, count) = spin(0);
    f.dispatch(stage, count);
    f.part("early");
    // Neither has a row, nor moves the rows after it.
    f.dispatch(stage, 0);
    f.skip("test/never", "there is no need");
    let (stage, count) = spin(1);
    f.dispatch(stage, count);
    f.read(&other).unwrap();
    f.part("late");
    let (stage, count) = spin(2);
    f.dispatch(stage, count);
    f.skip("test/never", "there is no need");
    f.part("");
    let (stage, count) = spin(3);
    f.dispatch(stage, count);
    f.finish().unwrap()
}

/// The times of the first two stages were swapped. A heavy stage stands in each place: its row takes longer than each light row. Other work on the
/// machine lengthens stages and shortens none, so the shortest of some runs stands for each row. A device without timestamps has no rows at all.
#[test]
fn a_heavy_stage_takes_the_time_wherever_it_stands() {
    const ROWS: [&str; 5] = [
        "engine/spin_words",
        "engine/spin_words:early",
        "frame/read_back:early",
        "engine/spin_words:late",
        "engine/spin_words",
    ];
    let gpu = gpu();
    let words = Buffer::with_data(&gpu, "test.words", &vec![1u32; heavy(&gpu) as usize], Placement::Storage).unwrap();
    for (place, row) in [0, 1, 3, 4].into_iter().enumerate() {
        let runs: Vec<FrameReport> = (0..5).map(|_| frame(&gpu, &words, place)).collect();
        if gpu.timer_mode() == TimerMode::Off {
            assert!(!gpu.has(Extra::Timestamps) && runs.iter().all(|report| report.stages.is_empty()));
            continue;
        }
        for report in &runs {
            let labels: Vec<_> = report.stages.iter().map(|stage| stage.label.as_str()).collect();
            assert_eq!((labels.as_slice(), report.submissions), (ROWS.as_slice(), 2));
        }
        let shortest = |at: usize| runs.iter().map(|report| report.stages[at].ms).fold(f64::INFINITY, f64::min);
        for light in [0, 1, 3, 4].into_iter().filter(|light| *light != row) {
            let (long, short) = (shortest(row), shortest(light));
            assert!(long > short, "the heavy stage is {}, row {row}: {long} ms, but row {light} {short} ms", ROWS[row]);
        }
    }
}

/// A frame without stage times has no rows, and is timed as a whole.
#[test]
fn a_frame_that_is_timed_alone_has_no_rows() {
    let gpu = gpu();
    let words = Buffer::with_data(&gpu, "test.words", &[1u32; 64], Placement::Storage).unwrap();
    let mut f = gpu.frame();
    f.without_stage_times();
    f.dispatch(SpinWords { words: words.all(), word_count: LIGHT }, LIGHT);
    assert_eq!(f.read(&words).unwrap(), [super::frames::spun(1); 64]);
    f.on_host("frame/host", || ());
    f.dispatch(SpinWords { words: words.all(), word_count: LIGHT }, LIGHT);
    let report = f.finish().unwrap();
    assert_eq!((report.stages, report.submissions), (Vec::<StageTime>::new(), 2));
    assert!(report.frame_ms > 0.0 && report.host_ms > 0.0);
}

/// All times of a frame lie within the time between its beginning and its end, as the caller measures it. Work of the host before the first submission
/// and between two belongs to the frame, with a row of its own.
#[test]
fn no_time_of_a_frame_is_longer_than_the_frame_took() {
    let gpu = gpu();
    let words = Buffer::with_data(&gpu, "test.words", &[1u32; 64], Placement::ReadBack).unwrap();
    let spin = || SpinWords { words: words.all(), word_count: LIGHT };
    let begun = Instant::now();
    let mut f = gpu.frame();
    f.on_host("frame/before", || (0..100_000).fold(1u32, |sum, step| std::hint::black_box(sum ^ step)));
    f.dispatch(spin(), LIGHT);
    f.read(&words).unwrap();
    f.on_host("frame/between", || (0..100_000).fold(1u32, |sum, step| std::hint::black_box(sum ^ step)));
    f.dispatch(spin(), LIGHT);
    let report = f.finish().unwrap();
    let took_ms = begun.elapsed().as_secs_f64() * 1e3;
    let within = |what: &str, ms: f64| assert!(ms > 0.0 && ms <= took_ms, "{what}: {ms} of {took_ms} ms");
    within("the frame", report.frame_ms);
    within("the host", report.host_ms);
    let of_host = |label: &str| report.stages.iter().find(|stage| stage.label == label).map(|stage| stage.ms);
    let rows = [of_host("frame/before"), of_host("frame/between")];
    if gpu.has(Extra::Timestamps) {
        rows.iter().for_each(|row| within("a row", row.expect("a row of its own")));
    } else {
        assert_eq!(rows, [None; 2]);
    }
    assert!(report.frame_ms >= rows.iter().flatten().sum(), "{rows:?} of {} ms", report.frame_ms);
}

/// A pool has 4096 timestamps: one before the first stage, and one after each.
#[test]
fn a_submission_times_4095_stages_and_refuses_more() {
    let gpu = gpu();
    let word = Buffer::<u32>::new(&gpu, "test.word", 1, Placement::ReadBack).unwrap();
    let run = |stages: u32| {
        let mut f = gpu.frame();
        (0..stages).for_each(|stage| f.fill("test/fill", &word, stage));
        f.finish()
    };
    let report = run(4095).unwrap();
    assert_eq!(report.stages.len(), if gpu.has(Extra::Timestamps) { 4095 } else { 0 });
    assert_eq!(word.read().unwrap(), [4094]);
    let error = run(4096).unwrap_err();
    assert!(matches!(error, Error::TooLarge { .. }) && error.to_string().contains("4096 stages"), "{error}");
    assert_eq!(word.read().unwrap(), [4094], "nothing of it ran");
    assert_eq!(run(3).map(|report| report.submissions).unwrap(), 1, "the device goes on");
    assert_eq!(word.read().unwrap(), [2]);
}

/// What the device counts adds up over the submissions of a frame.
#[test]
fn statistics_add_up_over_submissions() {
    let gpu = gpu();
    let size = [8; 2];
    let depth = engine::Image::new(&gpu, "test.depth", engine::Format::Depth, size).unwrap();
    let target = engine::Target {
        size,
        colour: None,
        item: None,
        depth: depth.view(),
        depth_read_only: false,
        strictly_nearer: false,
        samples: None,
    };
    let word = Buffer::<u32>::new(&gpu, "test.word", 1, Placement::ReadBack).unwrap();
    let draw = |f: &mut engine::Frame, count| {
        f.draw_shapes(SpinPixels {}, Shapes { corners: 3, count, surface: Surface::Opaque }, &target)
    };
    let mut f = gpu.frame();
    f.count_statistics();
    f.clear(&target);
    draw(&mut f, 2);
    f.read(&word).unwrap();
    draw(&mut f, 5);
    let counted = f.finish().unwrap().statistics;
    assert_eq!(counted.map(|counted| counted.primitives), gpu.has(Extra::PipelineStatistics).then_some(2 + 5));
    // Drivers may count helper fragments, but none is left out.
    assert!(counted.is_none_or(|counted| counted.fragments >= (2 + 5) * 64), "{counted:?}");
    let mut f = gpu.frame();
    f.clear(&target);
    draw(&mut f, 1);
    assert_eq!(f.finish().unwrap().statistics, None, "nobody asked");
}
