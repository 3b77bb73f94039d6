use super::{stage_times, stall, ticks_between, Queries, QueryStore, StageTime, TimerMode};
use crate::lock::lock;
use crate::recorder::{Op, Recorded};
use crate::DeviceKind;
use shaders::{Bound, ResourceId};
use std::time::Duration;

/// The mode was measured at each start, and differed in 2 of 8 starts on a busy machine.
#[test]
fn the_kind_of_device_alone_decides_how_stages_are_timed() {
    assert_eq!(TimerMode::of(DeviceKind::Cpu), TimerMode::Split);
    for gpu in [DeviceKind::Discrete, DeviceKind::Integrated, DeviceKind::Virtual] {
        assert_eq!(TimerMode::of(gpu), TimerMode::Plain);
    }
}

#[test]
fn the_timer_mode_is_told_in_words() {
    let words = [TimerMode::Plain, TimerMode::Split, TimerMode::Off].map(|mode| mode.to_string());
    assert_eq!(
        words,
        ["timestamps", "timestamps with a full barrier after each", "nothing: the device has no timestamps"]
    );
}

#[test]
fn timestamps_that_start_again_at_zero_still_tell_the_time() {
    assert_eq!(ticks_between(5, 12, 64), 7);
    assert_eq!(ticks_between((1 << 36) - 3, 4, 36), 7);
    assert_eq!(ticks_between(u64::MAX - 2, 4, 64), 7);
    assert_eq!(ticks_between(12, 5, 64), 0, "a step back");
    assert_eq!(ticks_between(12, 5, 36), 0, "a step back");
    // Bits beyond the valid ones mean nothing.
    assert_eq!(ticks_between(0xff << 36 | 5, 12, 36), 7);
    assert_eq!(ticks_between(5, 0xff << 36 | 12, 36), 7);
}

/// Half of the range and more is a step back; less is time.
#[test]
fn half_of_the_range_tells_time_from_a_step_back() {
    for bits in [8u32, 36, 64] {
        let half = 1u64 << (bits - 1);
        assert_eq!(ticks_between(0, half - 1, bits), half - 1, "{bits} bits");
        assert_eq!(ticks_between(0, half, bits), 0, "{bits} bits");
        assert_eq!(ticks_between(9, 9, bits), 0, "{bits} bits");
    }
}

fn stages(labels: &[&str]) -> Vec<Recorded> {
    let buffer = Bound::Buffer { id: ResourceId(0), raw: 0, offset: 0, size: 4 };
    let one = |label: &&str| Recorded { label: (*label).to_owned(), op: Op::Fill { buffer, value: 0 }, barrier: None };
    labels.iter().map(one).collect()
}

fn rows(ops: &[Recorded], ticks: &[u64], tick_ns: f32, bits: u32) -> Vec<(String, f64)> {
    stage_times(ops, ticks, tick_ns, bits).into_iter().map(|stage| (stage.label, stage.ms)).collect()
}

/// The times of the first two stages were swapped, and only a person who read the table could have noticed. No two stages take as long here.
#[test]
fn each_stage_has_the_time_between_its_timestamp_and_the_one_before() {
    let ops = stages(&["a", "b:late", "c", "d"]);
    let ticks = [1_000_000, 4_000_000, 4_000_000, 15_000_000, 15_500_000];
    // 2 ns a tick: a million ticks are 2 ms.
    let expected = [("a", 6.0), ("b:late", 0.0), ("c", 22.0), ("d", 1.0)].map(|(label, ms)| (label.to_owned(), ms));
    let found = rows(&ops, &ticks, 2.0, 64);
    assert_eq!(found.len(), expected.len());
    for ((label, ms), (expected_label, expected_ms)) in found.iter().zip(&expected) {
        assert_eq!(label, expected_label);
        // Two roundings of f64: of the period in ms, and of the product.
        assert!((ms - expected_ms).abs() <= 1e-15 * expected_ms, "{label}: {ms} ms, not {expected_ms}");
    }
}

/// A timestamp that starts again, one that steps back: neither takes from, or adds to, the stages beside it.
#[test]
fn a_step_back_and_a_new_start_cost_their_own_stage_alone() {
    let ops = stages(&["a", "b", "c"]);
    let found = rows(&ops, &[250, 4, 3, 13], 1e6, 8);
    let expected = [("a", 10.0), ("b", 0.0), ("c", 10.0)].map(|(label, ms)| (label.to_owned(), ms));
    assert_eq!(found, expected);
}

#[test]
fn a_submission_of_one_stage_has_one_time() {
    assert_eq!(rows(&stages(&["only"]), &[7, 9], 1e6, 64), [("only".to_owned(), 2.0)]);
    assert_eq!(rows(&[], &[7], 1e6, 64), []);
}

/// The stages of the same submission are in the table already. Clocks of device and host differ a little, so that the rest may come out below 0.
#[test]
fn a_wait_costs_what_its_stages_do_not() {
    let stages = [4.0, 0.5].map(|ms| StageTime { label: "a".to_owned(), ms });
    let row =
        |waited, stages: &[StageTime]| stall("frame/read_back:late".to_owned(), Duration::from_millis(waited), stages);
    assert_eq!(row(7, &stages), StageTime { label: "frame/read_back:late".to_owned(), ms: 2.5 });
    assert_eq!(row(7, &[]).ms, 7.0);
    assert_eq!(row(4, &stages).ms, 0.0);
}

/// Making pools takes longer than many a frame.
#[test]
fn a_finished_frame_leaves_its_pools_to_the_next_one() {
    let store = QueryStore::default();
    store.give_back(Queries { timestamps: None, statistics: None });
    store.give_back(Queries { timestamps: None, statistics: None });
    assert_eq!(lock(&store.0).len(), 2);
}
