//! What each part of a method's frame costs: the breakdown of the EOVC thesis' figure 16, from the stages' names.

use super::Method;
use crate::measures::stats;
use crate::results::grid::{milliseconds, Grid};

/// Stages that a method puts in no part: clearing the target, moving objects.
const NO_PART: &str = "no part";

/// What of the frame no stage accounts for: submitting, and waiting for read-backs in the middle of the frame.
const BETWEEN: &str = "between stages";

/// One row per part of the frame, in the order of the frame: mean milliseconds, and the share of the mean frame time. A
/// stage's part is what its name has behind the colon. Empty if the method has no parts.
pub fn parts_table(method: &Method) -> String {
    let parts = parts(method);
    let frame_ms = stats::mean(method.frames.staged_ms()).unwrap_or(0.0);
    if parts.iter().all(|(name, _)| *name == NO_PART) || frame_ms <= 0.0 {
        return String::new();
    }
    // Two timestamps may round to more than the time around them: nothing is left over then, not less than nothing.
    let between = (frame_ms - parts.iter().map(|(_, ms)| ms).sum::<f64>()).max(0.0);
    let mut grid = Grid::new(vec!["mean ms", "of frame"], 34);
    for (name, ms) in parts.into_iter().chain([(BETWEEN, between)]) {
        grid.rows.push((name.to_owned(), vec![milliseconds(ms), format!("{:.1} %", 100.0 * ms / frame_ms)]));
    }
    grid.lines("part").iter().map(|line| format!("{line}\n")).collect()
}

/// Name and mean milliseconds of each part, over all frames: a stage that did not run in one took no time there.
fn parts(method: &Method) -> Vec<(&str, f64)> {
    let frames = method.frames.staged_ms().len().max(1) as f64;
    let mut parts: Vec<(&str, f64)> = Vec::new();
    for stage in &method.stages {
        let name = stage.name.split_once(':').map_or(NO_PART, |(_, part)| part);
        let of_stage = method.frames.stages.get(&stage.name).into_iter().flatten().flatten();
        let ms = of_stage.sum::<f64>() / frames;
        match parts.iter_mut().find(|(part, _)| *part == name) {
            Some((_, sum)) => *sum += ms,
            None => parts.push((name, ms)),
        }
    }
    parts
}
