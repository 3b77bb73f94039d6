//! Two runs side by side, A before and B after a change: is B faster, and is that more than noise? What became of the
//! errors? And [`Gate`]s, which say what must not be.

mod bootstrap;
mod differences;
mod fields;
mod gate;
mod print;
#[cfg(test)]
mod tests;

pub use bootstrap::{ratio, ratio_by, Bootstrap, Ratio, Side, Verdict, FEWEST_FRAMES};
pub use differences::{differences, other_timers, Difference};
pub use gate::{Figure, Gate, Outcome};
pub use print::{gates_text, run_lines, text};

use crate::measures::stats;
use crate::results::{Method, Results};
use anyhow::{bail, Result};
use serde::Serialize;
use std::collections::BTreeMap;

/// What to compare, and how.
#[derive(Clone, Copy, Debug)]
pub struct CompareOptions<'a> {
    /// Compare runs that differ in more than the program.
    pub force: bool,
    /// Also compare each stage.
    pub stages: bool,
    /// How the intervals are made.
    pub bootstrap: Bootstrap,
    /// Times are taken as multiples of those of the method with this label, in each run its own.
    pub by: Option<&'a str>,
}

/// What two files say together. Serialized, infinities are `null`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// What differs between the runs and should not; only with `force`.
    pub differences: Vec<Difference>,
    /// The timers of both runs; none if they are the same.
    pub timers: Option<String>,
    /// Whether times were resampled in pairs, frame by frame: frame i shows the same in both runs.
    pub pairs: bool,
    /// How the intervals were made.
    pub bootstrap: Bootstrap,
    /// The method that times were measured by.
    pub by: Option<String>,
    /// The methods of both files, in B's order.
    pub methods: Vec<Pair>,
    /// Labels that only A has.
    pub only_in_a: Vec<String>,
    /// Labels that only B has.
    pub only_in_b: Vec<String>,
}

/// One label of both files.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// The label.
    pub label: String,
    /// Options that stand at other values, one sentence each: a default that changed.
    pub other_options: Vec<String>,
    /// Frame times.
    pub frame: Times,
    /// By name, every number of the method's row but those of single stages.
    pub fields: BTreeMap<String, Change>,
    /// Stages in the order of B's frame, then those that only A has. Empty unless asked for.
    pub stages: Vec<StagePair>,
}

/// A stage of a method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StagePair {
    /// Its name.
    pub name: String,
    /// Its times in the frames in which it ran.
    pub times: Times,
}

/// Times of both runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Times {
    /// Median of A in milliseconds; `None`: it did not run there.
    pub a_ms: Option<f64>,
    /// Median of B in milliseconds; `None`: it did not run there.
    pub b_ms: Option<f64>,
    /// A's median over that of the method that times are measured by; `None` if they are not.
    pub a_by: Option<f64>,
    /// The same of B.
    pub b_by: Option<f64>,
    /// B over A, as multiples of what they are measured by; `None` where one of them did not run or A took no time.
    pub ratio: Option<Ratio>,
}

/// A number of both runs. `None`: not measured. Infinite: the PSNR of identical pictures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// A's.
    pub a: Option<f64>,
    /// B's.
    pub b: Option<f64>,
    /// B's less A's; `None` if one of them was not measured.
    pub delta: Option<f64>,
}

/// Compares the methods that both runs have.
///
/// # Errors
/// Runs that differ in more than the program, each difference by name, unless forced; no label in common.
pub fn compare(a: &Results, b: &Results, options: CompareOptions<'_>) -> Result<Comparison> {
    let differences = differences(a, b);
    if !differences.is_empty() && !options.force {
        let named: Vec<String> = differences.iter().map(Difference::to_string).collect();
        bail!("the runs differ in more than the program: {}; --force compares them all the same", named.join("; "));
    }
    let by = [by(a, "A", options)?, by(b, "B", options)?];
    let pairs = !differences.iter().any(|difference| difference.other_frames);
    let both = b.methods.iter().filter_map(|of_b| a.method(&of_b.label).map(|of_a| (of_a, of_b)));
    let methods = both.map(|(a, b)| pair([a, b], by, pairs, options)).collect::<Result<Vec<_>>>()?;
    if methods.is_empty() {
        bail!("no method is in both files: A has {}, B has {}", labels(a).join(", "), labels(b).join(", "));
    }
    let only = |of: &Results, other: &Results| {
        labels(of).into_iter().filter(|label| other.method(label).is_none()).map(str::to_owned).collect()
    };
    Ok(Comparison {
        differences,
        timers: other_timers(a, b),
        pairs,
        bootstrap: options.bootstrap,
        by: options.by.map(str::to_owned),
        methods,
        only_in_a: only(a, b),
        only_in_b: only(b, a),
    })
}

/// Frame times of what a run is measured by.
fn by<'a>(run: &'a Results, name: &str, options: CompareOptions<'_>) -> Result<Option<&'a [f64]>> {
    let Some(label) = options.by else { return Ok(None) };
    let Some(method) = run.method(label) else {
        bail!("--by {label}: {name} has no method of that label; it has {}", labels(run).join(", "));
    };
    let times = &method.frames.frame_ms;
    if stats::median(times).is_none_or(|median| median <= 0.0) {
        bail!("--by {label}: {name} has no times of it; run `bench` again");
    }
    Ok(Some(times))
}

fn labels(results: &Results) -> Vec<&str> {
    results.methods.iter().map(|method| method.label.as_str()).collect()
}

fn pair([a, b]: [&Method; 2], by: By<'_>, pairs: bool, options: CompareOptions<'_>) -> Result<Pair> {
    let times = [a, b].map(|method| method.frames.frame_ms.iter().map(|ms| Some(*ms)).collect::<Vec<_>>());
    let stages = if options.stages { stages([a, b], by, pairs, options.bootstrap) } else { Vec::new() };
    Ok(Pair {
        label: b.label.clone(),
        other_options: differences::other_options(a, b),
        frame: compare_times([&times[0], &times[1]], by, pairs, options.bootstrap),
        fields: changes(a, b)?,
        stages,
    })
}

/// What A and B are measured by.
type By<'a> = [Option<&'a [f64]>; 2];

/// Frames in which something did not run have no time. Only where it ran in the same frames of both are there pairs.
fn compare_times([a, b]: [&[Option<f64>]; 2], by: By<'_>, pairs: bool, bootstrap: Bootstrap) -> Times {
    let same_frames = a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.is_some() == b.is_some());
    let [a, b] = [a, b].map(|times| times.iter().copied().flatten().collect::<Vec<f64>>());
    let (side_a, side_b) = (Side { times: &a, by: by[0] }, Side { times: &b, by: by[1] });
    Times {
        a_ms: stats::median(&a),
        b_ms: stats::median(&b),
        a_by: side_a.by.and_then(|_| side_a.median()),
        b_by: side_b.by.and_then(|_| side_b.median()),
        ratio: ratio_by(side_a, side_b, pairs && same_frames, bootstrap),
    }
}

fn stages([a, b]: [&Method; 2], by: By<'_>, pairs: bool, bootstrap: Bootstrap) -> Vec<StagePair> {
    let of_b = b.stages.iter().map(|stage| &stage.name);
    let only_a = a.stages.iter().map(|stage| &stage.name).filter(|name| !b.stages.iter().any(|s| s.name == **name));
    let times = |method: &Method, name: &str| method.frames.stages.get(name).cloned().unwrap_or_default();
    let row = |name: &String| StagePair {
        name: name.clone(),
        times: compare_times([&times(a, name), &times(b, name)], by, pairs, bootstrap),
    };
    of_b.chain(only_a).map(row).collect()
}

fn changes(a: &Method, b: &Method) -> Result<BTreeMap<String, Change>> {
    let (a, b) = (fields::fields(a)?, fields::fields(b)?);
    let names = a.keys().chain(b.keys()).filter(|name| !name.starts_with("stages."));
    let change = |name: &String| {
        let [a, b] = [&a, &b].map(|fields| fields.get(name).copied().flatten());
        (name.clone(), Change { a, b, delta: a.zip(b).map(|(a, b)| fields::delta(a, b)) })
    };
    Ok(names.map(change).collect())
}
