//! Command lines that tripped the program: it did something else, panicked, or was silent.
#![cfg(unix)]

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A small picture, quickly.
const SMALL: [&str; 6] = ["--scene", "boxes", "--scale", "0.05", "--size", "64x36"];
const BENCH: [&str; 7] = ["--frames", "1", "--warmup", "0", "--method", "none", "--no-report"];

/// A folder of its own for each test, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("sightline-odd-{test}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn file(&self, name: impl AsRef<Path>, text: &str) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, text).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn program(words: &[&dyn AsRef<OsStr>]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sightline"));
    command.args(words.iter().map(|word| word.as_ref().to_owned()));
    command
}

fn sightline(words: &[&dyn AsRef<OsStr>]) -> Output {
    program(words).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Appends words to a command line.
fn with<'a>(words: &[&'a dyn AsRef<OsStr>], more: &'a [&'a str]) -> Vec<&'a dyn AsRef<OsStr>> {
    words.iter().copied().chain(more.iter().map(|word| word as &dyn AsRef<OsStr>)).collect()
}

/// A name that is not UTF-8.
fn bad(ending: &str) -> OsString {
    OsStr::from_bytes(&[b"bad\xff", ending.as_bytes()].concat()).to_owned()
}

#[test]
fn names_of_files_need_not_be_text() {
    let folder = Folder::new("names");
    let at = |ending: &str| folder.0.join(bad(ending));
    let ok = |output: Output| assert!(output.status.success(), "{}", said(&output));
    let glb = at(".glb");
    ok(sightline(&with(&[&"scene", &"export", &"--out", &glb], &SMALL)));
    ok(sightline(&[&"scene", &"show", &"--scene", &glb]));
    let picture = at(".png");
    ok(sightline(&[&"shot", &"--scene", &glb, &"--size", &"64x36", &"--out", &picture]));
    let out = at("");
    ok(sightline(&with(&with(&[&"bench", &"--out", &out], &SMALL), &BENCH)));
    let flags = at(".toml");
    std::fs::write(&flags, "[shot]\nsize = '8x8'").unwrap();
    ok(sightline(&[&"shot", &"--config", &flags, &"--scene", &glb, &"--out", &picture]));
    ok(sightline(&[&"report", &out.join("results.json")]));
    let (a, b) = (out.join("results.json"), out.join("results.json"));
    ok(sightline(&[&"compare", &a, &b, &"--json"]));
    for file in [glb, picture, out.join("results.html"), out.join("trace.json")] {
        assert!(file.is_file(), "{}", file.display());
    }
}

#[test]
fn what_is_no_file_and_no_text_is_refused_and_named() {
    let bad = bad("");
    for words in [
        vec!["bench", "--sweep"],
        vec!["bench", "--method"],
        vec!["bench", "--set"],
        vec!["shot", "--device"],
        vec!["stress", "--case"],
        vec!["compare", "a.json", "--by"],
        vec!["view", "--keys"],
        vec!["man"],
    ] {
        let output = program(&[]).args(&words).arg(&bad).output().unwrap();
        let error = said(&output);
        assert_eq!(output.status.code(), Some(2), "{words:?}: {error}");
        assert!(error.contains("bad\u{fffd}") && error.lines().count() == 1, "{words:?}: {error}");
        assert!(error.contains("not UTF-8"), "{words:?}: {error}");
    }
    for words in
        [vec!["shot", "--scene"], vec!["shot", "--config"], vec!["report"], vec!["compare", "--fail-if=any.x>1"]]
    {
        let output = program(&[]).args(&words).arg(&bad).output().unwrap();
        let error = said(&output);
        assert!(!output.status.success() && !error.contains("panicked"), "{words:?}: {error}");
        assert!(error.contains("bad\u{fffd}") && error.lines().count() == 1, "{words:?}: {error}");
    }
}

#[test]
fn devices_pipes_and_links_stay_what_they_are() {
    let folder = Folder::new("devices");
    let link = folder.0.join("link.png");
    std::os::unix::fs::symlink("real.png", &link).unwrap();
    let shot = sightline(&with(&[&"shot", &"--out", &link], &SMALL));
    assert!(shot.status.success(), "{}", said(&shot));
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    let written = std::fs::read(folder.0.join("real.png")).unwrap();
    assert!(written.starts_with(b"\x89PNG"));

    let null = sightline(&with(&[&"shot", &"--out", &"/dev/null"], &SMALL));
    assert!(null.status.success(), "{}", said(&null));
    assert!(std::fs::metadata("/dev/null").unwrap().file_type().is_char_device());

    let pipe = folder.0.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = Command::new("cat").arg(&pipe).stdout(Stdio::piped()).spawn().unwrap();
    let shot = sightline(&with(&[&"shot", &"--out", &pipe], &SMALL));
    assert!(shot.status.success(), "{}", said(&shot));
    assert_eq!(reader.wait_with_output().unwrap().stdout, written, "what the file holds");
    assert!(std::fs::metadata(&pipe).unwrap().file_type().is_fifo());
}

/// The error came after the whole run.
#[test]
fn a_place_that_cannot_be_written_is_known_before_the_run() {
    let folder = Folder::new("places");
    let file = folder.file("file", "kept");
    let taken = folder.0.join("taken");
    std::fs::create_dir_all(taken.join("results.json")).unwrap();
    // A run of this size would take hours.
    let long = ["--scale", "0.05", "--size", "2048x2048", "--frames", "100000"];
    let cases: [(Vec<&dyn AsRef<OsStr>>, &str); 8] = [
        (vec![&"bench", &"--out", &file], "file is not a folder"),
        (vec![&"bench", &"--out", &"/dev/null"], "/dev/null is not a folder"),
        (vec![&"bench", &"--out", &taken], "results.json: cannot write it: it is a folder"),
        (vec![&"bench", &"--table", &"eovc-2", &"--out", &file], "file is not a folder"),
        (
            vec![&"bench", &"--sweep", &"woc.size=1,2", &"--out", &taken],
            "results.json: cannot write it: it is a folder",
        ),
        (vec![&"shot", &"--out", &taken], "taken: cannot write it: it is a folder"),
        (vec![&"scene", &"export", &"--out", &taken], "taken: cannot write it: it is a folder"),
        (vec![&"view", &"--screenshot", &taken], "taken: cannot write it: it is a folder"),
    ];
    for (words, expected) in cases {
        let output = sightline(&with(&words, &long));
        let error = said(&output);
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(error.contains(expected) && error.lines().count() == 1, "{error}");
    }
    assert_eq!(std::fs::read(&file).unwrap(), b"kept");
}

/// Results were lost with their files.
#[test]
fn a_disk_that_fills_up_loses_the_files_and_not_the_table() {
    if !Path::new("/dev/full").exists() {
        return;
    }
    let folder = Folder::new("full");
    std::os::unix::fs::symlink("/dev/full", folder.0.join("results.json")).unwrap();
    let ran = sightline(&with(&with(&[&"bench", &"--out", &folder.0], &SMALL), &BENCH));
    let (table, error) = (String::from_utf8_lossy(&ran.stdout).into_owned(), said(&ran));
    assert_eq!(ran.status.code(), Some(1), "{error}");
    assert!(table.contains("\nnone ") && !table.contains("results.json"), "{table}");
    assert!(error.contains("results.json: cannot write it: No space left") && error.lines().count() == 1, "{error}");
    assert!(folder.0.join("results.csv").is_file(), "others are tried all the same");
    let swept = ["--sweep", "hzb.texels=2,4"];
    let ran = sightline(&with(&with(&with(&[&"bench", &"--out", &folder.0], &SMALL), &BENCH), &swept));
    assert_eq!(ran.status.code(), Some(1), "{}", said(&ran));
    assert!(String::from_utf8_lossy(&ran.stdout).contains("hzb[texels=2]"), "{}", said(&ran));
}

#[test]
fn a_full_output_is_named_and_a_closed_one_is_no_error() {
    for words in [["scene", "list"], ["man", "bench"], ["completions", "bash"], ["bench", "--help"]] {
        if let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") {
            let output = program(&[]).args(words).stdout(full).output().unwrap();
            let error = said(&output);
            assert_eq!(output.status.code(), Some(1), "{words:?}: {error}");
            assert!(error.starts_with("sightline: standard output: cannot write to it: No space left"), "{error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
        let mut child = program(&[]).args(words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{words:?}: {}", said(&output));
    }
    // A full standard error cannot be reported anywhere: no panic either.
    if let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") {
        let output = program(&[&"shot", &"--scene", &"nope"]).stderr(full).status().unwrap();
        assert_eq!(output.code(), Some(1));
    }
}

/// The picture was black, without a message.
#[test]
fn a_file_that_shows_nothing_says_why() {
    let folder = Folder::new("empty");
    let asset = r#""asset":{"version":"2.0"}"#;
    let triangle = r#""meshes":[{"primitives":[{"attributes":{}}]}]"#;
    for (name, json, why) in [
        ("no-scene.gltf", format!("{{{asset}}}"), "it has no scene"),
        ("no-node.gltf", format!("{{{asset},\"scenes\":[{{}}],\"scene\":0}}"), "it has no mesh"),
        (
            "unused.gltf",
            format!("{{{asset},{triangle},\"nodes\":[{{}}],\"scenes\":[{{\"nodes\":[0]}}]}}"),
            "has a mesh",
        ),
    ] {
        let file = folder.file(name, &json);
        let picture = folder.0.join("picture.png");
        let output = sightline(&[&"shot", &"--scene", &file, &"--size", &"16x16", &"--out", &picture]);
        let error = said(&output);
        assert!(error.contains(name) && error.contains(why), "{name}: {error}");
    }
}

#[test]
fn values_without_a_sense_are_refused_in_one_line() {
    let folder = Folder::new("values");
    let far = r#"{"schema":1,"frames":[{"position":[1e300,0,0],"rotation":[0,0,0,1],"fov_y_deg":60,"near":0.1}]}"#;
    let far = folder.file("far.json", far);
    let far = far.to_str().unwrap();
    let late = r#"{"schema":1,"frames":[{"position":[0,0,0],"rotation":[0,0,0,1],"fov_y_deg":60,"near":0.1,"seconds":1e308}]}"#;
    let late = folder.file("late.json", late);
    let late = late.to_str().unwrap();
    for (words, expected) in [
        (vec!["shot", "--speed", "1e308"], "there is no camera speed '1e308'"),
        (vec!["shot", "--speed", "inf"], "there is no camera speed 'inf'"),
        (vec!["shot", "--scale", "1e300"], "there is no scene scale '1e300'"),
        (vec!["shot", "--scene", ","], "names no scene"),
        (vec!["shot", "--device", ""], "no Vulkan device matches ''"),
        (vec!["shot", "--path", far], "far.json: frame 0: `position` is more than 1e12 m"),
        (vec!["shot", "--path", late], "late.json: frame 0: `seconds` must be between"),
        (vec!["bench", "--sweep", ""], "write METHOD.OPTION=VALUE"),
        (vec!["bench", "--sweep", "woc.size=1,2", " "], "write METHOD.OPTION=VALUE"),
        (vec!["view", "--keys", ","], "names no step"),
    ] {
        let output = program(&[]).args(&words).output().unwrap();
        let error = said(&output);
        assert_eq!(output.status.code(), Some(1), "{words:?}: {error}");
        assert!(error.contains(expected) && error.lines().count() == 1, "{words:?}: {error}");
    }
    for (words, flag) in [
        (vec!["shot", "--scene", ""], "--scene"),
        (vec!["shot", "--path", ""], "--path"),
        (vec!["bench", "--warmup", "4294967295"], "--warmup"),
        (vec!["bench", "--out", ""], "--out"),
        (vec!["shot", "--config", ""], "--config"),
    ] {
        let output = program(&[]).args(&words).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{words:?}: {}", said(&output));
        assert!(said(&output).contains(flag), "{words:?}: {}", said(&output));
    }
}

/// The sum of seed and count overflowed, which panicked.
#[test]
fn the_last_seeds_run() {
    let last = u64::MAX.to_string();
    let folder = Folder::new("seeds");
    let small = ["--method", "none", "--bodies", "2", "--size", "16x16"];
    let ran = sightline(&with(
        &[&"stress", &"--seed", &last, &"--seeds", &"0", &"--cases", &"2", &"--out", &folder.0],
        &small,
    ));
    assert!(ran.status.success(), "{}", said(&ran));
    let case = format!("near-plane/{last}");
    let ran = sightline(&with(&[&"stress", &"--case", &case, &"--out", &folder.0], &small));
    assert!(ran.status.success(), "{}", said(&ran));
}

#[test]
fn files_that_are_no_results_are_refused_in_plain_words() {
    let folder = Folder::new("results");
    for (text, expected) in [
        ("null", "the file: holds null, but results are an object"),
        ("[]", "the file: holds a list, but results are an object"),
        ("3", "the file: holds a number, but results are an object"),
        ("", "the file: holds nothing, but results are an object"),
        ("{", "the JSON ends too early"),
        ("oops", "is not JSON"),
        ("{\"schema\": \"x\"}", "schema: invalid type: string \"x\", expected a whole number of 0 or more"),
        ("{\"schema\": 1, \"sightline_version\": null}", "expected a text"),
    ] {
        let file = folder.file("it.json", text);
        for (words, code) in [(vec!["report"], 1), (vec!["compare", "--fail-if=any.ssim_mean<1"], 2)] {
            let output = program(&[]).args(&words).arg(&file).output().unwrap();
            let error = said(&output);
            assert_eq!(output.status.code(), Some(code), "{text}: {error}");
            assert!(error.contains("it.json") && error.contains(expected), "{text}: {error}");
            assert!(!error.contains("struct") && error.lines().count() == 1, "{text}: {error}");
        }
    }
}

/// A terminal obeyed control characters of a file.
#[test]
fn control_characters_of_files_do_not_reach_the_terminal() {
    let folder = Folder::new("escapes");
    let ran = sightline(&with(&with(&[&"bench", &"--out", &folder.0], &SMALL), &BENCH));
    assert!(ran.status.success(), "{}", said(&ran));
    let text = std::fs::read_to_string(folder.0.join("results.json")).unwrap();
    let evil = r"\u001b[31m\u0007\u009b2J\nfake";
    let raw = "\u{9b}\u{7f}\u{202e}";
    let mut results: serde_json::Value = serde_json::from_str(&text).unwrap();
    let word: String = serde_json::from_str(&format!("\"{evil}{raw}\"")).unwrap();
    for place in
        ["/device/name", "/device/driver", "/scene/name", "/path", "/command", "/methods/0/label", "/methods/0/method"]
    {
        *results.pointer_mut(place).unwrap() = word.clone().into();
    }
    results["methods"][0]["stages"][0]["name"] = word.clone().into();
    let stages = results["methods"][0]["frames"]["stages"].as_object_mut().unwrap();
    stages.clear();
    stages.insert(word.clone(), serde_json::json!([1.0]));
    let file = folder.file("evil.json", &results.to_string());
    let mut other = results.clone();
    other["device"]["driver"] = format!("{word}2").into();
    let other = folder.file("other.json", &other.to_string());
    let obeyed = |bytes: &[u8]| {
        let text = String::from_utf8(bytes.to_vec()).unwrap();
        text.chars().any(|letter| letter != '\n' && (letter.is_control() || letter == '\u{202e}'))
            || text.contains("\nfake")
    };
    let shots: [Vec<&dyn AsRef<OsStr>>; 6] = [
        vec![&"compare", &file, &file, &"--stages"],
        vec![&"compare", &file, &file, &"--json"],
        vec![&"compare", &file, &other],
        vec![&"compare", &file, &other, &"--force"],
        vec![&"compare", &file, &"--fail-if", &"any.ssim_mean<1"],
        vec![&"compare", &file, &"--fail-if", &"nope.ssim_mean<1"],
    ];
    for words in shots {
        let output = sightline(&words);
        let all = [&output.stdout[..], &output.stderr].concat();
        assert!(!obeyed(&all), "{}", String::from_utf8_lossy(&all).escape_debug());
        assert!(String::from_utf8_lossy(&all).contains("31m"), "{}", String::from_utf8_lossy(&all));
    }
    // A broken file, a file of flags, and a scene's name.
    let broken = folder.file("broken.json", "{\"\u{1b}[31m\": ");
    let flags = folder.file("flags.toml", "[shot]\nmethod = \"\\u001b[31m\"\n\"\\u001b[31m\" = 1\n");
    let gltf =
        folder.file("\u{1b}[31m.gltf", r#"{"asset":{"version":"2.0"},"nodes":[{"name":"\u001b[31m","camera":7}]}"#);
    let shots: [Vec<&dyn AsRef<OsStr>>; 4] = [
        vec![&"report", &broken],
        vec![&"shot", &"--config", &flags],
        vec![&"scene", &"show", &"--scene", &gltf],
        vec![&"shot", &"--scene", &gltf, &"--size", &"8x8", &"--out", &"/dev/null"],
    ];
    for words in shots {
        let output = sightline(&words);
        assert!(!obeyed(&[&output.stdout[..], &output.stderr].concat()), "{}", said(&output).escape_debug());
    }
}
