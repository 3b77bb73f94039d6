//! `sightline report`.

use super::say;
use crate::cli::ReportArgs;
use crate::report;
use crate::results::Results;
use anyhow::Result;

/// Reads results and writes their report. Its default name is not report.html, so that it does not replace one with pictures.
pub fn run(arguments: &ReportArgs) -> Result<()> {
    let results = Results::read_json(&arguments.results)?;
    let file = arguments.out.clone().unwrap_or_else(|| arguments.results.with_extension("html"));
    report::write(&results, None, &file)?;
    say(&format!("{} holds plots and tables; open it in a browser", file.display()))
}
