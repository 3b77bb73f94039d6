//! `auto`: the method that costs least here and now. Which one that is depends on scene, camera and device, so it is measured: candidates
//! are tried for a few frames, the cheapest stays, and all are tried again when its times drift ([`choose`]). All candidates are exact, and
//! each draws an exact picture whatever its last frame was, so changing between them is exact as well.
//!
//! Times come from who runs the frames ([`Method::measured`]); without any, the first candidate is used throughout.

pub mod choose;

use crate::hzb::iterative::hurry::Hurry;
use crate::{find, Method, OptionInfo, Options, Result, Setup, TestedBoxes, View, Work, World};
use choose::{Choice, Chooser, Memory, Pace};
use engine::{Frame, Target};

/// `skip`, `detail`, and how candidates take turns.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    OptionInfo {
        name: "by",
        default: "time",
        values: "time|turns",
        help: "choose by measured times, or let candidates take turns frame by frame: to test that changes are exact",
    },
];

/// What is chosen from. The first is used until anything is measured.
const CANDIDATES: [(&str, Memory); 3] =
    [("hzb-iterative", Memory::Helps), ("eovc", Memory::Needs), ("frustum", Memory::None)];

/// Shares of the picture that are new from which on a frame is hurried, or a cut.
const PACES: [f64; 2] = [0.12, 0.6];

/// Choices that are kept.
const MOST_LOGGED: usize = 1 << 16;

struct Auto {
    candidates: Vec<Box<dyn Method>>,
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
    let candidate = |(id, _): &(&str, Memory)| {
        let entry = find(id)?;
        let mut options = Options::new(entry.id, entry.options);
        for name in [crate::world::SKIP_OPTION.name, crate::world::DETAIL_OPTION.name] {
            options.set(name, setup.options.text(name))?;
        }
        (entry.make)(&Setup { options: &options, visible: None, ..*setup })
    };
    Ok(Box::new(Auto {
        candidates: CANDIDATES.iter().map(candidate).collect::<Result<_>>()?,
        chooser: Chooser::new(CANDIDATES.iter().map(|(_, memory)| *memory).collect()),
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
        let new = self.hurry.new_share(view);
        let pace = match PACES.iter().filter(|share| new > **share).count() {
            0 => Pace::Calm,
            1 => Pace::Hurried,
            _ => Pace::Cut,
        };
        let choice = self.chooser.look_ahead(pace);
        if self.turns {
            return Choice { candidate: self.frames % self.candidates.len(), ..choice };
        }
        self.repeats.and_then(|place| self.log.get(place).copied()).unwrap_or(choice)
    }
}

impl Method for Auto {
    fn prepare(&mut self, world: &World, view: &View) -> Result<()> {
        self.candidates.iter_mut().try_for_each(|candidate| candidate.prepare(world, view))
    }

    fn needs_items(&self, world: &World, view: &View) -> bool {
        self.candidates[self.look_ahead(view).candidate].needs_items(world, view)
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
        self.candidates[choice.candidate].frame(f, world, view, target)
    }

    fn measured(&mut self, frame_ms: f64) {
        if self.repeats.is_some() || self.turns {
            return;
        }
        self.chooser.measured(frame_ms);
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
            let id = CANDIDATES[*candidate].0;
            let (predicted, measured) = (ms(*predicted_ms), ms(*measured_ms));
            format!("frame {frame}: {id}, {pace:?} ({reason}); predicted {predicted} ms, took {measured} ms")
        };
        self.log.iter().enumerate().map(line).collect()
    }

    fn count_work(&mut self, on: bool) {
        self.candidates.iter_mut().for_each(|candidate| candidate.count_work(on));
    }

    fn work(&self) -> Result<Work> {
        self.candidates[self.last].work()
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        self.candidates[self.last].tested_boxes(world)
    }

    fn forget(&mut self) -> Result<()> {
        self.hurry.forget();
        self.frames = 0;
        self.candidates.iter_mut().try_for_each(|candidate| candidate.forget())
    }
}
