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
        // The other is tried again once, for three frames.
        assert!(chosen[8..].iter().filter(|candidate| !fine(candidate)).count() <= 3, "{times:?}: {chosen:?}");
        // Where it is far behind, its trial ends with its first frame.
        let frustum = chosen.iter().filter(|candidate| **candidate == FRUSTUM).count();
        assert!(if best == FRUSTUM { frustum > 20 } else { frustum == 1 }, "{times:?}: {chosen:?}");
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
    // Once or twice another is tried again.
    assert!(right.count() >= late.len() - 6, "{late:?}");
}

#[test]
fn one_slow_frame_changes_nothing() {
    let film = |slow: Option<usize>| {
        let ms = |candidate: usize, frame: usize| {
            [20.0, 21.0, 90.0][candidate] * if Some(frame) == slow { 10.0 } else { 1.0 }
        };
        run(&mut Chooser::new(MEMORIES.into()), 0..100, calm, ms)
    };
    let usual = film(None);
    let best = |frame: &usize| usual[*frame] == ITERATIVE;
    let settled: Vec<usize> = (10..100).filter(best).collect();
    assert!(settled.len() > 80, "{usual:?}");
    for slow in settled {
        assert_eq!(film(Some(slow)), usual, "frame {slow}");
    }
}

/// Times that go up and down by a share, which depends on the frame and the candidate alone: what another machine's user does.
fn noise(share: f64, frame: usize, candidate: usize) -> f64 {
    1.0 + share * ((((frame + 13 * candidate) * 7919) % 101) as f64 / 50.0 - 1.0)
}

#[test]
fn noise_is_no_reason_to_change() {
    // Two that cost the same but for noise of a fifth, which is what this machine gives.
    let ms = |candidate: usize, frame: usize| [20.0, 20.5, 90.0][candidate] * noise(0.2, frame, candidate);
    let mut chooser = Chooser::new(MEMORIES.into());
    let mut reasons = Vec::new();
    for frame in 0..600 {
        let choice = chooser.choose(Pace::Calm);
        chooser.measured(ms(choice.candidate, frame));
        reasons.push(choice.reason);
    }
    let changes = reasons[10..].iter().filter(|reason| **reason == Reason::Cheaper).count();
    assert!(changes <= 6, "{changes} changes: {reasons:?}");
}

/// The goal of the whole: 1.05 times the best fixed choice, trials included, after the first of them.
#[test]
fn under_noise_the_choice_costs_hardly_more_than_the_best_fixed_one() {
    let all = [[24.0, 22.0, 245.0], [22.0, 24.0, 245.0], [25.0, 40.0, 18.0], [60.0, 50.0, 57.0], [10.0, 11.0, 10.5]];
    for times in all {
        for pace in [calm as fn(usize) -> Pace, cuts] {
            let at_cuts = pace(0) == Pace::Cut;
            let ms = |candidate: usize, frame: usize| {
                // What needs a last frame takes long without one.
                let without = if at_cuts && candidate == EOVC { 8.0 } else { 1.0 };
                times[candidate] * without * noise(0.4, frame, candidate)
            };
            let mut chooser = Chooser::new(MEMORIES.into());
            let chosen = run(&mut chooser, 0..1000, pace, ms);
            let late = |of: &[usize]| of.iter().enumerate().skip(12).map(|(frame, at)| ms(*at, frame)).sum::<f64>();
            let best = (0..3).map(|candidate| late(&[candidate; 1000])).fold(f64::INFINITY, f64::min);
            assert!(late(&chosen) <= 1.05 * best, "{times:?}: {} of {best}: {chosen:?}", late(&chosen));
        }
    }
}

/// A first trial in an unlucky moment is made up for.
#[test]
fn an_unlucky_trial_is_not_for_ever() {
    let unlucky = |frame: usize, candidate: usize| if candidate == FRUSTUM && frame < 12 { 1.7 } else { 1.0 };
    let ms = |candidate: usize, frame: usize| [75.0, 80.0, 57.0][candidate] * unlucky(frame, candidate);
    let mut chooser = Chooser::new(MEMORIES.into());
    let chosen = run(&mut chooser, 0..400, cuts, ms);
    let right = chosen[200..].iter().filter(|candidate| **candidate == FRUSTUM).count();
    assert!(right > 180, "{right} of 200: {chosen:?}");
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
fn who_is_barred_is_not_used_and_comes_back_when_it_may() {
    let ms = |candidate: usize, _: usize| [24.0, 12.0, 90.0][candidate];
    let mut chooser = Chooser::new(MEMORIES.into());
    assert!(run(&mut chooser, 0..20, calm, ms)[12..].iter().all(|candidate| *candidate == EOVC));
    chooser.bar(EOVC, true);
    assert!(run(&mut chooser, 20..200, calm, ms).iter().all(|candidate| *candidate != EOVC));
    chooser.bar(EOVC, false);
    assert!(run(&mut chooser, 200..240, calm, ms)[20..].iter().all(|candidate| *candidate == EOVC));
    // The first is what is left when all else is barred.
    (0..3).for_each(|candidate| chooser.bar(candidate, true));
    assert!(run(&mut chooser, 240..260, calm, ms).iter().all(|candidate| *candidate == ITERATIVE));
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

/// Recorded on an H200, pandora.glb at 16 times the speed: the device's clock rose fourfold while the last candidate was tried. The best is then
/// four times as fast as anything was known to be, which says nothing of the others.
#[test]
fn a_device_that_grows_faster_is_no_proof_against_what_was_tried_before() {
    const MEMORIES: [Memory; 4] = [Memory::Helps, Memory::Needs, Memory::None, Memory::Helps];
    let ms = |candidate: usize, frame: usize| [0.71, 1.26, 0.60, 0.88][candidate] * if frame < 10 { 4.5 } else { 1.0 };
    let mut chooser = Chooser::new(MEMORIES.into());
    let chosen = run(&mut chooser, 0..60, calm, ms);
    assert!(chosen[40..].iter().all(|candidate| *candidate == FRUSTUM), "{chosen:?}");
}

/// Recorded on an H200, factory at 16 times the speed: eovc seemed a hundredth cheaper, and took 10.7 ms to begin with.
#[test]
fn what_is_hardly_cheaper_is_not_begun_with() {
    let ms = |candidate: usize, _: usize| [1.225, 1.215, 1.41][candidate];
    let chosen = run(&mut Chooser::new(MEMORIES.into()), 0..30, calm, ms);
    assert!(chosen[8..].iter().all(|candidate| *candidate == ITERATIVE), "{chosen:?}");
}
