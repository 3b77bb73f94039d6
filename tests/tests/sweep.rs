//! Sweeps are kept cell by cell: what is finished is never run again, and never mixed up.

use anyhow::bail;
use harness::gpu;
use sightline::run::session::{Session, SessionOptions};
use sightline::run::sweep::{run, Kept, Sweep, SweepPlan};
use std::path::{Path, PathBuf};

fn plan(folder: &Path) -> SweepPlan {
    let reference = culling::find("ref").unwrap();
    let ideal = (reference, reference.default_options());
    let sweeps = [Sweep::parse("woc.size=1,2,4").unwrap(), Sweep::parse("woc.seeds=1..2").unwrap()];
    SweepPlan {
        base: vec![ideal.clone()],
        baseline: Some(ideal),
        settings: Sweep::settings(&sweeps, &|entry| Ok(entry.default_options())).unwrap(),
        warmup: 1,
        metrics: true,
        command: "a test".into(),
        folder: folder.to_path_buf(),
        fresh: false,
    }
}

fn session(gpu: &engine::Gpu, frames: usize) -> Session {
    let options =
        SessionOptions { scene: "rooms".into(), scale: 0.05, frames, size: [96, 64], ..SessionOptions::default() };
    Session::on(gpu, options).unwrap()
}

fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = entries.map(|path| (path.clone(), std::fs::read(path).unwrap())).collect();
    files.sort();
    files
}

#[test]
fn an_interrupted_sweep_goes_on_where_it_was() {
    let gpu = gpu();
    let folder = std::env::temp_dir().join(format!("sightline-sweep-{}", std::process::id()));
    let mut session_of_three = session(&gpu, 3);
    let stopped = run(&mut session_of_three, &plan(&folder), &mut |cell, _, _| match cell {
        0 => Ok(()),
        _ => bail!("interrupted"),
    });
    assert_eq!(stopped.unwrap_err().to_string(), "interrupted");
    let first = files(&folder);
    assert_eq!(first.len(), 1, "one cell was finished");

    let (results, kept) = run(&mut session_of_three, &plan(&folder), &mut |_, _, _| Ok(())).unwrap();
    assert_eq!(kept, Kept { kept: 1, all: 2 });
    assert!(files(&folder).contains(&first[0]), "the finished cell is not touched");
    let labels: Vec<&str> = results.methods.iter().map(|method| method.label.as_str()).collect();
    assert_eq!(labels.len(), 7, "{labels:?}");
    assert_eq!(labels.iter().filter(|label| **label == "ref").count(), 1);
    assert!(results.methods.iter().all(|method| method.ratio_to_ref.is_some_and(|ratio| ratio > 0.0)));
    assert_eq!(results.methods[0].ratio_to_ref, Some(1.0));

    let (_, kept) = run(&mut session_of_three, &plan(&folder), &mut |_, _, _| bail!("nothing is left to run")).unwrap();
    assert_eq!(kept, Kept { kept: 2, all: 2 });
    let (_, kept) = run(&mut session(&gpu, 2), &plan(&folder), &mut |_, _, _| Ok(())).unwrap();
    assert_eq!(kept, Kept { kept: 0, all: 2 }, "other frames are other cells");

    std::fs::write(&first[0].0, "{").unwrap();
    let refusal = format!("{:#}", run(&mut session_of_three, &plan(&folder), &mut |_, _, _| Ok(())).unwrap_err());
    let name = first[0].0.file_name().unwrap().to_string_lossy().into_owned();
    assert!(refusal.contains("--fresh") && refusal.contains(&name), "{refusal}");
    let fresh = SweepPlan { fresh: true, ..plan(&folder) };
    assert_eq!(run(&mut session_of_three, &fresh, &mut |_, _, _| Ok(())).unwrap().1, Kept { kept: 0, all: 2 });
    std::fs::remove_dir_all(&folder).unwrap();
}
