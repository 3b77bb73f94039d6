//! What each method's frame is spent on, stage by stage (Kim's thesis, figure 9; EOVC thesis, figure 16).

use super::bars::{bars, Bars, Part, RowData};
use super::plot::{colour, number};
use crate::results::{Method, Results};
use crate::stats;
use serde::Serialize;

/// What no stage accounts for: submitting, and waiting for read-backs in the middle of the frame.
const BETWEEN: &str = "between stages";

/// Two plots of the same times, and what their colours mean.
#[derive(Serialize)]
pub struct Stages {
    milliseconds: Option<Bars>,
    shares: Option<Bars>,
    families: Vec<Family>,
}

/// Stages of one kind: what their name has before the slash.
#[derive(Serialize)]
struct Family {
    name: String,
    class: String,
}

/// None if no stage was timed.
pub fn stages(results: &Results) -> Option<Stages> {
    let names = families(results);
    if names.is_empty() {
        return None;
    }
    let row = |method, shares| row(method, &names, shares);
    let rows = |shares: bool| results.methods.iter().map(|method| row(method, shares)).collect();
    let alt = |of: &str| format!("Mean time of each stage of each method, {of}; the same numbers are in results.json.");
    let keys = names.iter().enumerate().map(|(place, name)| Family { name: (*name).to_owned(), class: colour(place) });
    let rest = Family { name: BETWEEN.to_owned(), class: "rest".to_owned() };
    Some(Stages {
        milliseconds: bars(rows(false), "ms of the mean frame", 0.0, alt("in milliseconds")),
        shares: bars(rows(true), "percent of the mean frame", 100.0, alt("in percent of its frame")),
        families: keys.chain([rest]).collect(),
    })
}

/// Kinds of stages that ran, in the order in which the methods first name them.
fn families(results: &Results) -> Vec<&str> {
    let mut names = Vec::new();
    for method in &results.methods {
        for stage in method.stages.iter().filter(|stage| mean_ms(method, &stage.name) > 0.0) {
            let family = family(&stage.name);
            if !names.contains(&family) {
                names.push(family);
            }
        }
    }
    names
}

fn family(stage: &str) -> &str {
    stage.split(['/', ':']).next().unwrap_or(stage)
}

/// Over all frames: where a stage did not run it took no time.
fn mean_ms(method: &Method, stage: &str) -> f64 {
    let frames = method.frames.frame_ms.len().max(1) as f64;
    method.frames.stages.get(stage).into_iter().flatten().flatten().sum::<f64>() / frames
}

fn row(method: &Method, families: &[&str], shares: bool) -> RowData {
    let times: Vec<(&str, f64)> =
        method.stages.iter().map(|stage| (stage.name.as_str(), mean_ms(method, &stage.name))).collect();
    let summed: f64 = times.iter().map(|(_, ms)| ms).sum();
    // Two timestamps may round to more than the time around them: then nothing is left over.
    let frame = stats::mean(&method.frames.frame_ms).unwrap_or(0.0).max(summed);
    let unit = if shares && frame > 0.0 { 100.0 / frame } else { 1.0 };
    let part = |name: &str, ms: f64, class: String| {
        let share = if frame > 0.0 { 100.0 * ms / frame } else { 0.0 };
        let tip = format!("{}: {name} {} ms, {} % of the frame", method.label, number(ms), number(share));
        Part { length: ms * unit, class, tip }
    };
    let class_of = |name: &str| colour(families.iter().position(|known| *known == family(name)).unwrap_or(0));
    let mut parts: Vec<Part> = times.iter().map(|(name, ms)| part(name, *ms, class_of(name))).collect();
    parts.push(part(BETWEEN, frame - summed, "rest".to_owned()));
    let value = format!("{} ms", number(frame));
    RowData { label: method.label.clone(), lanes: vec![parts], value }
}
