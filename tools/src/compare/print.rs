//! A comparison on the terminal, 120 columns wide.

use super::{Change, Comparison, Outcome, Pair, Times, Verdict, FEWEST_FRAMES};
use crate::results::grid::{clipped, milliseconds, Grid};
use crate::results::{decibels, error, heading, percent, quantity, Results};
use std::path::Path;

/// A column of the second table: field, head, and how its numbers are written.
type Column = (&'static str, &'static str, fn(f64) -> String);

const COLUMNS: [Column; 6] = [
    ("false_negatives", "false neg.", |count| format!("{count:.0}")),
    ("object_error_percent", "obj. err. %", error),
    ("differing_pixels_mean", "diff px", error),
    ("psnr_worst_db", "PSNR", |db| decibels(Some(db).filter(|db| db.is_finite()))),
    ("drawn_mean", "drawn", quantity),
    ("culled_over_ref", "C/R %", percent),
];

/// One line: which file, which version wrote it, and by which command.
pub fn run_lines(name: &str, path: &Path, results: &Results) -> String {
    clipped(&format!("{name}: {} · version {} · {}", path.display(), results.sightline_version, results.command))
}

/// Both tables, and what is not in them. `b` is the run that they are headed by.
pub fn text(comparison: &Comparison, b: &Results) -> String {
    let mut lines = heading(b);
    lines.extend(comparison.differences.iter().map(|difference| format!("forced, though they differ: {difference}")));
    lines.extend(comparison.timers.clone());
    lines.push(String::new());
    lines.extend(times_table(comparison));
    lines.push(String::new());
    lines.extend(sureness(comparison, b));
    lines.push(String::new());
    lines.extend(errors_table(comparison));
    lines.push(String::new());
    lines.push(
        "C/R: culled / culled by ref · diff px: pixels of other depth, mean · PSNR: worst frame · A → B where they differ"
            .into(),
    );
    lines.extend(comparison.methods.iter().filter(|pair| !pair.other_options.is_empty()).map(options_line));
    for (file, labels) in [("A", &comparison.only_in_a), ("B", &comparison.only_in_b)] {
        if !labels.is_empty() {
            lines.push(format!("only in {file}: {}", labels.join(", ")));
        }
    }
    lines.iter().map(|line| format!("{line}\n")).collect()
}

fn options_line(pair: &Pair) -> String {
    format!("{}: runs at other settings: {}", pair.label, pair.other_options.join("; "))
}

fn times_table(comparison: &Comparison) -> Vec<String> {
    let mut heads = vec!["A ms", "B ms", "B/A", "95 % interval", "verdict"];
    if comparison.by.is_some() {
        heads.splice(2..2, ["A by", "B by"]);
    }
    let mut grid = Grid::new(heads, 0);
    for pair in &comparison.methods {
        grid.rows.push((pair.label.clone(), times_cells(&pair.frame, comparison.by.is_some())));
        for stage in &pair.stages {
            grid.rows.push((format!("  {}", stage.name), times_cells(&stage.times, comparison.by.is_some())));
        }
    }
    grid.fill_width();
    grid.lines("method")
}

fn times_cells(times: &Times, by: bool) -> Vec<String> {
    let ms = |ms: Option<f64>| ms.map_or("-".to_owned(), milliseconds);
    let (ratio, interval, verdict) = match (times.ratio, times.a_ms, times.b_ms) {
        (Some(found), ..) => {
            (number(found.ratio), format!("{} to {}", number(found.low), number(found.high)), found.verdict.words())
        }
        (None, None, Some(_)) => ("-".into(), "-".into(), "ran only in B"),
        (None, Some(_), None) => ("-".into(), "-".into(), "ran only in A"),
        (None, None, None) => ("-".into(), "-".into(), "ran in neither"),
        (None, Some(_), Some(_)) => ("-".into(), "-".into(), "A took no time"),
    };
    let share = |share: Option<f64>| share.map_or("-".to_owned(), number);
    let shares = [share(times.a_by), share(times.b_by)].into_iter().filter(|_| by);
    let times = [ms(times.a_ms), ms(times.b_ms)].into_iter().chain(shares);
    times.chain([ratio, interval, verdict.to_owned()]).collect()
}

fn number(ratio: f64) -> String {
    format!("{ratio:.3}")
}

/// What the intervals stand on, and what they cannot know.
fn sureness(comparison: &Comparison, b: &Results) -> Vec<String> {
    let drawn = if comparison.pairs { "in pairs, frame by frame" } else { "A and B apart" };
    let mut lines = vec![
        format!(
            "median frame times; 95 % interval: bootstrap over frames, {drawn} ({} resamples, seed {})",
            comparison.bootstrap.resamples, comparison.bootstrap.seed
        ),
        match &comparison.by {
            Some(by) => {
                format!("A by, B by: as multiples of {by} in the same run; B/A is of these, without the load of a whole run")
            }
            None => {
                "what held during the whole of one run, such as another load of the machine, is not in the interval"
                    .into()
            }
        },
    ];
    let frames = b.frames as usize;
    if frames < FEWEST_FRAMES {
        let few = format!("{frames} frames are too few to show a difference at 95 %: run {FEWEST_FRAMES} or more");
        lines.push(few);
    }
    if let Some(verdict) = common_verdict(comparison) {
        let verdict = verdict.words();
        lines.push(format!("every method is {verdict}: that may be the machine and not the program; run both again"));
    }
    lines
}

/// What all of several methods are, if it is not `no difference shown`.
fn common_verdict(comparison: &Comparison) -> Option<Verdict> {
    let mut verdicts = comparison.methods.iter().map(|pair| pair.frame.ratio.map(|ratio| ratio.verdict));
    let first = verdicts.next().flatten().filter(|verdict| *verdict != Verdict::NoDifferenceShown)?;
    (comparison.methods.len() > 1 && verdicts.all(|verdict| verdict == Some(first))).then_some(first)
}

fn errors_table(comparison: &Comparison) -> Vec<String> {
    let mut grid = Grid::new(COLUMNS.iter().map(|(_, head, _)| *head).collect(), 0);
    for pair in &comparison.methods {
        let cell = |(field, _, shown): &Column| pair.fields.get(*field).map_or("-".into(), |c| change(c, *shown));
        grid.rows.push((pair.label.clone(), COLUMNS.iter().map(cell).collect()));
    }
    grid.fill_width();
    grid.lines("method")
}

/// One number where both are equal. Two that would look equal, but are not, say their difference.
fn change(change: &Change, shown: fn(f64) -> String) -> String {
    let of = |value: Option<f64>| value.map_or("-".to_owned(), shown);
    let (a, b) = (of(change.a), of(change.b));
    if change.a == change.b {
        b
    } else if a == b {
        format!("{b} ({:+.0e})", change.delta.unwrap_or(0.0))
    } else {
        format!("{a} → {b}")
    }
}

/// One line a gate: how it went, and the figures, worst or not, of those that it was about.
pub fn gates_text(outcomes: &[Outcome]) -> String {
    outcomes.iter().map(|outcome| format!("{}\n", gate_line(outcome))).collect()
}

fn gate_line(outcome: &Outcome) -> String {
    let (head, figures) =
        if outcome.failed { ("gate FAILED", &outcome.fails) } else { ("gate passed", &outcome.passes) };
    let figures: Vec<String> = figures.iter().map(|found| format!("{} has {}", found.label, found.figure)).collect();
    let mut line = format!("{head}: {}: {}", outcome.gate, figures.join(", "));
    if !outcome.without.is_empty() {
        line += &format!(" (without this figure: {})", outcome.without.join(", "));
    }
    line
}
