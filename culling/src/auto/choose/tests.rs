//! Recorded and made-up traces: times by candidate, as functions of the frame.

use super::*;

const MEMORIES: [Memory; 3] = [Memory::Helps, Memory::Needs, Memory::None];
const ITERATIVE: usize = 0;
const EOVC: usize = 1;
const FRUSTUM: usize = 2;

/// Runs frames and says what was chosen in each.
fn run(
    chooser: &mut Chooser,
    frames: std::ops::Range<usize>,
    pace: fn(usize) -> Pace,
    ms: impl Fn(usize, usize) -> f64,
) -> Vec<usize> {
    let frame = |frame: usize| {
        let choice = chooser.choose(pace(frame));
        chooser.measured(ms(choice.candidate, frame));
        choice.candidate
    };
    frames.map(frame).collect()
}

fn calm(_: usize) -> Pace {
    Pace::Calm
}

fn cuts(_: usize) -> Pace {
    Pace::Cut
}

fn total(chosen: &[usize], ms: impl Fn(usize, usize) -> f64) -> f64 {
    chosen.iter().enumerate().map(|(frame, candidate)| ms(*candidate, frame)).sum()
}

#[test]
fn the_cheapest_is_found_and_kept() {
    // City block, walk (lavapipe): hzb-iterative, eovc, frustum.
    for times in [[24.0, 22.0, 245.0], [24.0, 30.0, 245.0], [24.0, 30.0, 12.0]] {
        let mut chooser = Chooser::new(MEMORIES.into());
        let chosen = run(&mut chooser, 0..60, calm, |candidate, _| times[candidate]);
        let best = (0..3).min_by(|a, b| times[*a].total_cmp(&times[*b])).unwrap();
        // 24 and 22 are not clearly different.
        let fine = |candidate: &usize| times[*candidate] * CLEARLY <= times[best];
        assert!(chosen[8..].iter().all(fine), "{times:?}: {chosen:?}");
        assert_eq!(
            chosen.iter().filter(|candidate| **candidate == FRUSTUM).count().min(2),
            if best == FRUSTUM { 2 } else { 1 }
        );
    }
}

#[test]
fn what_needs_the_last_frame_is_not_tried_at_cuts() {
    let mut chooser = Chooser::new(MEMORIES.into());
    let chosen = run(&mut chooser, 0..60, cuts, |candidate, _| [32.0, 486.0, 262.0][candidate]);
    assert!(!chosen.contains(&EOVC), "{chosen:?}");
    assert_eq!(chosen.iter().filter(|candidate| **candidate == FRUSTUM).count(), 1, "{chosen:?}");
}

#[test]
fn a_cut_does_not_spoil_what_is_known_of_calm_frames() {
    let pace = |frame: usize| if frame % 20 == 19 { Pace::Cut } else { Pace::Calm };
    let ms = |candidate: usize, frame: usize| match (pace(frame), candidate) {
        (Pace::Cut, EOVC) => 500.0,
        (Pace::Cut, _) => 60.0,
        (_, ITERATIVE) => 30.0,
        (_, EOVC) => 20.0,
        _ => 250.0,
    };
    let mut chooser = Chooser::new(MEMORIES.into());
    let chosen = run(&mut chooser, 0..400, pace, ms);
    let late = &chosen[200..];
    let right = late
        .iter()
        .enumerate()
        .filter(|(frame, candidate)| **candidate == if pace(200 + frame) == Pace::Cut { ITERATIVE } else { EOVC });
    assert!(right.count() >= late.len() - 2, "{late:?}");
}

#[test]
fn one_slow_frame_changes_nothing() {
    let ms = |candidate: usize, frame: usize| [20.0, 21.0, 90.0][candidate] * if frame == 40 { 10.0 } else { 1.0 };
    let mut chooser = Chooser::new(MEMORIES.into());
    let chosen = run(&mut chooser, 0..100, calm, ms);
    assert!(chosen[39..].windows(2).all(|pair| pair[0] == pair[1]), "{:?}", &chosen[35..60]);
}

#[test]
fn noise_is_no_reason_to_change() {
    // Two that cost the same but for noise of a fifth, which is what this machine gives.
    let noise = |frame: usize| 1.0 + 0.2 * (((frame * 7919) % 101) as f64 / 50.5 - 1.0);
    let ms = |candidate: usize, frame: usize| [20.0, 20.5, 90.0][candidate] * noise(frame + 13 * candidate);
    let mut chooser = Chooser::new(MEMORIES.into());
    let chosen = run(&mut chooser, 0..600, calm, ms);
    let changes = chosen[10..].windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(changes <= 6, "{changes} changes: {chosen:?}");
}

#[test]
fn a_scene_that_changes_is_tried_again() {
    // Into the open: what was hidden is not any more, and culling does not pay.
    let ms = |candidate: usize, frame: usize| {
        if frame < 100 {
            [20.0, 30.0, 60.0][candidate]
        } else {
            [90.0, 95.0, 60.0][candidate]
        }
    };
    let mut chooser = Chooser::new(MEMORIES.into());
    let chosen = run(&mut chooser, 0..200, calm, ms);
    assert!(chosen[20..100].iter().all(|candidate| *candidate == ITERATIVE));
    assert!(chosen[130..].iter().all(|candidate| *candidate == FRUSTUM), "{:?}", &chosen[100..140]);
}

#[test]
fn an_oscillating_scene_costs_little_more_than_the_better_fixed_choice() {
    // The better method changes every 5 frames: whoever follows is always late.
    let ms = |candidate: usize, frame: usize| match (candidate, frame / 5 % 2) {
        (ITERATIVE, 0) | (EOVC, 1) => 20.0,
        (FRUSTUM, _) => 100.0,
        _ => 30.0,
    };
    let mut chooser = Chooser::new(MEMORIES.into());
    let chosen = run(&mut chooser, 0..500, calm, ms);
    let fixed = total(&[ITERATIVE; 500], ms).min(total(&[EOVC; 500], ms));
    assert!(total(&chosen, ms) < 1.1 * fixed, "{} against {fixed}", total(&chosen, ms));
}

#[test]
fn without_measures_the_first_candidate_stays() {
    let mut chooser = Chooser::new(MEMORIES.into());
    for pace in [Pace::Calm, Pace::Cut, Pace::Hurried, Pace::Calm] {
        assert_eq!(chooser.choose(pace).candidate, ITERATIVE);
    }
}

#[test]
fn looking_ahead_says_what_is_chosen() {
    let mut chooser = Chooser::new(MEMORIES.into());
    for frame in 0..40 {
        let pace = [Pace::Calm, Pace::Hurried, Pace::Cut][frame / 3 % 3];
        let ahead = chooser.look_ahead(pace);
        assert_eq!(ahead, chooser.choose(pace));
        chooser.measured([20.0, 25.0, 22.0][ahead.candidate]);
    }
}
