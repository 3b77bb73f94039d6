//! Sub-pixel slivers are outside the raster conditions of promised depths. `bench` and `stress` treat them by one rule.

use harness::gpu;
use sightline::run::bench::{bench, BenchOptions};
use sightline::run::session::{Session, SessionOptions};
use sightline::run::truth::RunTruth;
use sightline::run::Contender;

const METHOD: &str = "hzb-iterative";

fn session(gpu: &engine::Gpu) -> Session {
    // Frame 2 shows a stone's face 0.00001 pixel high, whose pixel is 50 times as near as the stone.
    let options = SessionOptions {
        scene: "satellite".into(),
        scale: 0.25,
        path: Some("cuts".into()),
        frames: 3,
        size: [1280, 720],
        ..SessionOptions::default()
    };
    Session::on(gpu, options).unwrap()
}

/// `bench` called the stone lost.
#[test]
fn bench_excuses_slivers_and_counts_them() {
    let gpu = gpu();
    let entry = culling::find(METHOD).unwrap();
    let options = BenchOptions {
        methods: vec![(entry, entry.default_options())],
        warmup: 0,
        metrics: true,
        pairs: Vec::new(),
        capture: None,
        cache: None,
        command: "a test".into(),
    };
    let results = bench(&mut session(&gpu), options, &mut |_, _, _| {}).unwrap();
    let method = &results.methods[0];
    let errors = (method.false_negatives, method.differing_pixels_mean, method.object_error_percent);
    assert_eq!(errors, (0, 0.0, 0.0), "{:?}", method.frames.thin_pixels);
    assert_eq!((method.psnr_worst_db, method.ssim_mean), (None, 1.0));

    // The comparison itself excuses nothing. If it finds no error on a device, nothing is excused there either.
    let mut session = session(&gpu);
    let mut contender = Contender::new(&session, entry, entry.default_options(), &None).unwrap();
    let truth = RunTruth::draw(&mut session, || ()).unwrap();
    for frame in 0..session.frames() {
        let truth = truth.frame(&mut session, frame).unwrap();
        let error = contender.measured(&mut session, frame, &truth).unwrap().error;
        let wrong = error.false_negatives + error.differing_pixels > 0;
        assert_eq!(wrong, method.frames.thin_pixels[frame] > 0, "frame {frame}: {error:?}");
    }
    let thin: u64 = method.frames.thin_pixels.iter().sum();
    assert_eq!(method.thin_pixels_mean, thin as f64 / 3.0);
}
