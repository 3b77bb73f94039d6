//! `--capture`: RenderDoc's captures replay without a window, and hold the stages that the results say ran, under their names.
//!
//! Needs RenderDoc and its Python module (`tools/setup.sh --captures`, which `tools/test.sh` runs).

mod display;

use display::Display;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const PROGRAM: &str = env!("CARGO_BIN_EXE_sightline");
const CHECK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/check_capture.py");
const SCENE: [&str; 8] = ["--scene", "city-block", "--scale", "0.02", "--size", "480x270", "--frames", "4"];

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("capture-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&[output.stdout.clone(), output.stderr.clone()].concat()).into_owned()
}

fn sightline(arguments: &[&str], folder: &Path) -> Output {
    let output = Command::new(PROGRAM).args(arguments).args(SCENE).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", text(&output));
    output
}

/// Debian's module belongs to Debian's interpreter; the message of the script says what is missing.
fn check(folder: &Path, arguments: &[&str]) -> Output {
    Command::new("/usr/bin/python3").arg(CHECK).args(arguments).current_dir(folder).output().unwrap()
}

#[test]
fn captures_hold_the_stages_that_explain_names() {
    let folder = folder("stages");
    let bench = ["bench", "--method", "eovc,woc,chc", "--capture", "2", "--no-metrics", "--no-report", "--validation"];
    sightline(&[&bench[..], &["--out", "."]].concat(), &folder);
    for (method, stages) in [
        ("eovc", ["eovc/cast_rays:query", "draw/objects_and_flags:occludees"]),
        ("woc", ["warp/search_depth", "farthest/test_bounds"]),
        ("chc", ["queries/test_nodes", "draw/objects"]),
    ] {
        let file = format!("{method}_capture.rdc");
        let arguments = [&file, "--results", "results.json", "--frame", "2", "--save", "."];
        let output = check(&folder, &arguments);
        assert!(output.status.success(), "{method}: {}", text(&output));
        let said = text(&output);
        assert!(stages.iter().all(|stage| said.contains(stage)), "{method}: {said}");
    }
    // What is drawn is in the pictures of the stages: more than the sky's one colour.
    let drawn = image::open(folder.join("woc.draw-objects.png")).unwrap();
    assert!(!drawn.color().has_alpha(), "the sky, whose alpha is 0, would be white in most viewers");
    let drawn = drawn.to_rgb8();
    let first = *drawn.get_pixel(0, 0);
    assert!(drawn.pixels().filter(|pixel| **pixel != first).count() > 10_000);

    // The check can fail: a stage that the results have and the capture lacks, and one that they lack.
    let results = std::fs::read_to_string(folder.join("results.json")).unwrap();
    std::fs::write(folder.join("planted.json"), results.replace("warp/search_depth", "warp/planted")).unwrap();
    let output = check(&folder, &["woc_capture.rdc", "--results", "planted.json", "--frame", "2"]);
    let said = text(&output);
    assert!(!output.status.success() && said.contains("stage warp/planted is missing"), "{said}");
    assert!(said.contains("stage warp/search_depth is in no row"), "{said}");
}

/// A cut leaves a method nothing but rays to begin with; four samples are resolved by stages of their own.
#[test]
fn captures_of_cuts_and_of_samples_hold_their_stages() {
    let folder = folder("cuts");
    for (method, arguments, file, stages) in [
        (
            "hzb-iterative",
            ["--path", "cuts"],
            "hzb-iterative_capture.rdc",
            ["seeds/mark_met", "hzb/test_objects:step 0"],
        ),
        (
            "hzb-iterative[rays=device]",
            ["--path", "cuts"],
            "hzb-iterative-rays-device-_capture.rdc",
            ["seeds/clear_grids", "seeds/cast_rays"],
        ),
        ("hzb", ["--samples", "4"], "hzb_capture.rdc", ["engine/resolve_depth", "target/resolve_colour"]),
    ] {
        let bench = ["bench", "--method", method, "--capture", "2", "--no-metrics", "--no-report", "--validation"];
        sightline(&[&bench[..], &arguments, &["--out", "."]].concat(), &folder);
        let output = check(&folder, &[file, "--results", "results.json", "--frame", "2"]);
        let said = text(&output);
        assert!(output.status.success() && stages.iter().all(|stage| said.contains(stage)), "{method}: {said}");
    }
}

/// Each error once ended in a trace of Python or LLVM's abort.
#[test]
fn what_cannot_be_checked_is_said_in_one_line() {
    let folder = folder("refused");
    std::fs::write(folder.join("junk.rdc"), "junk").unwrap();
    std::fs::write(folder.join("junk.json"), "{").unwrap();
    sightline(&["bench", "--method", "none", "--capture", "1", "--no-metrics", "--no-report", "--out", "."], &folder);
    let capture = "none_capture.rdc";
    for (arguments, expected) in [
        (&["absent.rdc"][..], "absent.rdc: there is no such file"),
        (&["junk.rdc"], "junk.rdc: cannot be opened"),
        (&[capture, "--results", "results.json"], "--results needs --frame"),
        (&[capture, "--results", "absent.json", "--frame", "1"], "--results absent.json: "),
        (&[capture, "--results", "junk.json", "--frame", "1"], "--results junk.json: "),
        (&[capture, "--results", "results.json", "--frame", "4"], "--frame 4: results.json has 4 frames"),
        (&[capture, "--buffer", "draw/objects=world.bounds:2x2"], "--buffer needs --save"),
        (&[capture, "--save", "junk.rdc"], "--save junk.rdc: File exists"),
        (&[capture, "--save", ".", "--buffer", "draw/objects=world.bounds:2"], "write STAGE=NAME:WIDTHxHEIGHT"),
        (
            &[capture, "--save", ".", "--buffer", "draw/nothing=world.bounds:2x2"],
            "the capture has no stage draw/nothing",
        ),
        (&[capture, "--save", ".", "--buffer", "draw/objects=absent:2x2"], "the capture has no buffer absent; it has "),
    ] {
        let output = check(&folder, arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.lines().count() == 1 && said.contains(expected), "{arguments:?}: {said}");
    }
}

#[test]
fn a_shot_is_captured_beside_its_picture() {
    let folder = folder("shot");
    sightline(&["shot", "--method", "hzb", "--frame", "3", "--capture", "2", "--out", "shot.png"], &folder);
    let output = check(&folder, &["hzb_capture.rdc"]);
    assert!(output.status.success() && text(&output).contains("hzb/test_bounds"), "{}", text(&output));
    let refused = Command::new(PROGRAM)
        .args(["shot", "--frame", "3", "--capture", "0", "--out", "shot.png"])
        .args(SCENE)
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(!refused.status.success());
    assert!(text(&refused).contains("--capture 0: of --frame 3 only frames 1 to 3 run"), "{}", text(&refused));
}

#[test]
fn a_frame_of_the_window_is_captured() {
    let folder = folder("view");
    let display = Display::open("640x360");
    let mut program = display.command(PROGRAM);
    program.args(["view", "--capture", "0", "--keys", "2", "--method", "frustum", "--out", "."]).args(SCENE);
    let output = program.current_dir(&folder).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    let output = check(&folder, &["view_capture.rdc"]);
    assert!(output.status.success() && text(&output).contains("frustum/test_bounds"), "{}", text(&output));
}
