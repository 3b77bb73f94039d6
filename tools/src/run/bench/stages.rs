//! What each stage cost, from the reports of frames whose stages were timed.

use crate::measures::stats;
use crate::results;
use engine::FrameReport;
use std::collections::BTreeMap;

/// By stage, its time in each frame; a stage that runs several times in a frame is summed.
pub(super) fn stage_times(reports: &[FrameReport]) -> BTreeMap<String, Vec<Option<f64>>> {
    let mut times: BTreeMap<String, Vec<Option<f64>>> = BTreeMap::new();
    for (frame, report) in reports.iter().enumerate() {
        for stage in &report.stages {
            let of_stage = times.entry(stage.label.clone()).or_insert_with(|| vec![None; reports.len()]);
            *of_stage[frame].get_or_insert(0.0) += stage.ms;
        }
    }
    times
}

/// One row a stage, in the order in which the frame has them. `warm` are frames of the warm-up: they only say what a stage
/// costs that did not run since.
pub(super) fn stages(reports: &[FrameReport], warm: &[FrameReport]) -> Vec<results::Stage> {
    let (times, warm) = (stage_times(reports), stage_times(warm));
    let mut order: Vec<&str> = Vec::new();
    let mut skipped: BTreeMap<&str, (u32, Vec<&'static str>)> = BTreeMap::new();
    for report in reports {
        for skip in &report.skips {
            let (count, reasons) = skipped.entry(&skip.label).or_default();
            *count += 1;
            if !reasons.contains(&skip.reason) {
                reasons.push(skip.reason);
            }
        }
        let labels = report.stages.iter().map(|stage| &stage.label).chain(report.skips.iter().map(|skip| &skip.label));
        for label in labels {
            if !order.contains(&label.as_str()) {
                order.push(label);
            }
        }
    }
    let total: f64 = times.values().flatten().flatten().sum();
    let row = |name: &str| {
        let of_stage = |times: &BTreeMap<String, Vec<Option<f64>>>| -> Vec<f64> {
            times.get(name).into_iter().flatten().copied().flatten().collect()
        };
        let samples = of_stage(&times);
        let (skipped, reason) =
            skipped.get(name).map_or((0, None), |(count, reasons)| (*count, Some(reasons.join("; "))));
        let all = [samples.clone(), of_stage(&warm)].concat();
        let saved_ms = stats::median(&all).map(|ms| ms * f64::from(skipped) / reports.len().max(1) as f64);
        // From +0: the sum of nothing is -0, which would be printed so.
        let share = if total > 0.0 { samples.iter().fold(0.0, |sum, ms| sum + ms) / total } else { 0.0 };
        let median_ms = stats::median(&samples).unwrap_or(0.0);
        results::Stage { name: name.to_owned(), median_ms, share, skipped, reason, saved_ms }
    };
    order.into_iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::{Skip, StageTime};

    fn report(stages: &[(&str, f64)], skips: &[&str]) -> FrameReport {
        FrameReport {
            stages: stages.iter().map(|(label, ms)| StageTime { label: (*label).into(), ms: *ms }).collect(),
            skips: skips.iter().map(|label| Skip { label: (*label).into(), reason: "not needed" }).collect(),
            ..FrameReport::default()
        }
    }

    #[test]
    fn what_a_skipped_stage_saves_is_what_it_costs_where_it_ran() {
        let mut reports = [report(&[("a", 4.0)], &["b", "c"]), report(&[], &["a", "b", "c"])];
        reports[1].skips[1].reason = "nobody asked";
        let rows = stages(&reports, &[report(&[("a", 4.0), ("b", 6.0)], &[])]);
        let shown: Vec<_> = rows.iter().map(|row| (row.name.as_str(), row.skipped, row.saved_ms)).collect();
        // Half of 4 ms a frame; 6 ms, as the warm-up's frame says; and of what never ran nobody knows.
        assert_eq!(shown, [("a", 1, Some(2.0)), ("b", 2, Some(6.0)), ("c", 2, None)]);
        assert_eq!(rows[1].median_ms, 0.0, "the warm-up is no part of the run");
        assert_eq!(rows[1].reason.as_deref(), Some("not needed; nobody asked"));
    }

    #[test]
    fn stages_are_summed_within_a_frame_and_null_where_they_did_not_run() {
        let reports = [report(&[("a", 1.0), ("b", 2.0), ("a", 3.0)], &["c"]), report(&[("b", 4.0)], &["a", "c"])];
        let times = stage_times(&reports);
        let expected = [("a".to_owned(), vec![Some(4.0), None]), ("b".to_owned(), vec![Some(2.0), Some(4.0)])];
        assert_eq!(times, expected.into());
        let rows = stages(&reports, &[]);
        let shown: Vec<_> = rows.iter().map(|row| (row.name.as_str(), row.median_ms, row.skipped)).collect();
        assert_eq!(shown, [("a", 4.0, 1), ("b", 3.0, 0), ("c", 0.0, 2)]);
        assert_eq!((rows[0].share, rows[1].share), (0.4, 0.6));
        assert_eq!(format!("{:.1}", rows[2].share), "0.0", "not -0.0");
    }
}
