//! `--capture`: RenderDoc's captures replay without a window, and hold the stages that the results say ran, under their names.
//!
//! Needs RenderDoc and its Python module (`tools/setup.sh --captures`, which `tools/test.sh` runs).

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
    let bench = ["bench", "--method", "eovc,woc", "--capture", "2", "--no-metrics", "--no-report", "--validation"];
    sightline(&[&bench[..], &["--out", "."]].concat(), &folder);
    for (method, stages) in [
        ("eovc", ["eovc/cast_rays:query", "draw/objects_and_flags:occludees"]),
        ("woc", ["warp/search_depth", "farthest/test_bounds"]),
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
    let output = Command::new("xvfb-run")
        .args([
            "--auto-servernum",
            "--server-args=-screen 0 640x360x24",
            PROGRAM,
            "view",
            "--capture",
            "0",
            "--keys",
            "2",
        ])
        .args(["--method", "frustum", "--out", "."])
        .args(SCENE)
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output));
    let output = check(&folder, &["view_capture.rdc"]);
    assert!(output.status.success() && text(&output).contains("frustum/test_bounds"), "{}", text(&output));
}
