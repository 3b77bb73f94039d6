//! Every figure that gates and tables take is tied to its field: no two of the fixture are equal.

use super::*;
use crate::results::tests::fields::distinct;
use serde_json::{json, Value};
use std::path::Path;

const FEW: CompareOptions<'static> =
    CompareOptions { force: false, stages: true, bootstrap: Bootstrap { resamples: 20, seed: 1 }, by: None };

/// Every figure of the fixture's only method, by the name that a gate has for it.
#[rustfmt::skip]
const FIGURES: [(&str, f64); 40] = [
    ("frame_ms.median", 1.5), ("frame_ms.p95", 2.5), ("frame_ms.mean", 3.5), ("host_ms", 4.5), ("ratio_to_ref", 5.5),
    ("stages.warp/search.median_ms", 6.5), ("stages.warp/search.share", 0.75), ("stages.warp/search.skipped", 7.0),
    ("stages.warp/search.saved_ms", 8.5), ("false_negatives", 9.0), ("false_negative_frames", 10.0), ("object_error_percent", 11.5),
    ("differing_pixels_mean", 12.5), ("tied_pixels_mean", 13.5), ("thin_pixels_mean", 14.5), ("psnr_mean_db", 15.5),
    ("psnr_worst_db", 16.5), ("psnr_between_db.none", 17.5), ("psnr_between_db.ref", f64::INFINITY), ("ssim_mean", 18.5),
    ("drawn_mean", 19.5), ("culled_over_total", 20.5), ("culled_over_ref", 21.5), ("triangles_mean", 22.5), ("draws_mean", 23.5),
    ("overdraw_mean", 24.5), ("queries_mean", 25.5), ("state_changes_mean", 26.5), ("waits_mean", 27.5), ("plane_tests_mean", 28.5),
    ("rays_mean", 29.5), ("boxes_mean", 30.5), ("bounds_brought_mean", 31.5), ("refits_mean", 32.5), ("node_visits_mean", 33.5),
    ("device_memory_mib", 34.5), ("flare.frames_on_screen", 35.0), ("flare.shows_mean", 36.5), ("flare.error_mean", 37.5),
    ("flare.error_max", 38.5),
];

/// The fixture's method with one figure changed by `step`.
fn changed(name: &str, step: i32) -> Results {
    let mut results = distinct();
    let mut row = serde_json::to_value(&results.methods[0]).unwrap();
    let (object, field) = match name.strip_prefix("stages.warp/search.") {
        Some(field) => ("/stages/0".to_owned(), field),
        None => name.split_once('.').map_or((String::new(), name), |(object, field)| (format!("/{object}"), field)),
    };
    let value = row.pointer_mut(&object).unwrap().get_mut(field).unwrap();
    *value = match value.as_u64() {
        Some(whole) => json!(whole.checked_add_signed(step.into()).unwrap()),
        None => value.as_f64().map_or(json!(100.0), |number| json!(number + f64::from(step))),
    };
    results.methods[0] = serde_json::from_value(row).unwrap();
    results
}

#[test]
fn each_figure_has_the_value_of_its_own_field() {
    let found = fields::fields(&distinct().methods[0]).unwrap();
    let expected: BTreeMap<String, Option<f64>> =
        FIGURES.into_iter().map(|(name, value)| (name.to_owned(), Some(value))).collect();
    assert_eq!(found, expected);
    // Frames and options are no measures, whatever numbers they hold.
    let row: Value = serde_json::to_value(&distinct().methods[0]).unwrap();
    assert!(row["options"]["seeds"].is_u64() && row["frames"]["drawn"][0].is_u64());
}

#[test]
fn each_gate_fires_on_its_own_field_in_its_own_direction() {
    let fails = |gate: &str, a: &Results, b: &Results| {
        let gate: Gate = gate.parse().unwrap();
        gate.check(Some(a), b, Some(&compare(a, b, FEW).unwrap())).unwrap().failed
    };
    let before = distinct();
    for (name, value) in FIGURES.into_iter().filter(|(_, value)| value.is_finite()) {
        let (more, less) = (changed(name, 1), changed(name, -1));
        let gates = [">", "<"].map(|operator| format!("woc.{name}{operator}{value}"));
        let found = [&before, &more, &less].map(|b| gates.each_ref().map(|gate| fails(gate, &before, b)));
        assert_eq!(found, [[false, false], [true, false], [false, true]], "{name}");
        let gates = [">", "<"].map(|operator| format!("woc.{name}_delta{operator}0"));
        let found = [&before, &more, &less].map(|b| gates.each_ref().map(|gate| fails(gate, &before, b)));
        assert_eq!(found, [[false, false], [true, false], [false, true]], "{name}_delta");
        // The same change the other way round is of the other sign.
        assert!(fails(&format!("woc.{name}_delta<0"), &more, &before), "{name}");
        assert!(fails(&format!("woc.{name}_delta==1"), &before, &more), "{name}");
    }
    let worse = changed("psnr_between_db.ref", 1);
    assert!(
        fails("woc.psnr_between_db.ref<inf", &before, &worse)
            && !fails("woc.psnr_between_db.ref<inf", &before, &before)
    );
}

#[test]
fn a_change_is_found_in_its_own_field_alone() {
    for (name, _) in FIGURES.into_iter().filter(|(name, value)| value.is_finite() && !name.starts_with("stages.")) {
        let comparison = compare(&distinct(), &changed(name, 1), FEW).unwrap();
        let moved = comparison.methods[0].fields.iter().filter(|(_, change)| change.delta != Some(0.0));
        let moved: Vec<_> = moved.map(|(field, change)| (field.as_str(), change.delta)).collect();
        assert_eq!(moved, [(name, Some(1.0))]);
    }
}

/// Two methods whose errors moved in opposite directions, as many up as down.
#[test]
fn errors_that_rose_in_one_and_fell_in_another_are_not_offset() {
    let of = |errors: [u64; 2]| {
        let mut run = distinct();
        run.methods.push(Method { label: "hzb".into(), method: "hzb".into(), ..run.methods[0].clone() });
        run.methods.iter_mut().zip(errors).for_each(|(method, errors)| method.false_negatives = errors);
        run
    };
    let (a, b) = (of([3, 9]), of([7, 5]));
    let comparison = compare(&a, &b, FEW).unwrap();
    let gate: Gate = "any.false_negatives_delta>0".parse().unwrap();
    let outcome = gate.check(Some(&a), &b, Some(&comparison)).unwrap();
    let found = |figures: &[Figure]| figures.iter().map(|it| (it.label.clone(), it.figure)).collect::<Vec<_>>();
    assert!(outcome.failed);
    assert_eq!(found(&outcome.fails), [("woc[seeds=8]".to_owned(), 4.0)]);
    assert_eq!(found(&outcome.passes), [("hzb".to_owned(), -4.0)]);
    let text = gates_text(&[outcome]);
    assert_eq!(text, "gate FAILED: any.false_negatives_delta>0: woc[seeds=8] has 4\n");
    assert!(!gate.check(Some(&b), &b, Some(&compare(&b, &b, FEW).unwrap())).unwrap().failed);
}

/// B is the new run: its times are above the line, and its heading is shown.
#[test]
fn the_ratio_is_of_the_new_run_to_the_old_one() {
    let of = |frame_ms: [f64; 6], by: [f64; 6]| {
        let mut run = distinct();
        run.frames = 6;
        run.methods[0].frames = crate::results::Frames { frame_ms: frame_ms.into(), ..Default::default() };
        let mut reference = run.methods[0].clone();
        (reference.label, reference.method) = ("ref".into(), "ref".into());
        reference.frames.frame_ms = by.into();
        run.methods.push(reference);
        run
    };
    // Medians are 20 and 8 of A, 30 and 4 of B; means, extremes and last values stand otherwise.
    let times = [18.0, 19.0, 20.0, 20.0, 90.0, 21.0];
    let (a, b) = (of(times, [8.0; 6]), of(times.map(|ms| 1.5 * ms), [4.0; 6]));
    let frame = |a: &Results, b: &Results, by| {
        let options = CompareOptions { by, ..FEW };
        compare(a, b, options).unwrap().methods[0].frame
    };
    let found = frame(&a, &b, None);
    assert_eq!((found.a_ms, found.b_ms, found.a_by, found.b_by), (Some(20.0), Some(30.0), None, None));
    let ratio = found.ratio.unwrap();
    assert_eq!((ratio.ratio, ratio.low, ratio.high, ratio.verdict), (1.5, 1.5, 1.5, Verdict::Slower));
    let turned = frame(&b, &a, None);
    assert_eq!((turned.a_ms, turned.b_ms), (Some(30.0), Some(20.0)));
    assert_eq!((turned.ratio.unwrap().ratio, turned.ratio.unwrap().verdict), (20.0 / 30.0, Verdict::Faster));
    let by = frame(&a, &b, Some("ref"));
    assert_eq!((by.a_by, by.b_by, by.ratio.unwrap().ratio), (Some(2.5), Some(7.5), 3.0));
    let shown = text(&compare(&a, &b, CompareOptions { by: Some("ref"), ..FEW }).unwrap(), &b);
    let row = shown.lines().find(|line| line.starts_with("woc[seeds=8]")).unwrap();
    let cells = ["woc[seeds=8]", "20.00", "30.00", "2.500", "7.500", "3.000", "3.000", "to", "3.000", "slower"];
    assert_eq!(row.split_whitespace().collect::<Vec<_>>(), cells);
    assert!(shown.contains("A ms   B ms   A by   B by    B/A"), "{shown}");
}

#[test]
fn each_column_of_the_errors_is_its_own_field() {
    let (a, mut b) = (distinct(), distinct());
    let method = &mut b.methods[0];
    (method.false_negatives, method.object_error_percent, method.differing_pixels_mean) = (8, 0.5, 0.25);
    (method.psnr_worst_db, method.drawn_mean, method.culled_over_ref) = (Some(41.3), 1234.0, 0.875);
    (method.psnr_mean_db, method.culled_over_total, method.false_negative_frames) = (Some(50.0), 0.5, 1);
    let shown = text(&compare(&a, &b, FEW).unwrap(), &b);
    let rows: Vec<&str> = shown.lines().filter(|line| line.starts_with("woc[seeds=8] ")).collect();
    let cells: Vec<&str> = rows[1].split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    let expected =
        ["woc[seeds=8]", "9 → 8", "11.50 → 0.50", "12.50 → 0.25", "16.5 → 41.3", "20 → 1234", "2150.0 → 87.5"];
    assert_eq!(cells, expected);
    let line = run_lines("A", Path::new("a.json"), &a);
    assert_eq!(line, "A: a.json · version 9.8.7 · sightline bench");
}
