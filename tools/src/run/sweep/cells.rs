//! Cells: what is run at once, and kept.

use crate::results::Results;
use crate::run::bench::{bench, header, BenchOptions};
use crate::run::session::Session;
use anyhow::{Context, Result};
use culling::{Entry, Options};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Settings in a cell, beside the baseline: few, so that little is lost, and enough that the baseline costs little.
const CELL: usize = 4;

type Setting = (&'static Entry, Options);

/// What to sweep, and where finished cells are.
pub struct SweepPlan {
    /// Methods that run once as they are; the first cell.
    pub base: Vec<Setting>,
    /// What every cell has too, if anything.
    pub baseline: Option<Setting>,
    /// The grid.
    pub settings: Vec<Setting>,
    /// Frames run before the clock starts.
    pub warmup: usize,
    /// Measure errors.
    pub metrics: bool,
    /// What was typed.
    pub command: String,
    /// The folder of cells.
    pub folder: PathBuf,
    /// Run cells again that are there.
    pub fresh: bool,
}

/// How many cells were there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// Read from disk.
    pub kept: usize,
    /// All.
    pub all: usize,
}

impl SweepPlan {
    /// The settings of each cell, the baseline first.
    fn cells(&self) -> Vec<Vec<Setting>> {
        let is_baseline =
            |setting: &Setting| self.baseline.as_ref().is_some_and(|own| own.1.label() == setting.1.label());
        let with_baseline = |settings: Vec<Setting>| self.baseline.iter().cloned().chain(settings).collect::<Vec<_>>();
        let base: Vec<Setting> = self.base.iter().filter(|setting| !is_baseline(setting)).cloned().collect();
        let labels: Vec<String> = self.base.iter().map(|(_, options)| options.label()).collect();
        let new = |setting: &&Setting| !labels.contains(&setting.1.label());
        let grid: Vec<Setting> = self.settings.iter().filter(new).cloned().collect();
        let first = (!base.is_empty()).then(|| with_baseline(base));
        first.into_iter().chain(grid.chunks(CELL).map(|cell| with_baseline(cell.to_vec()))).collect()
    }
}

/// Runs the cells that are not there, keeps each as it is finished, and joins all. `progress` is told the cell, of how many, and what
/// goes on in it.
///
/// # Errors
/// The device, a file that cannot be written, or a cell that cannot be read: names it and the remedy. What is finished stays.
pub fn run(
    session: &mut Session,
    plan: &SweepPlan,
    progress: &mut dyn FnMut(usize, usize, &str) -> Result<()>,
) -> Result<(Results, Kept)> {
    std::fs::create_dir_all(&plan.folder)
        .with_context(|| format!("{}: cannot make this folder", plan.folder.display()))?;
    let cells = plan.cells();
    let all = cells.len();
    let mut kept = 0;
    let mut joined: Option<Results> = None;
    for (index, cell) in cells.into_iter().enumerate() {
        let file = plan.folder.join(format!("{}.json", key(session, plan, &cell)?));
        let found = if plan.fresh { None } else { read(&file)? };
        let results = match found {
            Some(results) => {
                kept += 1;
                results
            }
            None => {
                progress(index, all, "starts")?;
                let results = finished(session, plan, cell, &mut |what| progress(index, all, what))?;
                // A full disk must not end the sweep: its table is still printed.
                if let Err(error) = results.write_json(&file) {
                    tracing::warn!("{error}; this cell will be run again");
                }
                results
            }
        };
        join(&mut joined, results);
    }
    let results = joined.context("--sweep leaves nothing to run")?;
    Ok((Results { command: plan.command.clone(), ..results }, Kept { kept, all }))
}

fn read(file: &Path) -> Result<Option<Results>> {
    if !file.exists() {
        return Ok(None);
    }
    let results = Results::read_json(file).context("a finished cell cannot be read: delete it, or run with --fresh")?;
    Ok(Some(results))
}

fn finished(
    session: &mut Session,
    plan: &SweepPlan,
    methods: Vec<Setting>,
    progress: &mut dyn FnMut(&str) -> Result<()>,
) -> Result<Results> {
    let options = BenchOptions {
        methods,
        warmup: plan.warmup,
        metrics: plan.metrics,
        pairs: Vec::new(),
        capture: None,
        cache: crate::run::session::cache_folder(),
        command: plan.command.clone(),
    };
    let mut stopped = Ok(());
    let mut results = bench(session, options, &mut |what, _, _| {
        if stopped.is_ok() {
            stopped = progress(what);
        }
    })?;
    stopped?;
    set_ratios(&mut results);
    Ok(results)
}

/// Measures the methods of a cell by its own `ref`, if that ran.
fn set_ratios(cell: &mut Results) {
    let ideal = cell.methods.iter().find(|method| method.method == "ref").map(|method| method.frame_ms.median);
    for method in &mut cell.methods {
        method.ratio_to_ref = ideal.filter(|ideal| *ideal > 0.0).map(|ideal| method.frame_ms.median / ideal);
    }
}

/// Everything on which a cell's numbers depend. Nothing that is measured at start, as that could differ the next time.
fn key(session: &Session, plan: &SweepPlan, cell: &[Setting]) -> Result<String> {
    key_of(&header(session, ""), plan, cell)
}

/// The key of a cell of a run with this header.
fn key_of(header: &Results, plan: &SweepPlan, cell: &[Setting]) -> Result<String> {
    let what = serde_json::to_string(header)?;
    let labels: Vec<String> = cell.iter().map(|(_, options)| options.label()).collect();
    let text = format!("{what}\n{}\n{}\n{}", labels.join("\n"), plan.warmup, plan.metrics);
    let digest = Sha256::digest(text.as_bytes());
    Ok(digest.iter().take(12).map(|byte| format!("{byte:02x}")).collect())
}

/// Adds the methods of a cell that are not there yet: of the baseline, the first cell's.
fn join(joined: &mut Option<Results>, cell: Results) {
    match joined {
        None => *joined = Some(cell),
        Some(joined) => {
            let new: Vec<_> =
                cell.methods.into_iter().filter(|method| joined.method(&method.label).is_none()).collect();
            joined.methods.extend(new);
        }
    }
}

#[cfg(test)]
mod tests;
