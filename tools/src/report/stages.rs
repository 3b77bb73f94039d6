//! What each method's frame is spent on, stage by stage (Kim's thesis, figure 9; EOVC thesis, figure 16).

use super::bars::{bars, Bars, Part, RowData};
use super::plot::{colour, number, COLOURS};
use crate::measures::stats;
use crate::results::{Method, Results};
use serde::Serialize;

/// What no stage accounts for: submitting, and waiting for read-backs in the middle of the frame.
const BETWEEN: &str = "between stages";

/// Kinds of stages that take too little time for a colour of their own.
const OTHERS: &str = "other stages";

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
    let own = if names.len() > COLOURS { COLOURS - 1 } else { names.len() };
    let keys = names[..own].iter().map(|name| (*name).to_owned()).chain((own < names.len()).then(|| OTHERS.to_owned()));
    let keys = keys.enumerate().map(|(place, name)| Family { name, class: class_at(place) });
    let rest = Family { name: BETWEEN.to_owned(), class: "rest".to_owned() };
    Some(Stages {
        milliseconds: bars(rows(false), "ms of the mean frame", 0.0, alt("in milliseconds")),
        shares: bars(rows(true), "percent of the mean frame", 100.0, alt("in percent of its frame")),
        families: keys.chain([rest]).collect(),
    })
}

/// Kinds of stages that ran, those that took most time first: they have a colour of their own, the rest share the last one.
fn families(results: &Results) -> Vec<&str> {
    let mut times: Vec<(&str, f64)> = Vec::new();
    for method in &results.methods {
        for stage in &method.stages {
            let (name, ms) = (family(&stage.name), mean_ms(method, &stage.name));
            match times.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum += ms,
                None => times.push((name, ms)),
            }
        }
    }
    times.retain(|(_, ms)| *ms > 0.0);
    times.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    times.into_iter().map(|(name, _)| name).collect()
}

/// The style sheet's class of the kind at this place.
fn class_at(place: usize) -> String {
    colour(place.min(COLOURS - 1))
}

fn family(stage: &str) -> &str {
    stage.split(['/', ':']).next().unwrap_or(stage)
}

/// Over all frames: where a stage did not run it took no time.
fn mean_ms(method: &Method, stage: &str) -> f64 {
    let frames = method.frames.staged_ms().len().max(1) as f64;
    method.frames.stages.get(stage).into_iter().flatten().flatten().sum::<f64>() / frames
}

fn row(method: &Method, families: &[&str], shares: bool) -> RowData {
    let times: Vec<(&str, f64)> =
        method.stages.iter().map(|stage| (stage.name.as_str(), mean_ms(method, &stage.name))).collect();
    let summed: f64 = times.iter().map(|(_, ms)| ms).sum();
    // Two timestamps may round to more than the time around them: then nothing is left over.
    let frame = stats::mean(method.frames.staged_ms()).unwrap_or(0.0).max(summed);
    let unit = if shares && frame > 0.0 { 100.0 / frame } else { 1.0 };
    let part = |name: &str, ms: f64, class: String| {
        let share = if frame > 0.0 { 100.0 * ms / frame } else { 0.0 };
        let tip = format!("{}: {name} {} ms, {} % of the frame", method.label, number(ms), number(share));
        Part { length: ms * unit, class, tip }
    };
    let class_of = |name: &str| class_at(families.iter().position(|known| *known == family(name)).unwrap_or(0));
    let mut parts: Vec<Part> = times.iter().map(|(name, ms)| part(name, *ms, class_of(name))).collect();
    parts.push(part(BETWEEN, frame - summed, "rest".to_owned()));
    let value = format!("{} ms", number(frame));
    RowData { label: method.label.clone(), lanes: vec![parts], value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::tests::results;
    use crate::results::Stage;

    fn with_stages(times: &[(&str, f64)]) -> Results {
        let mut results = results();
        results.methods.truncate(1);
        let method = &mut results.methods[0];
        method.stages = times.iter().map(|(name, _)| Stage { name: (*name).into(), ..Stage::default() }).collect();
        method.frames.stages = times.iter().map(|(name, ms)| ((*name).to_owned(), vec![Some(*ms), None])).collect();
        results
    }

    #[test]
    fn stages_of_one_kind_share_a_colour_and_the_slowest_kind_comes_first() {
        let results =
            with_stages(&[("pack/count", 1.0), ("draw/objects:late", 8.0), ("pack/scan", 2.0), ("eovc/none", 0.0)]);
        assert_eq!(families(&results), ["draw", "pack"]);
        let names: Vec<_> = stages(&results).unwrap().families.into_iter().map(|family| family.name).collect();
        assert_eq!(names, ["draw", "pack", BETWEEN]);
    }

    #[test]
    fn more_kinds_than_colours_share_the_last() {
        let named: Vec<(String, f64)> =
            (0..13u32).map(|kind| (format!("kind{kind}/stage"), 20.0 - f64::from(kind))).collect();
        let times: Vec<(&str, f64)> = named.iter().map(|(name, ms)| (name.as_str(), *ms)).collect();
        let families = stages(&with_stages(&times)).unwrap().families;
        assert_eq!(families.len(), COLOURS + 1);
        assert_eq!((families[COLOURS - 1].name.as_str(), families[COLOURS - 1].class.as_str()), (OTHERS, "c9"));
    }

    #[test]
    fn the_parts_of_a_frame_are_as_long_as_the_frame() {
        let results = with_stages(&[("a/a", 900.0), ("b/b", 300.0)]);
        for (shares, whole) in [(false, 1000.0), (true, 100.0)] {
            let row = row(&results.methods[0], &families(&results), shares);
            let lengths: Vec<f64> = row.lanes[0].iter().map(|part| part.length).collect();
            assert!((lengths.iter().sum::<f64>() - whole).abs() < 1e-9, "{lengths:?}");
            assert!((lengths[0] - 0.45 * whole).abs() < 1e-9, "ran in one of two frames: {lengths:?}");
        }
    }
}
