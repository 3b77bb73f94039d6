//! `sightline bench --table`: a published table on several scenes.

use super::{bench::Bar, say};
use crate::bench::{bench, write, BenchOptions};
use crate::cli::BenchArgs;
use crate::files::write_atomically;
use crate::results::{parts_table, stages_table, Results};
use crate::session::{cache_folder, Session, SessionOptions};
use crate::tables::{self, Plan, Table};
use anyhow::{bail, Context, Result};
use engine::Gpu;
use std::path::Path;

/// The scenes of a table when none is named.
const SCENES: [&str; 2] = ["city-block", "rooms"];

/// The path of a table when none is named: from outside to among the objects, as in the papers' sequences.
const PATH: &str = "closing-in";

/// Runs the table's methods on each scene, writes each scene's results and the table, and prints it.
pub fn run(arguments: &BenchArgs, id: &str) -> Result<()> {
    // All that can be wrong with the command line is found before anything slow is done.
    let table = tables::find(id)?;
    if arguments.no_metrics && table.needs_truth() {
        bail!("--no-metrics: table {id} shows what is culled, which needs the truth; leave --no-metrics out");
    }
    let plan = table.plan(&arguments.methods.set)?;
    let sessions = sessions(arguments)?;
    let gpu = Gpu::open(&arguments.device.gpu())?;
    let mut runs = Vec::new();
    for (folder, session) in sessions {
        let results = run_scene(&gpu, arguments, session, &plan)?;
        write(&results, &arguments.out.join(folder))?;
        explain(arguments, &results)?;
        runs.push(results);
    }
    finish(table, &plan, &runs, &arguments.out)
}

fn run_scene(gpu: &Gpu, arguments: &BenchArgs, session: SessionOptions, plan: &Plan) -> Result<Results> {
    let name = session.scene.clone();
    let mut session = Session::on(gpu, session)?;
    let options = BenchOptions {
        methods: plan.methods.clone(),
        warmup: arguments.warmup as usize,
        metrics: !arguments.no_metrics,
        capture: None,
        cache: cache_folder(),
        command: std::env::args().collect::<Vec<_>>().join(" "),
    };
    let bar = Bar::new(&session)?;
    let mut progress = |what: &str, done: usize, all: usize| bar.show(&format!("{name}: {what}"), done, all);
    let results = bench(&mut session, options, &mut progress)?;
    bar.clear();
    Ok(results)
}

fn explain(arguments: &BenchArgs, results: &Results) -> Result<()> {
    for method in results.methods.iter().filter(|_| arguments.explain) {
        say(&format!("{}: {}", results.scene.name, stages_table(results, method)))?;
        say(&parts_table(method))?;
    }
    Ok(())
}

fn finish(table: &Table, plan: &Plan, runs: &[Results], out: &Path) -> Result<()> {
    let text = tables::text(table, plan, runs);
    let file = out.join(format!("table-{}.txt", table.id));
    write_atomically(&file, |to| to.write_all(text.as_bytes()))?;
    say(&text)?;
    say(&format!("{}, and each scene's results.json and results.csv, are in {}", file.display(), out.display()))
}

/// Each scene's folder and session.
fn sessions(arguments: &BenchArgs) -> Result<Vec<(String, SessionOptions)>> {
    let choice = &arguments.scene;
    let scenes: Vec<&str> = match choice.scene.as_slice() {
        [] => SCENES.to_vec(),
        named => named.iter().map(String::as_str).collect(),
    };
    let mut sessions: Vec<(String, SessionOptions)> = Vec::new();
    for scene in scenes {
        let folder = folder(scene).with_context(|| format!("--scene {scene}: not the name of a scene or file"))?;
        if let Some((_, other)) = sessions.iter().find(|(earlier, _)| *earlier == folder) {
            bail!("--scene: {scene} and {} would both be written to the folder {folder}; run them apart", other.scene);
        }
        let mut session = choice.session_of(scene);
        if session.path.is_none() {
            (session.path, session.whole_path) = (Some(PATH.to_owned()), true);
        }
        sessions.push((folder, session));
    }
    Ok(sessions)
}

/// A scene's name, or its file's without folders and ending.
fn folder(scene: &str) -> Option<String> {
    Path::new(scene).file_stem().map(|stem| stem.to_string_lossy().into_owned())
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

    #[test]
    fn a_table_goes_the_whole_closing_in_path_unless_told_otherwise() {
        let all = sessions(&arguments("--table eovc-2")).unwrap();
        assert_eq!(all.iter().map(|(folder, _)| folder.as_str()).collect::<Vec<_>>(), SCENES);
        assert!(all.iter().all(|(_, session)| session.path.as_deref() == Some(PATH) && session.whole_path));
        let (folder, walk) = sessions(&arguments("--table eovc-2 --scene a/model.glb --path walk")).unwrap().remove(0);
        assert_eq!((folder.as_str(), walk.scene.as_str()), ("model", "a/model.glb"));
        assert_eq!((walk.path.as_deref(), walk.whole_path), (Some("walk"), false));
    }

    #[test]
    fn two_scenes_of_one_folder_are_refused() {
        let error = sessions(&arguments("--table eovc-2 --scene a/model.glb,b/model.glb")).unwrap_err().to_string();
        assert!(error.contains("b/model.glb and a/model.glb") && error.contains("folder model"), "{error}");
    }

    #[test]
    fn a_table_of_culled_objects_needs_the_truth() {
        let error = run(&arguments("--table eovc-5 --no-metrics"), "eovc-5").unwrap_err().to_string();
        assert!(error.contains("needs the truth"), "{error}");
    }
}
