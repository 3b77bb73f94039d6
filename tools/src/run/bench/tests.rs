//! Every figure of a method comes from its own record. In the fixtures, sum, mean, median, maximum and last value all differ, as do the
//! values of any two records.

use super::*;
use crate::measures::metrics::FrameError;
use engine::{Skip, StageTime};

/// Three frames whose counts are 1, 2 and 6 times `unit`: their mean is 3 `unit`, their median 2, their maximum 6.
fn thrice(unit: u64) -> [u64; 3] {
    [unit, 2 * unit, 6 * unit]
}

fn report(frame_ms: f64, host_ms: f64, stage_ms: f64) -> FrameReport {
    FrameReport {
        frame_ms,
        host_ms,
        stages: vec![StageTime { label: "test".into(), ms: stage_ms }],
        skips: vec![Skip { label: "pack".into(), reason: "not needed" }],
        ..FrameReport::default()
    }
}

fn work(frame: usize) -> Work {
    let of = |unit| thrice(unit)[frame];
    Work {
        queries: of(5),
        plane_tests: of(7),
        state_changes: of(11),
        waits: of(13),
        boxes: of(17),
        rays: of(19),
        node_visits: of(23),
        early_stops: of(29),
        refits: of(31),
        flare: None,
    }
}

/// An error of a scene of 100 objects.
fn error(visible: usize, drawn: usize, missing: usize, pixels: usize, psnr_db: Option<f64>, ssim: f64) -> FrameError {
    FrameError {
        objects: 100,
        ref_visible: visible,
        drawn,
        culled: 100 - drawn,
        false_negatives: missing,
        false_positives: drawn + missing - visible,
        differing_pixels: pixels,
        tied_pixels: 10 * pixels + 1,
        wrong_colour_pixels: 0,
        psnr_db,
        ssim,
        culled_over_total: (100 - drawn) as f64 / 100.0,
        culled_over_ref: (100 - drawn) as f64 / (100 - visible) as f64,
        object_error_percent: 100.0 * missing as f64 / visible as f64,
    }
}

fn records() -> Records {
    Records {
        timed: vec![report(10.0, 1.0, 901.0), report(40.0, 2.0, 902.0), report(16.0, 9.0, 903.0)],
        staged: vec![report(11.0, 801.0, 4.0), report(44.0, 802.0, 5.0), report(17.0, 803.0, 12.0)],
        warm: vec![report(701.0, 702.0, 703.0)],
        errors: vec![
            error(50, 60, 2, 30, Some(40.0), 0.75),
            error(40, 70, 0, 0, None, 1.0),
            error(20, 30, 5, 90, Some(20.0), 0.5),
        ],
        thin: thrice(37).into(),
        triangles: thrice(41).into(),
        draws: thrice(43).into(),
        overdraw: vec![1.0, 1.5, 5.0],
        work: (0..3).map(work).collect(),
        bounds_brought: thrice(47).into(),
    }
}

#[test]
fn times_come_from_the_timed_frames_and_stages_from_the_staged_ones() {
    let method = recorded(&records());
    // The 95th percentile of three frames lies 0.95 * 2 = 1.9 steps above the fastest: nine tenths of the way from 16 to 40.
    let FrameMs { median, p95, mean } = method.frame_ms;
    assert_eq!((median, mean), (16.0, 22.0));
    assert!((p95 - 37.6).abs() < 1e-9, "p95 {p95}");
    assert_eq!(method.host_ms, Some(2.0));
    assert_eq!(method.frames.frame_ms, [10.0, 40.0, 16.0]);
    assert_eq!(method.frames.staged_frame_ms, [11.0, 44.0, 17.0]);
    assert_eq!(method.frames.stages["test"], [Some(4.0), Some(5.0), Some(12.0)]);
    let stages: Vec<_> =
        method.stages.iter().map(|stage| (stage.name.as_str(), stage.median_ms, stage.skipped)).collect();
    assert_eq!(stages, [("test", 5.0, 0), ("pack", 0.0, 3)]);
}

#[test]
fn each_count_is_the_mean_of_its_own_record() {
    let method = recorded(&records());
    let means = [
        method.queries_mean,
        method.plane_tests_mean,
        method.state_changes_mean,
        method.waits_mean,
        method.boxes_mean,
        method.rays_mean,
        method.node_visits_mean,
        method.refits_mean,
        method.thin_pixels_mean,
        method.triangles_mean,
        method.draws_mean,
        method.bounds_brought_mean,
    ];
    assert_eq!(means, [5, 7, 11, 13, 17, 19, 23, 31, 37, 41, 43, 47].map(|unit: u32| f64::from(3 * unit)));
    assert_eq!(method.overdraw_mean, Some(2.5));
    let Frames { queries, boxes, rays, node_visits, thin_pixels, triangles, draws, overdraw, .. } = method.frames;
    let counts = [queries, boxes, rays, node_visits, thin_pixels, triangles, draws];
    assert_eq!(counts, [5, 17, 19, 23, 37, 41, 43].map(|unit| thrice(unit).to_vec()));
    assert_eq!(overdraw, [1.0, 1.5, 5.0]);
}

#[test]
fn errors_of_two_bad_frames_are_summed_and_counted() {
    let method = recorded(&records());
    assert_eq!((method.false_negatives, method.false_negative_frames), (7, 2));
    // Of 50, 40 and 20 visible objects 2, 0 and 5 are missing: the percents are 4, 0 and 25.
    assert_eq!(method.differing_pixels_mean, 40.0);
    assert_eq!(method.tied_pixels_mean, (301.0 + 1.0 + 901.0) / 3.0);
    assert_eq!((method.psnr_mean_db, method.psnr_worst_db), (Some(30.0), Some(20.0)));
    assert_eq!((method.ssim_mean, method.drawn_mean), (0.75, (60.0 + 70.0 + 30.0) / 3.0));
    let frames = method.frames;
    assert_eq!([frames.drawn, frames.ref_visible], [[60, 70, 30], [50, 40, 20]]);
    assert_eq!([frames.false_negatives, frames.differing_pixels], [[2, 0, 5], [30, 0, 90]]);
    assert_eq!(frames.tied_pixels, [301, 1, 901]);
    assert_eq!((frames.psnr_db, frames.ssim), (vec![Some(40.0), None, Some(20.0)], vec![0.75, 1.0, 0.5]));
}

#[test]
fn without_frames_nothing_is_made_up() {
    let method = recorded(&Records::default());
    assert_eq!((method.host_ms, method.overdraw_mean, method.psnr_worst_db), (None, None, None));
    assert!(!method.is_measured() && method.stages.is_empty());
}
