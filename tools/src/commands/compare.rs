//! `sightline compare`.

use super::say;
use crate::cli::CompareArgs;
use crate::compare::{compare, Comparison, Fact, Gate, Interval};
use crate::results::Results;
use anyhow::Result;

/// Some gates were true: not an error of the program, so it has its own exit code.
#[derive(Debug, thiserror::Error)]
#[error("{0} gates of --fail-if are true, see above")]
pub struct GatesTrue(usize);

/// Compares, prints, and fails if a gate is true.
pub fn run(arguments: &CompareArgs) -> Result<()> {
    let gates = arguments.fail_if.iter().map(|text| Gate::parse(text)).collect::<Result<Vec<_>>>()?;
    let results = arguments.files.iter().map(|file| Ok(Results::read_json(file)?)).collect::<Result<Vec<_>>>()?;
    let (a, b) = match results.as_slice() {
        [a, b] => (Some(a), b),
        files => (None, &files[0]),
    };
    let comparison = a.map(|a| compare(a, b, arguments.force)).transpose()?;
    match &comparison {
        Some(comparison) if arguments.json => say(&serde_json::to_string_pretty(comparison)?)?,
        Some(comparison) => say(&table(comparison, arguments.stages))?,
        None => {}
    }
    let mut facts = Vec::new();
    for gate in &gates {
        facts.extend(gate.broken(a, b, comparison.as_ref())?);
    }
    for Fact { gate, label, found } in &facts {
        eprintln!("gate '{gate}': {label} has {found}");
    }
    match facts.len() {
        0 => Ok(()),
        count => Err(GatesTrue(count).into()),
    }
}

fn table(comparison: &Comparison, stages: bool) -> String {
    let mut text = String::new();
    for what in &comparison.forced {
        text += &format!("compared by --force: {what}\n");
    }
    text += &format!(
        "{:<34} {:>24}  {:<20} {:>13} {:>19} {:>13}\n",
        "method", "time B/A (95 %)", "", "missed A B", "worst dB A B", "drawn A B"
    );
    let decibels = |db: Option<f64>| db.map_or("identical".to_owned(), |db| format!("{db:.1}"));
    for row in &comparison.rows {
        let pair = |values: [String; 2]| values.join(" ");
        text += &format!(
            "{:<34} {:>24}  {:<20} {:>13} {:>19} {:>13}\n",
            row.label,
            interval(&row.ratio),
            row.verdict,
            pair(row.false_negatives.map(|count| count.to_string())),
            pair(row.psnr_worst_db.map(decibels)),
            pair(row.drawn_mean.map(|mean| format!("{mean:.0}"))),
        );
        let of_row = row.stages.iter().filter(|_| stages);
        of_row.for_each(|(name, ratio)| text += &format!("  {name:<32} {:>24}\n", interval(ratio)));
    }
    for (file, labels) in [("A", &comparison.only_in_a), ("B", &comparison.only_in_b)] {
        if !labels.is_empty() {
            text += &format!("only in {file}: {}\n", labels.join(", "));
        }
    }
    text
}

fn interval(interval: &Interval) -> String {
    match *interval {
        Interval { ratio: Some(ratio), low: Some(low), high: Some(high) } => format!("{ratio:.3} ({low:.3}-{high:.3})"),
        _ => "-".to_owned(),
    }
}
