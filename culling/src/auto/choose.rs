//! Which method next? Plain code over measured frame times: no device, no clock, so that recorded traces test it.
//!
//! Times are kept by candidate and by *pace*, how fast the view changes, as what a method costs depends on how well its last frame predicts
//! this one. Each candidate is tried a few frames at each pace at which it can be any good; the cheapest then stays until another is
//! clearly cheaper (hysteresis), or until its own times have drifted so far that all are tried again. Between, others are tried again for a
//! small share of all time: those that are nearly as good often, those far behind seldom. What is known at a pace is kept for when that comes
//! back.

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
            Reason::Tried => "tried: its time at this pace is not known, or old",
            Reason::First => "nothing is measured yet",
            Reason::Kept => "nothing is clearly cheaper",
            Reason::Cheaper => "cheaper by what was measured",
        })
    }
}

/// Frames of a trial of what remembers a last frame, the first of which only warms it up.
const TRIAL_FRAMES: u32 = 3;
/// Frames of a trial of what remembers nothing.
const BRIEF_TRIAL_FRAMES: u32 = 2;
/// A trial ends with the first frame that takes more than this many times the best one's time; nor is such a candidate tried again
/// because the best one has drifted.
const HOPELESS: f64 = 3.0;
/// Another candidate must take less than this share of the current one's time,
const CLEARLY: f64 = 0.95;
/// for so many frames in a row at one pace: a slow frame or two are noise.
const PATIENCE: u32 = 4;
/// How far a time may drift from what it was when all were tried, either way, before all are tried again,
const DRIFT: f64 = 1.6;
/// for so many frames in a row: one slow frame is noise.
const DRIFT_FRAMES: u32 = 6;
/// What trying again may cost beyond the best choice, of all time: a candidate that is nearly as good is tried often, and one that is far
/// behind seldom.
const SPENT: f64 = 0.02;
/// Frames at one pace between two trials of a candidate, at least.
const REST: u32 = 32;
/// Times that are kept of a candidate: their median is what it takes. An odd number of noisy ones, and few enough to follow the scene.
const RECENT: usize = 7;

/// What is known of a candidate at a pace.
#[derive(Clone, Debug, Default)]
struct Cost {
    /// The last [`RECENT`] times, oldest first.
    recent: Vec<f64>,
    /// What it took when all were last tried.
    tried: Option<f64>,
    /// What its last trial's first frame took, if that only warmed it up.
    cold: Option<f64>,
    /// Frames of the running trial.
    frames: u32,
    /// What it may cost to try it again, ms.
    allowance: f64,
    /// Frames since it was tried.
    rested: u32,
}

impl Cost {
    fn ms(&self) -> Option<f64> {
        let mut sorted = self.recent.clone();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.len() / 2;
        match sorted.len() % 2 {
            1 => Some(sorted[middle]),
            _ => Some(0.5 * (sorted.get(middle)? + sorted.get(middle.checked_sub(1)?)?)),
        }
    }

    fn add(&mut self, ms: f64) {
        if self.recent.len() == RECENT {
            self.recent.remove(0);
        }
        self.recent.push(ms);
    }

    /// Nothing is known but what it was like to begin.
    fn begin_trial(&mut self) {
        *self = Cost { cold: self.cold, ..Cost::default() };
    }
}

/// Chooses among candidates by measured frame times.
#[derive(Clone, Debug)]
pub struct Chooser {
    memories: Vec<Memory>,
    /// Candidates that may not be used now.
    barred: Vec<bool>,
    costs: Vec<[Cost; 3]>,
    current: Option<Choice>,
    /// By pace, what is used when nothing is on trial.
    settled: [Option<usize>; 3],
    /// By pace, frames in a row in which another candidate was clearly cheaper.
    outdone: [u32; 3],
    drifted: u32,
}

impl Chooser {
    /// For candidates that remember so; the first is used until anything is measured.
    ///
    /// # Panics
    /// Without candidates.
    pub fn new(memories: Vec<Memory>) -> Self {
        assert!(!memories.is_empty(), "there must be something to choose from");
        let costs = memories.iter().map(|_| Default::default()).collect();
        let barred = vec![false; memories.len()];
        Chooser { memories, barred, costs, current: None, settled: [None; 3], outdone: [0; 3], drifted: 0 }
    }

    /// A candidate may not be used from now on, or may again. The first always may.
    pub fn bar(&mut self, candidate: usize, barred: bool) {
        self.barred[candidate] = barred && candidate > 0;
    }

    /// What the next frame will use at this pace. Changes nothing.
    pub fn look_ahead(&self, pace: Pace) -> Choice {
        let choice = |candidate: usize, reason| Choice {
            candidate,
            reason,
            pace,
            predicted_ms: self.cost(candidate, pace).ms(),
            measured_ms: None,
        };
        if self.current.is_none_or(|current| current.measured_ms.is_none()) {
            return choice(self.current.map_or(0, |current| current.candidate), Reason::First);
        }
        let on_trial = |candidate: &usize| self.cost(*candidate, pace).frames < self.trial_frames(*candidate);
        if let Some(candidate) = self.worth_trying(pace).find(on_trial) {
            return choice(candidate, Reason::Tried);
        }
        let best = self.best(pace);
        match self.settled[pace as usize] {
            Some(settled) if self.barred[settled] => choice(best, Reason::Cheaper),
            Some(settled) if !self.is_outdone(pace) || self.outdone[pace as usize] + 1 < PATIENCE => {
                choice(settled, Reason::Kept)
            }
            // To begin with what needs a last frame takes long: it must be worth it.
            None if !self.outdoes(best, 0, pace) => choice(0, Reason::Cheaper),
            _ => choice(best, Reason::Cheaper),
        }
    }

    /// Chooses for the next frame.
    pub fn choose(&mut self, pace: Pace) -> Choice {
        let choice = self.look_ahead(pace);
        let at = pace as usize;
        match choice.reason {
            Reason::Kept if self.is_outdone(pace) => self.outdone[at] += 1,
            Reason::Kept => self.outdone[at] = 0,
            Reason::Cheaper => (self.settled[at], self.outdone[at]) = (Some(choice.candidate), 0),
            Reason::Tried | Reason::First => {}
        }
        self.current = Some(choice);
        choice
    }

    /// Told what the frame that was last chosen for took, milliseconds. Frames that were not measured are not told of.
    pub fn measured(&mut self, ms: f64) {
        let Some(current) = &mut self.current else { return };
        current.measured_ms = Some(ms);
        let Choice { candidate, pace, reason, .. } = *current;
        let (memory, trial_frames) = (self.memories[candidate], self.trial_frames(candidate));
        let others = self.worth_trying(pace).filter(|other| *other != candidate);
        let best_other = others.filter_map(|other| self.cost(other, pace).ms()).fold(f64::INFINITY, f64::min);
        let cost = &mut self.costs[candidate][row(memory, pace)];
        cost.frames = cost.frames.saturating_add(1);
        // What a trial begins with is the time of a method whose last frame is long ago.
        if memory != Memory::None && cost.frames == 1 {
            cost.cold = Some(ms);
            return;
        }
        cost.add(ms);
        if ms > HOPELESS * best_other {
            cost.frames = cost.frames.max(trial_frames);
        }
        let now = cost.ms().unwrap_or(ms);
        if cost.frames >= trial_frames && cost.tried.is_none() {
            cost.tried = Some(now);
        }
        let tried = cost.tried.unwrap_or(now);
        let has_drifted = now > DRIFT * tried || now * DRIFT < tried;
        if !matches!(reason, Reason::Kept | Reason::Cheaper) {
            return;
        }
        self.drifted = if has_drifted { self.drifted + 1 } else { 0 };
        if self.drifted >= DRIFT_FRAMES {
            self.try_all_again(pace, now.max(tried));
        } else {
            self.try_one_again(pace, candidate, now);
        }
    }

    /// Times have drifted: what is known of the others at this pace is old, unless it was hopeless: beside what the best took then, if the device
    /// has grown faster since, or beside what it takes now.
    fn try_all_again(&mut self, pace: Pace, best_ms: f64) {
        self.drifted = 0;
        for (memory, costs) in self.memories.iter().zip(&mut self.costs) {
            let cost = &mut costs[row(*memory, pace)];
            match cost.ms() {
                Some(ms) if ms > HOPELESS * best_ms => {}
                _ => cost.begin_trial(),
            }
        }
    }

    /// A frame went by: every other candidate may be tried again for its part of [`SPENT`] of that, once it has saved up what a trial is
    /// expected to cost beyond the current choice.
    fn try_one_again(&mut self, pace: Pace, current: usize, current_ms: f64) {
        let others: Vec<usize> = self.worth_trying(pace).filter(|other| *other != current).collect();
        let part = SPENT * current_ms / others.len().max(1) as f64;
        let mut ready = None;
        for other in others {
            let memory = self.memories[other];
            let counted = f64::from(BRIEF_TRIAL_FRAMES);
            let cost = &mut self.costs[other][row(memory, pace)];
            cost.allowance += part;
            cost.rested += 1;
            let beyond = |ms: Option<f64>| ms.map_or(0.0, |ms| (ms - current_ms).max(0.0));
            let price = beyond(cost.cold) + counted * beyond(cost.ms());
            if cost.rested >= REST && cost.allowance >= price {
                ready = ready.or(Some((other, row(memory, pace))));
            }
        }
        if let Some((other, row)) = ready {
            self.costs[other][row].begin_trial();
        }
    }

    /// The cheapest at a pace, as far as is known.
    fn best(&self, pace: Pace) -> usize {
        let time = |candidate: &usize| self.cost(*candidate, pace).ms().unwrap_or(f64::INFINITY);
        self.worth_trying(pace).min_by(|a, b| time(a).total_cmp(&time(b))).unwrap_or(0)
    }

    /// Another candidate is clearly cheaper than the one that is settled on.
    fn is_outdone(&self, pace: Pace) -> bool {
        self.settled[pace as usize].is_some_and(|settled| self.outdoes(self.best(pace), settled, pace))
    }

    /// One candidate is clearly cheaper than another, as far as is known.
    fn outdoes(&self, one: usize, other: usize, pace: Pace) -> bool {
        let time = |candidate: usize| self.cost(candidate, pace).ms().unwrap_or(f64::INFINITY);
        time(one) < CLEARLY * time(other)
    }

    fn worth_trying(&self, pace: Pace) -> impl Iterator<Item = usize> + '_ {
        let is_worth = move |candidate: &usize| {
            !self.barred[*candidate] && (pace == Pace::Calm || self.memories[*candidate] != Memory::Needs)
        };
        (0..self.memories.len()).filter(is_worth)
    }

    fn trial_frames(&self, candidate: usize) -> u32 {
        if self.memories[candidate] == Memory::None {
            BRIEF_TRIAL_FRAMES
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
