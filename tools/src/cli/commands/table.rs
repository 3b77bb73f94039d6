//! `sightline bench --table`: a published table, or one of ours, on several scenes.

use super::{bench::Bar, say, typed};
use crate::cli::BenchArgs;
use crate::results::files::{check_file, check_folder, write_atomically};
use crate::results::{parts_table, stages_table, Results};
use crate::run::bench::{bench, header, make_folder, write, BenchOptions};
use crate::run::session::{cache_folder, Session, SessionOptions};
use crate::run::truth::RunTruth;
use crate::tables::warp_errors::{warp_errors, write_csv};
use crate::tables::{self, HiddenRuns, Plan, PlannedRun, Ran, Table};
use anyhow::{bail, Context, Result};
use culling::warp::Settings;
use engine::Gpu;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Runs the table's methods on each scene, writes each run's results and the table, and prints it.
pub fn run(arguments: &BenchArgs, id: &str) -> Result<()> {
    // All that can be wrong with the command line is found before anything slow is done.
    let table = tables::find(id)?;
    if arguments.no_metrics && table.needs_truth() {
        bail!("--no-metrics: table {id} shows what is culled or wrong, which needs the truth; leave --no-metrics out");
    }
    let plan = table.plan(&arguments.methods.sets())?;
    if arguments.samples.samples > 1 && plan.runs.iter().any(|run| !run.warps.is_empty()) {
        bail!(
            "--samples {}: table {id} warps depths of one sample a pixel; leave --samples out",
            arguments.samples.samples
        );
    }
    let sessions = sessions(table, arguments)?;
    check_places(table, &plan, &sessions, &arguments.out)?;
    let gpu = Gpu::open(&arguments.device.gpu())?;
    let mut scenes = Vec::new();
    let warmup = arguments.warmup(table.warmup());
    let (mut done, all) = (0, sessions.len() * plan.runs.len());
    // The first error of writing a file. The runs go on, and their table is printed.
    let mut written = Ok(());
    for (folder, session) in sessions {
        let mut runs = Vec::new();
        for planned in &plan.runs {
            let mut session = session.clone();
            planned.change.make(&mut session);
            done += 1;
            let ran =
                run_planned(&gpu, arguments, session, (table, planned), (&format!("run {done} of {all}"), warmup))?;
            written = written.and(save(&ran, &folder_of(&arguments.out, &folder, planned)));
            explain(arguments, &ran.results)?;
            runs.push(ran);
        }
        scenes.push(runs);
        // After each scene, so that what a long run has come to is there if it is stopped.
        written = written.and(write_text(table, &plan, &scenes, &arguments.out));
    }
    say(&tables::text(table, &plan, &scenes))?;
    written?;
    finish(table, &scenes, &arguments.out)
}

/// The folder of one run of a scene.
fn folder_of(out: &Path, scene: &str, planned: &PlannedRun) -> PathBuf {
    let folder = out.join(scene);
    planned.change.folder().map_or(folder.clone(), |below| folder.join(below))
}

/// Checks before the runs that their files can be written.
fn check_places(table: &Table, plan: &Plan, sessions: &[(String, SessionOptions)], out: &Path) -> Result<()> {
    make_folder(out)?;
    check_file(&text_file(table, out))?;
    for (scene, _) in sessions {
        for planned in &plan.runs {
            check_folder(&folder_of(out, scene, planned))?;
        }
    }
    Ok(())
}

fn run_planned(
    gpu: &Gpu,
    arguments: &BenchArgs,
    session: SessionOptions,
    (table, planned): (&Table, &PlannedRun),
    (place, warmup): (&str, usize),
) -> Result<Ran> {
    let name = format!("{place}: {}", session.scene.display());
    let mut session = Session::on(gpu, session)?;
    let command = typed();
    let bar = Bar::new(&session)?;
    let mut progress = |what: &str, done: usize, all: usize| bar.show(&format!("{name}: {what}"), done, all);
    let mut warps = BTreeMap::new();
    for options in &planned.warps {
        let (label, frames) = (options.label(), session.frames());
        let mut done = 0;
        let mut step = || {
            done += 1;
            progress(&label, done, frames - 1);
        };
        let errors = warp_errors(&mut session, Settings::of(options), &mut step)?;
        warps.insert(options.label(), errors);
    }
    let results = if planned.methods.is_empty() {
        header(&session, &command)
    } else {
        let options = BenchOptions {
            methods: planned.methods.clone(),
            warmup,
            metrics: !arguments.no_metrics,
            pairs: planned.pairs.clone(),
            capture: None,
            cache: cache_folder(),
            command,
        };
        bench(&mut session, options, &mut progress)?
    };
    let hidden = match table.needs_hidden_runs() {
        true => {
            let cache = cache_folder();
            let sets = RunTruth::visible_sets(&mut session, cache.as_deref(), || {})?;
            Some(HiddenRuns::of(&sets))
        }
        false => None,
    };
    bar.clear();
    Ok(Ran { results, warps, hidden })
}

/// Writes what there is: results of methods, errors of warps.
fn save(ran: &Ran, folder: &Path) -> Result<()> {
    if !ran.results.methods.is_empty() {
        write(&ran.results, folder)?;
    }
    if !ran.warps.is_empty() {
        make_folder(folder)?;
        write_csv(&ran.warps, &folder.join("warps.csv"))?;
    }
    Ok(())
}

fn explain(arguments: &BenchArgs, results: &Results) -> Result<()> {
    for method in results.methods.iter().filter(|_| arguments.explain) {
        say(&format!("{}: {}", results.scene.name, stages_table(results, method)))?;
        say(&parts_table(method))?;
    }
    Ok(())
}

fn write_text(table: &Table, plan: &Plan, scenes: &[Vec<Ran>], out: &Path) -> Result<()> {
    let text = tables::text(table, plan, scenes);
    Ok(write_atomically(&text_file(table, out), |to| to.write_all(text.as_bytes()))?)
}

fn text_file(table: &Table, out: &Path) -> PathBuf {
    out.join(format!("table-{}.txt", table.id))
}

fn finish(table: &Table, scenes: &[Vec<Ran>], out: &Path) -> Result<()> {
    let files = if scenes.iter().flatten().any(|ran| !ran.warps.is_empty()) {
        "each scene's warps.csv"
    } else {
        "each scene's results.json and results.csv"
    };
    say(&format!("{}, and {files}, are in {}", text_file(table, out).display(), out.display()))
}

/// Each scene's folder and session.
fn sessions(table: &Table, arguments: &BenchArgs) -> Result<Vec<(String, SessionOptions)>> {
    let choice = &arguments.scene;
    let scenes = match choice.scenes()? {
        named if named.is_empty() => table.scenes().into_iter().map(PathBuf::from).collect(),
        named => named,
    };
    let mut sessions: Vec<(String, SessionOptions)> = Vec::new();
    for scene in scenes {
        let shown = scene.display();
        let folder = folder(&scene).with_context(|| format!("--scene {shown}: not the name of a scene or file"))?;
        if let Some((_, other)) = sessions.iter().find(|(earlier, _)| *earlier == folder) {
            let other = other.scene.display();
            bail!("--scene: {shown} and {other} would both be written to the folder {folder}; run them apart");
        }
        let mut session = arguments.samples.of(choice.session_of(&scene));
        if session.path.is_none() {
            let (path, whole) = table.path();
            session.path = Some(path.into());
            session.whole_path |= whole;
        }
        sessions.push((folder, session));
    }
    Ok(sessions)
}

/// A scene's name, or its file's without folders and ending.
fn folder(scene: &Path) -> Option<String> {
    scene.file_stem().map(|stem| stem.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Cli, Command};
    use clap::Parser;

    fn arguments(line: &str) -> BenchArgs {
        match Cli::parse_from(["sightline", "bench"].into_iter().chain(line.split(' '))).command {
            Command::Bench(arguments) => arguments,
            other => panic!("{other:?}"),
        }
    }

    fn sessions(line: &str) -> Result<Vec<(String, SessionOptions)>> {
        let arguments = arguments(line);
        super::sessions(tables::find(arguments.table.as_deref().unwrap()).unwrap(), &arguments)
    }

    #[test]
    fn a_table_goes_its_papers_path_unless_told_otherwise() {
        let all = sessions("--table eovc-2").unwrap();
        let folders =
            |all: &[(String, SessionOptions)]| all.iter().map(|(folder, _)| folder.clone()).collect::<Vec<_>>();
        assert_eq!(folders(&all), ["fantasy", "factory", "radial-city", "satellite"]);
        assert_eq!(folders(&sessions("--table woc-3").unwrap()), ["city-block", "balloons", "powerplant", "monsters"]);
        assert_eq!(folders(&sessions("--table tog-2").unwrap()), ["monsters"], "of others nothing is published");
        assert!(all
            .iter()
            .all(|(_, session)| session.path.as_deref() == Some(Path::new("closing-in")) && session.whole_path));
        let warped = sessions("--table woc-1").unwrap();
        assert!(warped
            .iter()
            .all(|(_, session)| session.path.as_deref() == Some(Path::new("walk")) && !session.whole_path));
        assert!(sessions("--table woc-1 --whole-path").unwrap()[0].1.whole_path);
        let (folder, walk) = sessions("--table eovc-2 --scene a/model.glb --path walk").unwrap().remove(0);
        assert_eq!((folder.as_str(), walk.scene.as_path()), ("model", Path::new("a/model.glb")));
        assert_eq!((walk.path.as_deref(), walk.whole_path), (Some(Path::new("walk")), false));
    }

    #[test]
    fn two_scenes_of_one_folder_are_refused() {
        let error = sessions("--table eovc-2 --scene a/model.glb,b/model.glb").unwrap_err().to_string();
        assert!(error.contains("b/model.glb and a/model.glb") && error.contains("folder model"), "{error}");
    }

    #[test]
    fn a_table_of_culled_objects_needs_the_truth() {
        for id in ["eovc-5", "woc-1", "woc-3", "tog-2", "tog-7"] {
            let error = run(&arguments(&format!("--table {id} --no-metrics")), id).unwrap_err().to_string();
            assert!(error.contains(id) && error.contains("needs the truth"), "{error}");
        }
    }
}
