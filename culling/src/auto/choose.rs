//! Which method next? Plain code over measured frame times: no device, no clock, so that recorded traces test it.
//!
//! Times are kept by candidate and by *pace*, how fast the view changes, as what a method costs depends on how well its last frame predicts
//! this one. Each candidate is tried a few frames at each pace at which it can be any good; the cheapest then stays until another is
//! clearly cheaper (hysteresis), or until its own times have drifted so far that all are tried again.

use std::fmt;

/// How fast the view changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// The picture is nearly that of the last frame.
    Calm,
    /// A part of it is new.
    Hurried,
    /// Most of it is new.
    Cut,
}

/// What a candidate's times depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// On this frame alone: one time for all paces, and nothing to warm up.
    None,
    /// On the last frame, but not for its worth at any pace.
    Helps,
    /// On the last frame: not worth trying when that does not predict this one.
    Needs,
}

/// Why a candidate is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// Its time at this pace is not known yet, or known no more.
    Tried,
    /// Nothing is measured yet.
    First,
    /// It was used in the last frame, and nothing is clearly cheaper.
    Kept,
    /// It is predicted to take less than the one before.
    Cheaper,
}

/// A choice and what it was made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Which candidate.
    pub candidate: usize,
    /// Why.
    pub reason: Reason,
    /// How fast the view changes.
    pub pace: Pace,
    /// What it is predicted to take, milliseconds; none if it was never measured at this pace.
    pub predicted_ms: Option<f64>,
    /// What it took, once that is known.
    pub measured_ms: Option<f64>,
}

impl fmt::Display for Reason {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Reason::Tried => "tried: its time at this pace is not known",
            Reason::First => "nothing is measured yet",
            Reason::Kept => "nothing is clearly cheaper",
            Reason::Cheaper => "cheaper by what was measured",
        })
    }
}

/// Frames of a trial, the first of which only warms up what remembers a last frame.
const TRIAL_FRAMES: u32 = 3;
/// Another candidate must take less than this share of the current one's time.
const CLEARLY: f64 = 0.9;
/// For so many frames in a row at one pace, but right after a trial: a slow frame or two are noise.
const PATIENCE: u32 = 4;
/// How far a time may drift from what it was when all were tried, either way, before all are tried again.
const DRIFT: f64 = 1.6;
/// For so many frames in a row: one slow frame is noise.
const DRIFT_FRAMES: u32 = 6;
/// A candidate that took more than this many times the best one's time is not tried again for drift of the best alone.
const HOPELESS: f64 = 3.0;
/// What a new time counts in a mean of times.
const NEWEST: f64 = 0.25;
/// A time counts at most this many times the mean: one slow frame must not decide.
const OUTLIER: f64 = 2.0;

#[derive(Clone, Copy, Debug, Default)]
struct Cost {
    /// A running mean, ms.
    mean: Option<f64>,
    /// The mean when all were last tried.
    tried: Option<f64>,
    /// Frames of the running trial.
    frames: u32,
}

/// Chooses among candidates by measured frame times.
#[derive(Clone, Debug)]
pub struct Chooser {
    memories: Vec<Memory>,
    costs: Vec<[Cost; 3]>,
    current: Option<Choice>,
    drifted: u32,
    /// Frames in a row in which another candidate was clearly cheaper.
    outdone: u32,
}

impl Chooser {
    /// For candidates that remember so; the first is used until anything is measured.
    ///
    /// # Panics
    /// Without candidates.
    pub fn new(memories: Vec<Memory>) -> Self {
        assert!(!memories.is_empty(), "there must be something to choose from");
        let costs = vec![[Cost::default(); 3]; memories.len()];
        Chooser { memories, costs, current: None, drifted: 0, outdone: 0 }
    }

    /// What the next frame will use at this pace. Changes nothing.
    pub fn look_ahead(&self, pace: Pace) -> Choice {
        let choice = |candidate: usize, reason| Choice {
            candidate,
            reason,
            pace,
            predicted_ms: self.cost(candidate, pace).mean,
            measured_ms: None,
        };
        if self.current.is_none_or(|current| current.measured_ms.is_none()) {
            return choice(self.current.map_or(0, |current| current.candidate), Reason::First);
        }
        let on_trial = |candidate: &usize| self.cost(*candidate, pace).frames < self.trial_frames(*candidate);
        if let Some(candidate) = self.worth_trying(pace).find(on_trial) {
            return choice(candidate, Reason::Tried);
        }
        let time = |candidate: &usize| self.cost(*candidate, pace).mean.unwrap_or(f64::INFINITY);
        let best = self.worth_trying(pace).min_by(|a, b| time(a).total_cmp(&time(b))).unwrap_or(0);
        let current = self.current.map_or(best, |current| current.candidate);
        let is_worth = self.worth_trying(pace).any(|candidate| candidate == current);
        match is_worth && (!self.is_outdone(pace) || self.is_settled(pace) && self.outdone + 1 < PATIENCE) {
            true => choice(current, Reason::Kept),
            false => choice(best, Reason::Cheaper),
        }
    }

    /// Chooses for the next frame.
    pub fn choose(&mut self, pace: Pace) -> Choice {
        let choice = self.look_ahead(pace);
        let still_outdone = choice.reason == Reason::Kept && self.is_settled(pace) && self.is_outdone(pace);
        self.outdone = if still_outdone { self.outdone + 1 } else { 0 };
        self.current = Some(choice);
        choice
    }

    /// Told what the frame that was last chosen for took, milliseconds. Frames that were not measured are not told of.
    pub fn measured(&mut self, ms: f64) {
        let Some(current) = &mut self.current else { return };
        current.measured_ms = Some(ms);
        let Choice { candidate, pace, .. } = *current;
        let (memory, trial_frames) = (self.memories[candidate], self.trial_frames(candidate));
        let cost = &mut self.costs[candidate][row(memory, pace)];
        cost.frames += 1;
        // What a trial begins with is the time of a method whose last frame is long ago.
        if memory != Memory::None && cost.frames < trial_frames && cost.frames == 1 {
            return;
        }
        let mean = cost.mean.filter(|_| cost.tried.is_some());
        cost.mean = Some(match (mean, cost.mean) {
            (Some(mean), _) => mean + NEWEST * (ms.min(OUTLIER * mean) - mean),
            (None, Some(first)) => first.min(ms),
            (None, None) => ms,
        });
        if cost.frames >= trial_frames && cost.tried.is_none() {
            cost.tried = cost.mean;
        }
        let (mean, tried) = (cost.mean.unwrap_or(ms), cost.tried.unwrap_or(ms));
        let has_drifted = mean > DRIFT * tried || mean * DRIFT < tried;
        self.drifted = if has_drifted { self.drifted + 1 } else { 0 };
        if self.drifted >= DRIFT_FRAMES {
            self.try_again(pace, mean);
        }
    }

    /// Times have drifted: what is known of the others at this pace is old, unless it was hopeless.
    fn try_again(&mut self, pace: Pace, best_ms: f64) {
        self.drifted = 0;
        for (memory, costs) in self.memories.iter().zip(&mut self.costs) {
            let cost = &mut costs[row(*memory, pace)];
            match cost.mean {
                Some(mean) if mean > HOPELESS * best_ms => {}
                _ => *cost = Cost::default(),
            }
        }
    }

    /// Another candidate is clearly cheaper than the one in use.
    fn is_outdone(&self, pace: Pace) -> bool {
        let time = |candidate: usize| self.cost(candidate, pace).mean.unwrap_or(f64::INFINITY);
        let best = self.worth_trying(pace).map(time).fold(f64::INFINITY, f64::min);
        self.current.is_some_and(|current| best < CLEARLY * time(current.candidate))
    }

    /// The last frame used the one in use for its cost at this pace.
    fn is_settled(&self, pace: Pace) -> bool {
        self.current.is_some_and(|current| current.pace == pace && current.reason != Reason::Tried)
    }

    fn worth_trying(&self, pace: Pace) -> impl Iterator<Item = usize> + '_ {
        let is_worth = move |candidate: &usize| pace == Pace::Calm || self.memories[*candidate] != Memory::Needs;
        (0..self.memories.len()).filter(is_worth)
    }

    fn trial_frames(&self, candidate: usize) -> u32 {
        if self.memories[candidate] == Memory::None {
            1
        } else {
            TRIAL_FRAMES
        }
    }

    fn cost(&self, candidate: usize, pace: Pace) -> &Cost {
        &self.costs[candidate][row(self.memories[candidate], pace)]
    }
}

/// Where times of a pace are kept.
fn row(memory: Memory, pace: Pace) -> usize {
    if memory == Memory::None {
        0
    } else {
        pace as usize
    }
}

#[cfg(test)]
mod tests;
