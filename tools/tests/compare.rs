//! `sightline compare` as a script meets it: the program itself, its output and its exit code.

use sightline::results::{Device, FrameMs, Frames, Method, Results, Scene, Stage, SCHEMA};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const STAGE: &str = "hzb/test_bounds:culling";

/// 12 frames of `none` and `hzb`, the latter at `times` the usual time.
fn run(times: f64) -> Results {
    let methods = [("none", 100.0), ("hzb", 10.0 * times)].map(|(id, base)| method(id, base));
    Results {
        schema: SCHEMA,
        sightline_version: "0.1.0".into(),
        command: "sightline bench".into(),
        device: Device { name: "llvmpipe".into(), kind: "cpu".into(), ..Device::default() },
        scene: Scene { name: "city-block".into(), objects: 10, triangles: 120, ..Scene::default() },
        path: "walk".into(),
        speed: 1.0,
        seed: 1,
        size: [320, 180],
        frames: 12,
        methods: methods.to_vec(),
    }
}

fn method(id: &str, base: f64) -> Method {
    let frame_ms: Vec<f64> = (0..12).map(|frame| base * (1.0 + 0.01 * f64::from(frame * 5 % 12))).collect();
    let stage_ms = frame_ms.iter().map(|ms| Some(ms / 2.0)).collect();
    Method {
        label: id.into(),
        method: id.into(),
        guarantee: "exact".into(),
        frame_ms: FrameMs::from_samples(&frame_ms).unwrap(),
        stages: vec![Stage { name: STAGE.into(), median_ms: base / 2.0, share: 0.5, ..Stage::default() }],
        ssim_mean: 1.0,
        drawn_mean: 5.0,
        frames: Frames {
            frame_ms,
            drawn: vec![5; 12],
            false_negatives: vec![0; 12],
            psnr_db: vec![None; 12],
            stages: [(STAGE.to_owned(), stage_ms)].into(),
            ..Frames::default()
        },
        ..Method::default()
    }
}

/// Two files, of which the second's `hzb` takes twice as long (a factor that floats keep exactly) and misses two objects.
struct Files {
    a: PathBuf,
    b: PathBuf,
}

fn files(test: &str) -> Files {
    let mut slower = run(2.0);
    slower.methods[1].false_negatives = 2;
    Files { a: written(test, "a", &run(1.0)), b: written(test, "b", &slower) }
}

fn written(test: &str, name: &str, results: &Results) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.json"));
    results.write_json(&path).unwrap();
    path
}

/// Exit code, standard output and standard error of `sightline compare`.
fn compare(files: &[&Path], more: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sightline"));
    let Output { status, stdout, stderr } = command.arg("compare").args(files).args(more).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}

#[test]
fn two_files_are_compared() {
    let Files { a, b } = files("two");
    let (code, out, _) = compare(&[&a, &b], &[]);
    assert_eq!(code, 0, "{out}");
    let row = |text: &str, label: &str| text.lines().find(|line| line.starts_with(label)).unwrap().to_owned();
    assert!(row(&out, "hzb").contains("2.000  2.000 to 2.000") && row(&out, "hzb").ends_with("slower"), "{out}");
    assert!(row(&out, "none").ends_with("no difference shown") && out.contains("0 → 2"), "{out}");
    assert!(!out.contains(STAGE), "{out}");
    let (code, out, _) = compare(&[&a, &b], &["--stages"]);
    assert_eq!(code, 0);
    let stages: Vec<&str> = out.lines().filter(|line| line.contains(STAGE)).collect();
    assert!(stages.len() == 2 && stages[1].ends_with("slower"), "{out}");
    // The other way round it is faster.
    let (_, out, _) = compare(&[&b, &a], &[]);
    assert!(row(&out, "hzb").ends_with("faster"), "{out}");
}

#[test]
fn a_failed_gate_ends_with_1_and_its_figure() {
    let Files { a, b } = files("gates");
    let holds = ["--fail-if", "any.ratio>2.1", "--fail-if", "none.false_negatives>0"];
    let (code, out, _) = compare(&[&a, &b], &holds);
    assert_eq!((code, out.matches("gate passed").count()), (0, 2), "{out}");
    let breaks = [&holds[..], &["--fail-if", "hzb.ratio>1.1", "--fail-if", "any.false_negatives_delta>0"]].concat();
    let (code, out, _) = compare(&[&a, &b], &breaks);
    assert_eq!((code, out.matches("gate FAILED").count(), out.matches("gate passed").count()), (1, 2, 2), "{out}");
    assert!(out.contains("gate FAILED: hzb.ratio>1.1: hzb has 2\n"), "{out}");
    assert!(out.contains("gate FAILED: any.false_negatives_delta>0: hzb has 2"), "{out}");
}

#[test]
fn one_file_alone_has_gates_of_its_own() {
    let Files { b, .. } = files("alone");
    assert_eq!(compare(&[&b], &["--fail-if", "none.false_negatives>0", "--fail-if", "any.psnr_worst_db<49"]).0, 0);
    let (code, out, _) = compare(&[&b], &["--fail-if", "any.false_negatives>0"]);
    assert!(code == 1 && out.contains("gate FAILED: any.false_negatives>0: hzb has 2"), "{out}");
    let (code, _, error) = compare(&[&b], &["--fail-if", "any.ratio>1"]);
    assert!(code == 2 && error.contains("needs two files"), "{error}");
    let (code, _, error) = compare(&[&b], &[]);
    assert!(code == 2 && error.contains("nothing to be compared with"), "{error}");
}

#[test]
fn an_error_ends_with_2_and_says_what_there_is() {
    let Files { a, b } = files("errors");
    let missing = a.with_file_name("missing.json");
    let broken = a.with_file_name("broken.json");
    std::fs::write(&broken, "{\"schema\": 1}").unwrap();
    let cases: [(&[&Path], &str, &str); 6] = [
        (&[&a, &missing], "any.ratio>1", "missing.json"),
        (&[&a, &broken], "any.ratio>1", "broken.json"),
        (&[&a, &b], "any.speed>1", "there is no field 'speed'; there are "),
        (&[&a, &b], "eovc.ratio>1", "no method 'eovc'; it has none, hzb"),
        (&[&a, &b], "any.ratio", "write METHOD.FIELD OP NUMBER"),
        (&[&a, &b, &a], "any.ratio>1", "unexpected"),
    ];
    for (files, gate, expected) in cases {
        let (code, _, error) = compare(files, &["--fail-if", gate]);
        assert!(code == 2 && error.contains(expected), "{code}: {error}");
    }
    assert_eq!(compare(&[], &[]).0, 2);
}

#[test]
fn other_runs_are_refused_unless_forced() {
    let Files { a, .. } = files("forced");
    let mut other = run(1.0);
    other.size = [640, 360];
    let other = written("forced", "other", &other);
    let (code, _, error) = compare(&[&a, &other], &[]);
    assert!(code == 2 && error.contains("size: 320x180 in A, 640x360 in B") && error.contains("--force"), "{error}");
    let (code, out, _) = compare(&[&a, &other], &["--force"]);
    assert!(code == 0 && out.contains("size: 320x180 in A, 640x360 in B"), "{out}");
}

#[test]
fn json_holds_the_comparison_and_the_gates() {
    let Files { a, b } = files("json");
    let json = |files: &[&Path], more: &[&str]| {
        let (code, out, _) = compare(files, &[&["--json"], more].concat());
        (code, serde_json::from_str::<serde_json::Value>(&out).unwrap())
    };
    let (code, both) =
        json(&[&a, &b], &["--fail-if", "hzb.ratio>1.1", "--stages", "--seed", "5", "--resamples", "100"]);
    assert_eq!((code, &both["gates"][0]["failed"]), (1, &true.into()));
    assert_eq!(both["gates"][0]["fails"], serde_json::json!([{"label": "hzb", "figure": 2.0}]));
    let comparison = &both["comparison"];
    assert_eq!(comparison["bootstrap"], serde_json::json!({"resamples": 100, "seed": 5}));
    let hzb = &comparison["methods"][1];
    assert_eq!(hzb["frame"]["ratio"]["verdict"], "slower");
    assert_eq!(hzb["stages"][0]["times"]["ratio"]["ratio"], 2.0);
    assert_eq!(hzb["fields"]["false_negatives"], serde_json::json!({"a": 0.0, "b": 2.0, "delta": 2.0}));
    let (code, alone) = json(&[&b], &["--fail-if", "none.false_negatives>0"]);
    assert!(code == 0 && alone["comparison"].is_null() && alone["a"].is_null() && alone["b"].is_string());
}
