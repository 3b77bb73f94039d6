//! Flares as `sightline bench` runs them: what its results say, and that they say nothing where there are none.

use culling::flares::{Light, Settings, When};
use engine::Gpu;
use glam::DVec3;
use harness::gpu;
use sightline::results::{flares_table, Results};
use sightline::run::bench::{bench, write, BenchOptions};
use sightline::run::methods::parse_methods;
use sightline::run::session::{Session, SessionOptions};

fn run(gpu: &Gpu, flares: Option<Settings>, metrics: bool) -> Results {
    let options = SessionOptions {
        scale: 0.02,
        speed: 24.0,
        path: Some("walk".into()),
        frames: 10,
        size: [160, 90],
        flares,
        ..SessionOptions::default()
    };
    let mut session = Session::on(gpu, options).unwrap();
    let options = BenchOptions {
        methods: parse_methods("none,hzb,chc", &[]).unwrap(),
        warmup: 1,
        metrics,
        pairs: Vec::new(),
        capture: None,
        cache: None,
        command: "test".into(),
    };
    bench(&mut session, options, &mut |_, _, _| ()).unwrap()
}

/// Ahead of the walk through the city block, where trees and house fronts pass before it.
fn light() -> Light {
    Light::Towards(DVec3::new(1.0, 0.06, 0.12))
}

#[test]
fn results_hold_what_flares_knew_and_how_wrong_that_was() {
    let gpu = gpu();
    let of = |when| run(&gpu, Some(Settings { when, light: light() }), true);
    let (late, waited) = (of(When::Next), of(When::Same));
    let (late, waited) = (&late.methods, &waited.methods);
    let oracle = &late[0].frames.flare_by_oracle;
    assert_eq!(oracle.len(), 10);
    assert!(oracle.windows(2).any(|pair| pair[0] != pair[1]), "what shows never changes: {oracle:?}");
    for (late, waited) in late.iter().zip(waited) {
        assert_eq!((&late.frames.flare_by_oracle, &waited.frames.flare_by_oracle), (oracle, oracle), "{}", late.label);
        assert_eq!(&waited.frames.flare_by_query, oracle, "{}", late.label);
        assert_eq!(late.frames.flare_by_query[1..], oracle[..9], "{}", late.label);
        let [wrong, right] = [late, waited].map(|method| method.flare.clone().unwrap());
        assert_eq!((right.error_mean, right.error_max), (Some(0.0), Some(0.0)));
        let errors: Vec<f64> =
            late.frames.flare_by_query.iter().zip(oracle).map(|(query, oracle)| (query - oracle).abs()).collect();
        assert_eq!(wrong.error_max, errors.iter().copied().reduce(f64::max));
        assert!((wrong.error_mean.unwrap() - errors.iter().sum::<f64>() / 10.0).abs() < 1e-12);
        assert!(wrong.error_max > Some(0.0) && wrong.frames_on_screen > 0);
        assert_eq!((wrong.when.as_str(), wrong.light.as_str()), ("next", "towards 1,0.06,0.12"));
        // Errors are of culling: that of an exact method stays 0 with a flare over its pictures.
        assert_eq!((late.psnr_worst_db, late.false_negatives), (None, 0), "{}", late.label);
        let stage = |name: &str| waited.stages.iter().any(|stage| stage.name == name);
        assert!(stage("flares/test_block") && stage("frame/wait_for_queries:flares") && stage("flares/draw_sprites"));
    }
}

#[test]
fn without_flares_nothing_is_said_of_them() {
    let gpu = gpu();
    let results = run(&gpu, None, true);
    let folder = std::env::temp_dir().join(format!("sightline-flares-{}", std::process::id()));
    write(&results, &folder).unwrap();
    for file in ["results.json", "results.csv"] {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        assert!(text.contains("false_negatives") && !text.contains("flare"), "{file}");
    }
    std::fs::remove_dir_all(folder).unwrap();
    assert_eq!(flares_table(&results), "");
    assert!(results.methods.iter().flat_map(|method| &method.stages).all(|stage| !stage.name.contains("flares")));
}

#[test]
fn times_alone_say_nothing_of_errors() {
    let gpu = gpu();
    let results = run(&gpu, Some(Settings { when: When::Next, light: light() }), false);
    let flare = results.methods[0].flare.as_ref().unwrap();
    assert_eq!((flare.error_mean, flare.shows_mean), (None, None));
    let counted = |label: &str| label.starts_with("flares/count");
    assert!(results.methods[0].stages.iter().all(|stage| !counted(&stage.name)), "the oracle runs in timed frames");
    assert!(flares_table(&results).contains("the query of the frame before"), "{}", flares_table(&results));
}
