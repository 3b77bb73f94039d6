//! `sightline bench` and `sightline report` as they are typed: which files they leave, what is in them, and what they say where a
//! file cannot be written. Run on a device with validation.

use clap::Parser;
use sightline::cli::Cli;
use sightline::results::Results;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder of its own for each test, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("sightline-report-{test}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn names(&self) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(&self.0).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn sightline(arguments: &str, paths: &[&Path]) -> Result<(), String> {
    let words = ["sightline"].into_iter().chain(arguments.split_whitespace()).map(PathBuf::from);
    let typed = words.chain(paths.iter().map(|path| path.to_path_buf()));
    // As `main` prints it.
    sightline::cli::commands::run(Cli::parse_from(typed)).map_err(|error| format!("{error:#}"))
}

/// Few small frames, with a method that errs: `woc` without its care, at a speed at which it does.
fn bench(flags: &str, out: &Path) -> Result<(), String> {
    let run = "bench --validation --scene city-block --scale 0.05 --frames 4 --speed 16 --size 320x180 --warmup 1";
    let methods = "--method none,frustum,woc[size=1,erode=none,rapid=0,seeds=4],ref";
    sightline(&format!("{run} {methods} {flags} --out"), &[out])
}

#[test]
fn a_bench_leaves_a_report_with_pictures_and_a_trace() {
    let folder = Folder::new("whole");
    bench("", &folder.0).unwrap();
    assert_eq!(folder.names(), ["report.html", "results.csv", "results.json", "trace.json"]);
    let results = Results::read_json(&folder.0.join("results.json")).unwrap();
    let woc = results.methods.iter().find(|method| method.method == "woc").unwrap();
    assert!(woc.psnr_worst_db.is_some(), "woc made no error, so this proves nothing: go faster");
    assert_eq!(results.scene.hash.len(), 64);
    let report = folder.read("report.html");
    let faulty = results.methods.iter().filter(|method| method.psnr_worst_db.is_some()).count();
    assert_eq!(report.matches("data:image/png;base64,").count(), 3 * faulty + 2 * results.methods.len());
    assert!(results.methods.iter().all(|method| report.contains(&method.label)));
    // The worst frame in the report is that of the results.
    let worst = woc.frames.psnr_db.iter().position(|psnr| *psnr == woc.psnr_worst_db).unwrap();
    assert!(report.contains(&format!("{}, frame {worst}<", woc.label)));
    let trace = folder.read("trace.json");
    assert_eq!(trace.matches("\"cat\":\"frame\"").count(), 4 * results.methods.len());
    assert!(trace.matches("\"cat\":\"stage\"").count() >= 4 * 2 * results.methods.len());
}

#[test]
fn a_report_is_left_out_or_made_of_times_alone_if_asked() {
    let folder = Folder::new("less");
    bench("--no-report", &folder.0).unwrap();
    assert_eq!(folder.names(), ["results.csv", "results.json", "trace.json"]);
    bench("--no-metrics", &folder.0).unwrap();
    let report = folder.read("report.html");
    assert!(report.contains("Errors were not measured") && !report.contains("data:image"));
}

#[test]
fn a_report_is_made_of_results_beside_them_or_where_asked() {
    let folder = Folder::new("again");
    bench("--no-report", &folder.0).unwrap();
    let results = folder.0.join("results.json");
    sightline("report", &[&results]).unwrap();
    assert!(folder.read("results.html").contains("There are no pictures"));
    sightline("report", &[&results, Path::new("--out"), &folder.0.join("other.html")]).unwrap();
    assert_eq!(folder.read("other.html"), folder.read("results.html"));
    let error = sightline("report", &[&folder.0.join("no.json")]).unwrap_err();
    assert!(error.contains("no.json: cannot read it") && !error.contains('\n'), "{error}");
    assert_eq!(error.matches("(os error").count(), 1, "the system's words, once: {error}");
}

#[test]
fn what_cannot_be_written_is_named_and_the_results_stay_whole() {
    // A folder of that name, with something in it, cannot be replaced by a file, whoever runs the test.
    for blocked in ["report.html", "trace.json"] {
        let folder = Folder::new(blocked);
        fs::create_dir(folder.0.join(blocked)).unwrap();
        fs::write(folder.0.join(blocked).join("kept"), "").unwrap();
        let error = bench("", &folder.0).unwrap_err();
        assert!(error.contains(&format!("{blocked}: cannot write it")) && !error.contains('\n'), "{error}");
        assert_eq!(Results::read_json(&folder.0.join("results.json")).unwrap().methods.len(), 4);
        let other = if blocked == "report.html" { "trace.json" } else { "report.html" };
        assert!(folder.0.join(other).is_file(), "{other} was not tried");
        assert!(folder.names().iter().all(|name| !name.ends_with(".tmp")), "{:?}", folder.names());
    }
    let folder = Folder::new("file-as-folder");
    let out = folder.0.join("taken");
    fs::write(&out, "").unwrap();
    // Found before the scene is opened, which would be slow, and here could not be.
    let error = sightline("bench --scene no-such-scene --out", &[&out]).unwrap_err();
    assert!(error.contains("taken: cannot make this folder; choose another with --out"), "{error}");
}
