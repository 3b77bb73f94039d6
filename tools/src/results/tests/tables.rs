//! Every column of the tables on the terminal is tied to its field: all columns of the fixtures differ.

use super::fields::distinct;
use super::*;
use crate::results::grid::{clipped, milliseconds, WIDTH};

/// Three methods whose ratios, medians, means and 95th percentiles all differ.
fn unlike() -> Results {
    let of = |label: &str, id: &str, [median, p95, mean]: [f64; 3]| {
        let mut method = distinct().methods.remove(0);
        (method.label, method.method) = (label.into(), id.into());
        (method.frame_ms, method.ratio_to_ref) = (FrameMs { median, p95, mean }, None);
        method.frames.thin_pixels = vec![0, 4, 3];
        method
    };
    let mut results = distinct();
    let mut woc = of("woc[seeds=8]", "woc", [10.0, 13.0, 11.0]);
    (woc.drawn_mean, woc.culled_over_ref, woc.culled_over_total) = (1234.0, 0.875, 0.5);
    (woc.false_negatives, woc.false_negative_frames) = (9, 2);
    (woc.differing_pixels_mean, woc.tied_pixels_mean) = (12.34, 98.7);
    (woc.psnr_worst_db, woc.psnr_mean_db) = (Some(41.3), Some(47.1));
    (woc.triangles_mean, woc.draws_mean, woc.overdraw_mean) = (567_800.0, 765.0, Some(2.34));
    results.methods = vec![of("none", "none", [40.0, 45.0, 41.0]), woc, of("ref", "ref", [8.0, 9.0, 8.5])];
    results
}

/// The words of a method's row.
fn row(text: &str, label: &str) -> Vec<String> {
    let line = text.lines().find(|line| line.starts_with(label)).unwrap();
    line[label.len()..].split_whitespace().map(str::to_owned).collect()
}

#[test]
fn each_column_of_the_table_is_its_own_field() {
    let text = table(&unlike());
    let expected = "\
a scene: 1001 objects, 1002 triangles · path a path at speed 1003.5 · 3 frames of 1005x1006
a device (discrete) · a driver · Vulkan 1.3.9

method        frame  /none  /ref    p95  drawn   C/R %  false neg.  diff px  PSNR  triangles  overdraw
";
    assert!(text.starts_with(expected), "{text}");
    let cells = ["10.00", "0.25", "1.25", "13.00", "1234", "87.5", "9", "12.34", "41.3", "567.8k", "2.34"];
    assert_eq!(row(&text, "woc[seeds=8]"), cells);
    let ratios = ["none", "ref"].map(|label| row(&text, label)[..4].join(" "));
    assert_eq!(ratios, ["40.00 1.00 5.00 45.00", "8.000 0.20 1.00 9.000"]);
    assert!(text.contains("woc[seeds=8]: 7 wrong pixels in 2 frames are excused"), "{text}");
}

#[test]
fn ratios_stand_to_the_first_of_a_method_and_a_sweep_has_its_own() {
    let mut results = unlike();
    results.methods.push(Method { label: "ref[again]".into(), ..results.methods[2].clone() });
    results.methods[3].frame_ms.median = 16.0;
    results.methods[1].ratio_to_ref = Some(1.75);
    let text = table(&results);
    // The ratio to `ref` is that of the cell, the one to `none` is of the medians.
    assert_eq!(row(&text, "woc[seeds=8]")[..3], ["10.00", "0.25", "1.75"]);
    assert_eq!(row(&text, "ref[again]")[..3], ["16.00", "0.40", "2.00"]);
    results.methods[0].frame_ms.median = 0.0;
    assert_eq!(row(&table(&results), "woc[seeds=8]")[..3], ["10.00", "-", "1.75"]);
}

#[test]
fn without_excused_pixels_no_line_speaks_of_them() {
    let mut results = unlike();
    results.methods.iter_mut().for_each(|method| method.thin_pixels_mean = 0.0);
    assert!(!table(&results).contains("excused"));
}

#[test]
fn each_column_of_the_stages_is_its_own_field() {
    let mut results = unlike();
    let stage = |name: &str, median_ms, share, skipped, saved_ms| Stage {
        name: name.into(),
        median_ms,
        share,
        skipped,
        reason: Some("nothing to do".into()),
        saved_ms,
    };
    results.methods[1].stages = vec![
        stage("warp/search", 1.25, 0.375, 1, Some(0.625)),
        stage("draw/all", 3.5, 0.5, 0, Some(7.5)),
        stage("pack/scan", 0.0, 0.0, 3, None),
    ];
    let expected = "\
woc[seeds=8]: approximate: holes
stage            ran     ms   share  saved  why skipped
warp/search   2 of 3  1.250  37.5 %  0.625  nothing to do
draw/all         ran  3.500  50.0 %      -
pack/scan    skipped      -   0.0 %      -  nothing to do
";
    assert_eq!(stages_table(&results, &results.methods[1]), expected);
}

#[test]
fn each_column_of_the_flares_is_its_own_field() {
    let mut results = unlike();
    results.methods.remove(2);
    let flare = results.methods[1].flare.as_mut().unwrap();
    (flare.frames_on_screen, flare.shows_mean) = (2, Some(0.5));
    (flare.error_mean, flare.error_max) = (Some(0.125), Some(0.25));
    results.methods[0].flare = None;
    let expected = "\
lens flare of a light at 1,2,3, each frame's by its own query, which it waits for
method        on screen   shows   error   worst
woc[seeds=8]     2 of 3  0.5000  0.1250  0.2500
";
    assert_eq!(flares_table(&results), expected);
    let flare = results.methods[1].flare.as_mut().unwrap();
    (flare.when, flare.frames_on_screen) = ("next".into(), 0);
    let text = flares_table(&results);
    assert!(text.contains("by the query of the frame before") && text.contains("0 of 3"), "{text}");
    assert!(text.contains("the light is on the screen in no frame"), "{text}");
    *flare_of(&mut results) = FlareErrors { when: "next".into(), ..FlareErrors::default() };
    assert_eq!(row(&flares_table(&results), "woc[seeds=8]"), ["-"; 4]);
    assert!(!flares_table(&results).contains("in no frame"));
    results.methods.truncate(1);
    assert_eq!(flares_table(&results), "");
}

fn flare_of(results: &mut Results) -> &mut FlareErrors {
    results.methods[1].flare.as_mut().unwrap()
}

/// Stages were timed in frames of their own: their parts are parts of those.
#[test]
fn parts_are_of_the_frames_whose_stages_were_timed() {
    let mut method = distinct().methods.remove(0);
    method.frames.frame_ms = vec![1000.0; 3];
    method.frames.staged_frame_ms = vec![10.0, 20.0, 60.0];
    method.stages = vec![
        Stage { name: "draw/all".into(), ..Stage::default() },
        Stage { name: "pack/scan:late".into(), ..Stage::default() },
    ];
    method.frames.stages = [
        ("draw/all".to_owned(), vec![Some(3.0), None, Some(6.0)]),
        ("pack/scan:late".to_owned(), vec![Some(6.0), Some(18.0), Some(42.0)]),
    ]
    .into();
    let expected = "\
part            mean ms  of frame
no part           3.000    10.0 %
late              22.00    73.3 %
between stages    5.000    16.7 %
";
    assert_eq!(parts_table(&method), expected);
    // Two timestamps round to more than the time around them: nothing is between.
    method.frames.staged_frame_ms = vec![10.0, 20.0, 30.0];
    assert_eq!(row(&parts_table(&method), "between stages"), ["0.000", "0.0", "%"]);
}

#[test]
fn numbers_change_their_form_where_they_say() {
    let ms = [0.0, 0.0144, 9.9994, 9.9995, 99.994, 99.995, 999.94, 999.95, 1824.4].map(milliseconds);
    assert_eq!(ms, ["0.000", "0.014", "9.999", "10.00", "99.99", "100.0", "999.9", "1000", "1824"]);
    let shares = [0.0, 0.0009, 0.001, 0.5, 0.999, 0.9991, 0.9999, 1.0, 1.166].map(percent);
    assert_eq!(shares, ["0.0", "<0.1", "0.1", "50.0", "99.9", ">99.9", ">99.9", "100.0", "116.6"]);
    let errors = [0.0, 0.0099, 0.01, 1.234, 99.99, 100.0, 1234.5].map(error);
    assert_eq!(errors, ["0", "<0.01", "0.01", "1.23", "99.99", "100", "1234"]);
    let counts = [0.0, 9999.4, 9999.5, 999.94e3, 999.95e3, 999.94e6, 999.95e6, 2.5e12].map(quantity);
    assert_eq!(counts, ["0", "9999", "10.0k", "999.9k", "1.0M", "999.9M", "1.0G", "2500.0G"]);
    assert_eq!([decibels(None), decibels(Some(48.06))], ["identical", "48.1"]);
}

#[test]
fn a_line_is_cut_at_the_width_of_the_table_and_says_so() {
    let line = "x".repeat(WIDTH);
    assert_eq!(clipped(&line), line);
    let cut = clipped(&(line.clone() + "x"));
    assert_eq!((cut.chars().count(), cut.ends_with("x…")), (WIDTH, true));
    assert_eq!(clipped("a\nb"), "a\\nb");
}
