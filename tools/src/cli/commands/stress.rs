//! `sightline stress`.

use super::{say, say_json, warn};
use crate::cli::StressArgs;
use crate::results::files::check_folder;
use crate::run::methods::parse_methods;
use crate::stress::catalogue::{DrillId, CHANCE, FAMILIES};
use crate::stress::refusals::refusal_faults;
use crate::stress::run::Failure;
use crate::stress::{run as run_plan, save, shrink, Outcome, Plan, Subject};
use anyhow::{bail, Result};
use culling::{Guarantee, METHODS, PARTICULAR};
use engine::Gpu;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::fmt::Write;

/// Failures that are made small and saved; the others are only named. Each can take some hundred runs.
const SAVED_FAILURES: usize = 5;

/// Runs the catalogue, prints its table, and fails if a method did.
pub fn run(arguments: &StressArgs) -> Result<()> {
    let plan = plan(arguments)?;
    check_folder(&arguments.out)?;
    let gpu = Gpu::open(&arguments.device.gpu())?;
    let bar = ProgressBar::new(plan.drills.len() as u64);
    bar.set_style(ProgressStyle::with_template("{msg:28} {wide_bar} {pos}/{len} {eta}")?);
    let mut progress = |done, outcome: &Outcome| {
        bar.set_position(done as u64);
        let next = plan.drills.get(done).map(DrillId::to_string).unwrap_or_default();
        bar.set_message(format!("{next}, {} failed", outcome.failures.len()));
        Ok(())
    };
    // Its scenes are bad on purpose: warnings about them say nothing.
    let quiet = tracing::subscriber::NoSubscriber::default();
    let outcome = tracing::subscriber::with_default(quiet, || run_plan(&gpu, &plan, &mut progress))?;
    bar.finish_and_clear();
    let (refused, accepted) = refusal_faults();
    if arguments.json {
        say_json(&as_json(&plan, &outcome))?;
    } else {
        say(&table(&plan, &outcome))?;
        say(&format!(
            "{} of {refused} scenes without a meaning were refused by the name of their object",
            refused - accepted.len()
        ))?;
    }
    let mut wrong: Vec<String> = accepted.into_iter().map(|fault| format!("refusals: {fault}")).collect();
    wrong.extend(outcome.broken_bounds.iter().map(|fault| format!("bounds: {fault}")));
    for (index, failure) in outcome.failures.iter().enumerate() {
        wrong.push(told(arguments, &gpu, &plan, failure, index)?);
    }
    if !wrong.is_empty() {
        wrong.iter().for_each(|line| warn(line));
        bail!("{} failures, see above", wrong.len());
    }
    Ok(())
}

fn plan(arguments: &StressArgs) -> Result<Plan> {
    let exact = METHODS.iter().filter(|entry| entry.guarantee == Guarantee::Exact).map(|entry| entry.id);
    let methods = match arguments.method.as_str() {
        "all-exact" => exact.collect::<Vec<_>>().join(","),
        methods => methods.to_owned(),
    };
    if arguments.method == "all-exact" {
        let ids: Vec<_> = PARTICULAR.iter().map(|entry| entry.id).collect();
        warn(&format!("left out: {}: its worlds are no cities and have no cells", ids.join(", ")));
    }
    let subjects = parse_methods(&methods, &arguments.set)?;
    let subjects = subjects.into_iter().map(|(entry, options)| Subject { options, make: entry.make }).collect();
    let drills = match arguments.case.as_slice() {
        [] => all_drills(arguments.seed, arguments.seeds, arguments.cases),
        cases => cases.iter().map(|case| DrillId::parse(case)).collect::<Result<_>>()?,
    };
    if drills.is_empty() {
        bail!("--seeds 0 --cases 0 leaves nothing to run");
    }
    Ok(Plan { subjects, drills, bodies: arguments.bodies as usize, size: arguments.size, as_given: arguments.as_given })
}

/// So many drills of each family, and so many worlds by chance, from a first seed on.
pub fn all_drills(first: u64, seeds: u64, cases: u64) -> Vec<DrillId> {
    let of_family = |(family, entry): (usize, &crate::stress::catalogue::Family)| {
        let count = if entry.name == CHANCE { cases } else { seeds };
        (0..count).map(move |step| DrillId { family, seed: first.wrapping_add(step) })
    };
    FAMILIES.iter().enumerate().flat_map(of_family).collect()
}

/// A failure in words; made small and saved if asked to.
fn told(arguments: &StressArgs, gpu: &Gpu, plan: &Plan, failure: &Failure, index: usize) -> Result<String> {
    let Failure { subject, drill, faults } = failure;
    let size = arguments.size.map(|[width, height]| format!(" --size {width}x{height}")).unwrap_or_default();
    let mut text = format!(
        "{} in {drill}: {}\n  again: sightline stress --method '{}' --as-given --case {drill} --bodies {}{size}",
        subject.options.label(),
        faults.first().map_or("", String::as_str),
        subject.options.label(),
        plan.bodies,
    );
    if index < SAVED_FAILURES {
        let small = shrink::shrunk(gpu, subject, &plan.drill(*drill));
        // The settings are in drill.json: all of them would be too long for a file system.
        let name = format!("{index}-{}-{drill}", subject.options.method()).replace('/', "-");
        let folder = arguments.out.join("failures").join(name);
        let (objects, frames) = (small.case.scene.objects.len(), small.case.shots.len());
        // A full disk must not hide the other failures.
        match save::save(gpu, subject, &small, faults, &folder) {
            Ok(()) => write!(text, "\n  small: {objects} objects, {frames} frames, in {}", folder.display())?,
            Err(error) => write!(text, "\n  small: {objects} objects, {frames} frames, not saved: {error:#}")?,
        }
    }
    Ok(text)
}

fn table(plan: &Plan, outcome: &Outcome) -> String {
    let mut text = format!(
        "{:<17} {:<36} {:>5} {:>13} {:>5} {:>9} {:>9} {:>5} {:>9} {:>12} {:>9}\n",
        "family",
        "rule",
        "runs",
        "object-frames",
        "lost",
        "differing",
        "ties",
        "thin",
        "spare px",
        "spare depths",
        "fewest px"
    );
    for (family, row) in FAMILIES.iter().zip(&outcome.families).filter(|(_, row)| row.tally.runs > 0) {
        let spare_px = row.margin.spare_px;
        let spare_px = if spare_px.is_finite() { format!("{spare_px:.5}") } else { "-".into() };
        let or_none = |value: Option<String>| value.unwrap_or_else(|| "-".into());
        text += &format!(
            "{:<17} {:<36} {:>5} {:>13} {:>5} {:>9} {:>9} {:>5} {:>9} {:>12} {:>9}\n",
            family.name,
            family.rule,
            row.tally.runs,
            row.tally.object_frames,
            row.tally.lost,
            row.tally.differing,
            row.tally.ties,
            row.tally.thin,
            spare_px,
            or_none(row.margin.spare_depths.map(|spare| spare.to_string())),
            or_none(row.fewest_pixels.map(|pixels| pixels.to_string())),
        );
    }
    text += &format!(
        "\n{:<54} {:>5} {:>13} {:>5} {:>9} {:>9} {:>5}\n",
        "method", "runs", "object-frames", "lost", "differing", "ties", "thin"
    );
    for (subject, tally) in plan.subjects.iter().zip(&outcome.methods) {
        text += &format!(
            "{:<54} {:>5} {:>13} {:>5} {:>9} {:>9} {:>5}\n",
            subject.options.label(),
            tally.runs,
            tally.object_frames,
            tally.lost,
            tally.differing,
            tally.ties,
            tally.thin
        );
    }
    text
}

fn as_json(plan: &Plan, outcome: &Outcome) -> serde_json::Value {
    let families = FAMILIES.iter().zip(&outcome.families).filter(|(_, row)| row.tally.runs > 0).map(|(family, row)| {
        json!({
            "family": family.name, "rule": family.rule, "runs": row.tally.runs, "object_frames": row.tally.object_frames,
            "lost": row.tally.lost, "differing_pixels": row.tally.differing, "tied_pixels": row.tally.ties, "thin_pixels": row.tally.thin,
            "spare_px": row.margin.spare_px.is_finite().then_some(row.margin.spare_px),
            "spare_depths": row.margin.spare_depths, "fewest_pixels": row.fewest_pixels,
        })
    });
    let methods = plan.subjects.iter().zip(&outcome.methods).map(|(subject, tally)| {
        json!({
            "label": subject.options.label(), "runs": tally.runs, "object_frames": tally.object_frames, "lost": tally.lost,
            "differing_pixels": tally.differing, "tied_pixels": tally.ties, "thin_pixels": tally.thin,
        })
    });
    let failures = outcome.failures.iter().map(|failure| {
        json!({"method": failure.subject.options.label(), "case": failure.drill.to_string(), "faults": failure.faults})
    });
    json!({
        "families": families.collect::<Vec<_>>(), "methods": methods.collect::<Vec<_>>(),
        "failures": failures.collect::<Vec<_>>(), "broken_bounds": outcome.broken_bounds,
    })
}
