//! What tables are made of, on a device: warps over whole runs, and methods compared with each other.

use culling::warp::{Settings, OPTIONS};
use culling::Options;
use harness::{gpu, sessions};
use sightline::pictures::warp_view::warp;
use sightline::run::bench::{bench, BenchOptions};
use sightline::run::session::{Session, SessionOptions};
use sightline::run::Contender;
use sightline::tables::warp_errors::warp_errors;

const FRAMES: usize = 4;

fn settings(set: &[(&str, &str)]) -> Settings {
    let mut options = Options::new("warp", OPTIONS);
    set.iter().for_each(|(name, value)| options.set(name, value).unwrap());
    Settings::of(&options)
}

#[test]
fn a_runs_warp_errors_are_those_of_its_pictures() {
    let gpu = gpu();
    let settings = [settings(&[]), settings(&[("size", "2"), ("seeds", "1"), ("steps", "0")])];
    for run in [("city-block", 0.02, "walk"), ("moving-boxes", 1.0, "walk"), ("rooms", 0.1, "rotate")] {
        for settings in settings {
            let mut session = sessions::open(&gpu, run, FRAMES);
            let mut steps = 0;
            let errors = warp_errors(&mut session, settings, &mut || steps += 1).unwrap();
            assert_eq!((errors.len(), steps), (FRAMES - 1, FRAMES - 1));
            assert!(
                errors.iter().any(|errors| errors.psnr_db.is_some() && errors.ssim < 1.0),
                "{run:?}: no error at all"
            );
            let none = culling::find("none").unwrap();
            let mut none = Contender::new(&session, none, none.default_options(), &None).unwrap();
            for (frame, errors) in (1..).zip(errors) {
                let shown = warp(&mut session, &mut none, frame, settings).unwrap().errors().unwrap();
                assert_eq!(shown, errors, "{run:?}, frame {frame}, {settings:?}");
            }
        }
    }
}

#[test]
fn a_warp_needs_a_frame_before() {
    let gpu = gpu();
    let mut session = sessions::open(&gpu, ("boxes", 1.0, "still"), 1);
    let error = warp_errors(&mut session, settings(&[]), &mut || ()).unwrap_err().to_string();
    assert!(error.contains("--frames 2"), "{error}");
}

/// `none` draws the truth: what is between it and a method is the method's error. Planted: `woc` without its care, at a speed at
/// which it errs.
#[test]
fn a_method_differs_from_none_as_it_does_from_the_truth() {
    let gpu = gpu();
    let size = [320, 180];
    let (scene, path) = ("city-block".into(), Some("walk".into()));
    let fast =
        SessionOptions { scene, path, scale: 0.05, speed: 16.0, frames: FRAMES, size, ..SessionOptions::default() };
    let mut session = Session::on(&gpu, fast).unwrap();
    let methods = ["none", "frustum", "woc"].map(|id| culling::find(id).unwrap());
    let pair = |label: &str| ["none".to_owned(), label.to_owned()];
    let mut methods = methods.map(|entry| (entry, entry.default_options()));
    for (option, value) in [("size", "1"), ("erode", "none"), ("rapid", "0"), ("seeds", "4")] {
        methods[2].1.set(option, value).unwrap();
    }
    let careless = methods[2].1.label();
    let options = BenchOptions {
        methods: methods.into(),
        warmup: 1,
        metrics: true,
        pairs: vec![pair("frustum"), pair(&careless)],
        capture: None,
        cache: None,
        command: String::new(),
    };
    let results = bench(&mut session, options, &mut |_, _, _| ()).unwrap();
    let [none, frustum, woc] = ["none", "frustum", &careless].map(|label| results.method(label).unwrap());
    assert!(none.psnr_between_db.is_empty(), "nobody asked");
    assert_eq!(frustum.psnr_between_db["none"], None, "an exact method's pictures are identical");
    assert!(woc.psnr_mean_db.is_some(), "woc made no error, so this proves nothing: go faster");
    assert_eq!(woc.psnr_between_db["none"], woc.psnr_mean_db);
}

#[test]
fn a_pair_of_methods_that_do_not_run_is_refused() {
    let gpu = gpu();
    let mut session = sessions::open(&gpu, ("boxes", 1.0, "still"), 1);
    let none = culling::find("none").unwrap();
    let options = BenchOptions {
        methods: vec![(none, none.default_options())],
        warmup: 0,
        metrics: true,
        pairs: vec![["none".to_owned(), "hzb".to_owned()]],
        capture: None,
        cache: None,
        command: String::new(),
    };
    let error = bench(&mut session, options, &mut |_, _, _| ()).unwrap_err().to_string();
    assert!(error.contains("'hzb' is to be compared"), "{error}");
}
