//! `sightline bench`.

use super::{say, say_json, typed, warn};
use crate::cli::BenchArgs;
use crate::report::{self, Gallery};
use crate::results::output::one_line;
use crate::results::trace;
use crate::results::{flares_table, parts_table, stages_table, table, Results};
use crate::run::bench::{bench_watched, ready, write, BenchOptions, Seen};
use crate::run::capture::CaptureOrder;
use crate::run::methods::{parse_methods, particular_methods, Chosen};
use crate::run::session::{cache_folder, Session};
use anyhow::{bail, Context, Result};
use indicatif::{ProgressBar, ProgressStyle};

/// Runs the benchmark, writes its files and prints its table.
pub fn run(arguments: &BenchArgs) -> Result<()> {
    // All that can be wrong with the command line is found before anything slow is done.
    let mut methods = parse_methods(&arguments.methods.method, &arguments.methods.sets())?;
    let options = arguments.flares.of(arguments.samples.of(arguments.scene.session()?));
    ready(&arguments.out)?;
    let capture = capture(arguments)?;
    let mut session = Session::open(&arguments.device.gpu(), options)?;
    if arguments.methods.method == "all" {
        let (taken, left_out) = particular_methods(&session.scene, &arguments.methods.sets())?;
        methods.extend(taken);
        let refused = without_refusing(&mut methods, &session);
        left_out.iter().chain(&refused).for_each(|line| warn(line));
    }
    let bar = Bar::new(&session)?;
    let options = BenchOptions {
        methods,
        warmup: arguments.warmup(None),
        metrics: !arguments.no_metrics,
        pairs: Vec::new(),
        capture,
        cache: cache_folder(),
        command: typed(),
    };
    let mut gallery = gallery(arguments, &options, &session);
    let mut watch = |seen: Seen<'_>| match &mut gallery {
        Some(gallery) => gallery.look(&seen).context("packing a picture for the report"),
        None => Ok(()),
    };
    let mut progress = |what: &str, done: usize, all: usize| bar.show(what, done, all);
    let results = bench_watched(&mut session, options, &mut progress, &mut watch)?;
    bar.clear();
    // Results are printed even if they cannot be written, for example to a disk that is full by now.
    let written = write(&results, &arguments.out);
    let written = written.and(write_views(arguments, &results, gallery.as_ref()));
    let printed = print(arguments, &results, written.is_ok());
    written.and(printed)
}

/// Takes those away that need one sample a pixel where there are several; a line for each.
fn without_refusing(methods: &mut Chosen, session: &Session) -> Vec<String> {
    let mut left_out = Vec::new();
    if session.targets.samples() > 1 {
        methods.retain(|(entry, options)| {
            match entry.needs_one_sample(&session.world, options, session.targets.stray_px()) {
                None => true,
                Some(why) => {
                    left_out.push(format!("left out: method '{}' needs one sample a pixel: {why}", entry.id));
                    false
                }
            }
        });
    }
    left_out
}

/// Where the report's pictures are collected, if there will be any.
fn gallery(arguments: &BenchArgs, options: &BenchOptions, session: &Session) -> Option<Gallery> {
    let methods = || options.methods.iter().map(|(entry, settings)| (settings.label(), entry.id));
    (options.metrics && !arguments.no_report).then(|| Gallery::new(session.frames(), methods()))
}

/// Writes trace.json and report.html, which show what results.json holds. Each is tried, and the first error told.
fn write_views(arguments: &BenchArgs, results: &Results, gallery: Option<&Gallery>) -> Result<()> {
    let trace = trace::write(results, &arguments.out.join("trace.json"));
    if !arguments.no_report {
        let report = report::write(results, gallery, &arguments.out.join("report.html"));
        trace?;
        return report;
    }
    Ok(trace?)
}

fn print(arguments: &BenchArgs, results: &Results, written: bool) -> Result<()> {
    if arguments.json {
        return say_json(results);
    }
    say(&table(results))?;
    match flares_table(results) {
        flares if flares.is_empty() => {}
        flares => say(&flares)?,
    }
    if arguments.explain {
        for method in &results.methods {
            say(&stages_table(results, method))?;
            say(&parts_table(method))?;
            method.choices.iter().try_for_each(|choice| say(choice))?;
        }
    }
    if !written {
        return Ok(());
    }
    let report = if arguments.no_report { "" } else { ", report.html" };
    say(&format!("results.json, results.csv, trace.json{report}: in {}", arguments.out.display()))
}

fn capture(arguments: &BenchArgs) -> Result<Option<CaptureOrder>> {
    let Some(frame) = arguments.capture else { return Ok(None) };
    if frame >= arguments.scene.frames as usize {
        bail!("--capture {frame}: the run has only {} frames, counted from 0", arguments.scene.frames);
    }
    Ok(Some(CaptureOrder::new(frame, &arguments.out)?))
}

/// A progress bar on the terminal.
pub(super) struct Bar(ProgressBar);

impl Bar {
    /// A bar for a session's frames.
    pub(super) fn new(session: &Session) -> Result<Self> {
        let style = ProgressStyle::with_template("{msg:18} {wide_bar} {pos}/{len} {eta}")?;
        Ok(Bar(ProgressBar::new(session.frames() as u64).with_style(style)))
    }

    /// Shows what is done, how many steps of it, and of how many.
    pub(super) fn show(&self, what: &str, done: usize, all: usize) {
        self.0.set_length(all as u64);
        self.0.set_position(done as u64);
        self.0.set_message(one_line(what).into_owned());
    }

    /// Takes the bar away.
    pub(super) fn clear(&self) {
        self.0.finish_and_clear();
    }
}
