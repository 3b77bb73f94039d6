//! `sightline bench --sweep`.

use super::{say, say_json, typed};
use crate::cli::BenchArgs;
use crate::measures::pareto;
use crate::report;
use crate::results::files::check_folder;
use crate::results::trace;
use crate::results::{table, Results};
use crate::run::bench::{ready, write};
use crate::run::methods::{parse_methods, parse_setting};
use crate::run::session::Session;
use crate::run::sweep::{run as run_cells, Kept, Sweep, SweepPlan};
use anyhow::{Context, Result};
use culling::{Entry, Options};
use indicatif::{ProgressBar, ProgressStyle};

/// Runs the sweep, writes what `bench` writes, and prints the front of time against error.
pub fn run(arguments: &BenchArgs) -> Result<()> {
    let plan = plan(arguments)?;
    let options = arguments.samples.of(arguments.scene.session()?);
    ready(&arguments.out)?;
    check_folder(&plan.folder)?;
    let mut session = Session::open(&arguments.device.gpu(), options)?;
    let bar = ProgressBar::new(1);
    bar.set_style(ProgressStyle::with_template("cell {pos} of {len}  {msg:18} {wide_bar} {eta} left")?);
    let (results, kept) = run_cells(&mut session, &plan, &mut |cell, all, what| {
        bar.set_length(all as u64);
        bar.set_position(cell as u64);
        bar.set_message(what.to_owned());
        Ok(())
    })?;
    bar.finish_and_clear();
    let written = write(&results, &arguments.out);
    let trace = trace::write(&results, &arguments.out.join("trace.json"));
    let report =
        if arguments.no_report { Ok(()) } else { report::write(&results, None, &arguments.out.join("report.html")) };
    let written = written.and(trace.map_err(Into::into)).and(report);
    // Results are printed even if they cannot be written, for example to a disk that is full by now.
    let printed = print(arguments, &results, kept, written.is_ok());
    written.and(printed)
}

fn print(arguments: &BenchArgs, results: &Results, kept: Kept, written: bool) -> Result<()> {
    if arguments.json {
        return say_json(results);
    }
    say(&table(results))?;
    say(&front(results))?;
    let place = match written {
        true => format!("; all results are in {}", arguments.out.display()),
        false => String::new(),
    };
    say(&format!("{} of {} cells were there already{place}", kept.kept, kept.all))
}

fn plan(arguments: &BenchArgs) -> Result<SweepPlan> {
    let methods = if arguments.methods.method == "all" { "ref" } else { &arguments.methods.method };
    let sets = &arguments.methods.sets();
    let base = parse_methods(methods, sets)?;
    // An empty text is parsed as one word, so that it is refused.
    let words = |text: &'_ String| match text.trim().is_empty() {
        true => vec![text.trim().to_owned()],
        false => text.split_whitespace().map(str::to_owned).collect(),
    };
    let sweeps = arguments.sweeps.sweep.iter().flat_map(words);
    let sweeps = sweeps.map(|text| Sweep::parse(&text)).collect::<Result<Vec<_>>>()?;
    let settings = Sweep::settings(&sweeps, &|entry| with_sets(entry, sets))?;
    let baseline =
        ["ref", "frustum", "none"].iter().find_map(|id| base.iter().find(|(entry, _)| entry.id == *id).cloned());
    Ok(SweepPlan {
        base,
        baseline,
        settings,
        warmup: arguments.warmup(None),
        metrics: !arguments.no_metrics,
        command: typed(),
        folder: arguments.out.join("cells"),
        fresh: arguments.sweeps.fresh,
    })
}

/// What `--set` gives a method.
fn with_sets(entry: &Entry, sets: &[String]) -> Result<Options> {
    let mut options = entry.default_options();
    for set in sets {
        let (method, option, value) = parse_setting(set)?;
        if method == entry.id {
            options.set(option, value).with_context(|| format!("--set {set}"))?;
        }
    }
    Ok(options)
}

/// The settings that none beats in both time and error, in words; `ref` is what all are measured by, and stands apart.
fn front(results: &Results) -> String {
    let methods: Vec<_> = results.methods.iter().filter(|method| method.method != "ref").collect();
    let time = |method: &crate::results::Method| method.ratio_to_ref.unwrap_or(method.frame_ms.median);
    let points: Vec<(f64, f64)> = methods.iter().map(|method| (time(method), method.object_error_percent)).collect();
    let unit = if methods.iter().any(|method| method.ratio_to_ref.is_some()) { "x ref" } else { "ms" };
    let mut text = "No setting is both faster and better than these:".to_owned();
    for index in pareto::front(&points) {
        text += &format!(
            "\n  {:>8.3} {unit}  {:>8.4} % missed  {}",
            points[index].0, points[index].1, methods[index].label
        );
    }
    text
}
