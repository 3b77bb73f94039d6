//! `auto`: the method that costs least here and now. Which one that is depends on scene, camera and device, so it is measured: candidates
//! are tried for a few frames, the cheapest stays, and all are tried again when its times drift ([`choose`]). All candidates are exact, and
//! each draws an exact picture whatever its last frame was, so changing between them is exact as well. Only where errors are allowed
//! (`allow-error`) `woc` is a candidate too, as long as checks of some of its frames find no more of them ([`trust`]).
//!
//! Times come from who runs the frames ([`Method::measured`]); without any, the first candidate is used throughout.

pub mod choose;
pub mod trust;

use crate::hzb::iterative::hurry::Hurry;
use crate::woc::Woc;
use crate::{find, Method, OptionInfo, Options, Result, Setup, TestedBoxes, View, Work, World};
use choose::{Choice, Chooser, Memory, Pace};
use engine::{Frame, Target};
use std::collections::BTreeMap;
use trust::Trust;

/// Errors that are allowed. Who allows any asks for them: then `auto` is approximate.
pub const ALLOW_ERROR_OPTION: OptionInfo = OptionInfo {
    name: "allow-error",
    default: "0",
    values: "0|0.01|0.02|0.05|0.1|0.2|0.5|1|2|5|10",
    help: "also use woc where it costs least, while of the frames that are checked (one in 16) none misses more percent of its objects",
};

/// What `auto` says of itself with [`ALLOW_ERROR_OPTION`].
pub const ERRS: &str = "woc may be used, and of its frames one in 16 is checked for errors";

/// `skip`, `detail`, and how candidates take turns.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    ALLOW_ERROR_OPTION,
    OptionInfo {
        name: "by",
        default: "time",
        values: "time|turns",
        help: "choose by measured times, or let candidates take turns frame by frame: to test that changes are exact",
    },
];

/// What is chosen from. The first is used until anything is measured.
const CANDIDATES: [(&str, Memory); 4] = [
    ("hzb-iterative", Memory::Helps),
    ("eovc", Memory::Needs),
    ("frustum", Memory::None),
    // Where little is hidden and objects are few: monsters.
    ("roc-iterative", Memory::Helps),
];

/// What is chosen from beside them where errors are allowed.
const CHECKED: (&str, Memory) = ("woc", Memory::Needs);

/// Shares of the picture that are new from which on a frame is hurried, or a cut.
const PACES: [f64; 2] = [0.12, 0.6];

/// The pace of a frame that shows this share of its picture anew.
fn pace_of(new_share: f64) -> Pace {
    match PACES.iter().filter(|share| new_share > **share).count() {
        0 => Pace::Calm,
        1 => Pace::Hurried,
        _ => Pace::Cut,
    }
}

/// Choices that are kept.
const MOST_LOGGED: usize = 1 << 16;

/// `woc` with what is thought of it.
struct Checked {
    woc: Woc,
    trust: Trust,
    /// The last frame was its, and checked.
    checks: bool,
    /// What checked frames would have missed, percent, by their place in the log.
    found: BTreeMap<usize, Option<f64>>,
}

struct Auto {
    candidates: Vec<Box<dyn Method>>,
    /// The last candidate, where errors are allowed.
    checked: Option<Checked>,
    chooser: Chooser,
    /// Candidates take turns.
    turns: bool,
    hurry: Hurry,
    /// Frames since what came before was forgotten.
    frames: usize,
    /// The choices of the first frames, [`MOST_LOGGED`] at most.
    log: Vec<Choice>,
    /// Choices are taken from the log, at this place.
    repeats: Option<usize>,
    /// What the last frame used.
    last: usize,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let options_of = |id: &str| {
        let entry = find(id)?;
        let mut options = Options::new(entry.id, entry.options);
        for name in [crate::world::SKIP_OPTION.name, crate::world::DETAIL_OPTION.name] {
            options.set(name, setup.options.text(name))?;
        }
        Ok::<_, crate::Error>((entry, options))
    };
    let candidate = |(id, _): &(&str, Memory)| {
        let (entry, options) = options_of(id)?;
        (entry.make)(&Setup { options: &options, visible: None, ..*setup })
    };
    let allowed: f64 = setup.options.text(ALLOW_ERROR_OPTION.name).parse().unwrap_or(0.0);
    let checked = match allowed > 0.0 {
        true => {
            let (_, options) = options_of(CHECKED.0)?;
            let woc = crate::woc::make_checked(&Setup { options: &options, visible: None, ..*setup })?;
            Some(Checked { woc, trust: Trust::new(allowed), checks: false, found: BTreeMap::new() })
        }
        false => None,
    };
    let memories = CANDIDATES.iter().chain(checked.as_ref().map(|_| &CHECKED)).map(|(_, memory)| *memory);
    Ok(Box::new(Auto {
        candidates: CANDIDATES.iter().map(candidate).collect::<Result<_>>()?,
        chooser: Chooser::new(memories.collect()),
        checked,
        turns: setup.options.text("by") == "turns",
        hurry: Hurry::new(None, setup.world),
        frames: 0,
        log: Vec::new(),
        repeats: None,
        last: 0,
    }))
}

impl Auto {
    /// What the next frame uses. Changes nothing.
    fn look_ahead(&self, view: &View) -> Choice {
        let choice = self.chooser.look_ahead(pace_of(self.hurry.new_share(view)));
        if self.turns {
            let count = self.candidates.len() + usize::from(self.checked.is_some());
            return Choice { candidate: self.frames % count, ..choice };
        }
        self.repeats.and_then(|place| self.log.get(place).copied()).unwrap_or(choice)
    }
}

impl Auto {
    fn candidate(&self, index: usize) -> &dyn Method {
        match &self.checked {
            Some(checked) if index == self.candidates.len() => &checked.woc,
            _ => self.candidates[index].as_ref(),
        }
    }

    fn each(&mut self) -> impl Iterator<Item = &mut dyn Method> {
        let checked = self.checked.as_mut().map(|checked| &mut checked.woc as &mut dyn Method);
        self.candidates.iter_mut().map(|candidate| candidate.as_mut() as &mut dyn Method).chain(checked)
    }
}

impl Method for Auto {
    fn prepare(&mut self, world: &World, view: &View) -> Result<()> {
        self.each().try_for_each(|candidate| candidate.prepare(world, view))
    }

    fn needs_items(&self, world: &World, view: &View) -> bool {
        self.candidate(self.look_ahead(view).candidate).needs_items(world, view)
    }

    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        let choice = self.look_ahead(view);
        match &mut self.repeats {
            Some(place) if *place < self.log.len() => *place += 1,
            _ => {
                self.repeats = None;
                self.chooser.choose(choice.pace);
                if self.log.len() < MOST_LOGGED {
                    self.log.push(choice);
                }
            }
        }
        self.hurry.look(view);
        self.frames += 1;
        self.last = choice.candidate;
        if let Some(checked) = &mut self.checked {
            let used = choice.candidate == self.candidates.len();
            checked.checks = checked.trust.begin(used);
            checked.woc.check(checked.checks);
            if used {
                return checked.woc.frame(f, world, view, target);
            }
        }
        self.candidates[choice.candidate].frame(f, world, view, target)
    }

    fn measured(&mut self, frame_ms: f64) {
        if self.repeats.is_some() || self.turns {
            return;
        }
        self.chooser.measured(frame_ms);
        if let Some(Checked { woc, trust, checks, found }) = &mut self.checked {
            if *checks {
                let percent = woc.repaired_percent().unwrap_or(None);
                trust.judge(percent);
                found.insert(self.log.len().saturating_sub(1), percent);
            }
            self.chooser.bar(self.candidates.len(), !trust.allows());
        }
        if let Some(choice) = self.log.last_mut().filter(|choice| choice.measured_ms.is_none()) {
            choice.measured_ms = Some(frame_ms);
        }
    }

    fn repeat(&mut self) {
        self.repeats = Some(0);
    }

    fn choices(&self) -> Vec<String> {
        let ms = |ms: Option<f64>| ms.map_or("-".to_owned(), |ms| format!("{ms:.2}"));
        let line = |(frame, choice): (usize, &Choice)| {
            let Choice { candidate, reason, pace, predicted_ms, measured_ms } = choice;
            let (id, _) = CANDIDATES.get(*candidate).unwrap_or(&CHECKED);
            let (predicted, measured) = (ms(*predicted_ms), ms(*measured_ms));
            let check = match self.checked.as_ref().and_then(|checked| checked.found.get(&frame)) {
                Some(Some(percent)) => format!("; checked: would have missed {percent:.3} % at most"),
                Some(None) => "; checked: nothing was predicted".to_owned(),
                None => String::new(),
            };
            format!("frame {frame}: {id}, {pace:?} ({reason}); predicted {predicted} ms, took {measured} ms{check}")
        };
        self.log.iter().enumerate().map(line).collect()
    }

    fn count_work(&mut self, on: bool) {
        self.each().for_each(|candidate| candidate.count_work(on));
    }

    fn work(&self) -> Result<Work> {
        self.candidate(self.last).work()
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        self.candidate(self.last).tested_boxes(world)
    }

    fn forget(&mut self) -> Result<()> {
        self.hurry.forget();
        self.frames = 0;
        if let Some(checked) = &mut self.checked {
            checked.trust.forget();
        }
        self.each().try_for_each(|candidate| candidate.forget())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_hurried_above_twelve_percent_and_a_cut_above_sixty() {
        let paces = [0.0, 0.119, 0.121, 0.3, 0.599, 0.601, 1.0].map(pace_of);
        let expected = [Pace::Calm, Pace::Calm, Pace::Hurried, Pace::Hurried, Pace::Hurried, Pace::Cut, Pace::Cut];
        assert_eq!(paces, expected);
    }

    /// At a cut `eovc` takes many times as long as others, and `frustum` takes as long in any frame.
    #[test]
    fn candidates_remember_as_their_methods_do() {
        let of = |id: &str| CANDIDATES.iter().find(|candidate| candidate.0 == id).map(|candidate| candidate.1);
        assert_eq!(CANDIDATES[0].0, "hzb-iterative", "used until anything is measured");
        assert_eq!([of("eovc"), of("frustum")], [Some(Memory::Needs), Some(Memory::None)]);
        assert_eq!([of("hzb-iterative"), of("roc-iterative")], [Some(Memory::Helps); 2]);
        assert_eq!(CHECKED, ("woc", Memory::Needs));
    }
}
