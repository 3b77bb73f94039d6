//! Runs methods through drills, and says what they lost.

use super::catalogue::{Drill, DrillId, CHANCE, FAMILIES};
use super::footprints::{covered, Covered};
use super::lab::{error_of, Lab};
use super::{settings, Random, Subject};
use crate::metrics::{FrameError, Truth};
use anyhow::Result;
use culling::VisibleSets;
use engine::Gpu;
use std::sync::Arc;

/// What to run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The methods.
    pub subjects: Vec<Subject>,
    /// The drills.
    pub drills: Vec<DrillId>,
    /// About how many bodies a drill has.
    pub bodies: usize,
    /// The picture's size, instead of the drills' own.
    pub size: Option<[u32; 2]>,
    /// Methods keep the settings given; otherwise each drill but those of seed 0 runs at settings by chance.
    pub as_given: bool,
}

/// What came out of some frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Drills run, once for each method.
    pub runs: u64,
    /// Objects, in each frame again.
    pub object_frames: u64,
    /// Visible objects that were not drawn.
    pub lost: u64,
    /// Pixels of another depth.
    pub differing: u64,
    /// Pixels of equal depth that show another object.
    pub ties: u64,
}

/// A family's line.
#[derive(Clone, Debug, Default)]
pub struct FamilyRow {
    /// All methods together.
    pub tally: Tally,
    /// What bounds had to spare.
    pub margin: Covered,
    /// Fewest pixels that a visible object owned, counted in the frames whose margin was measured.
    pub fewest_pixels: Option<u64>,
}

/// A method that broke its word.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The method, at the settings of that drill.
    pub subject: Subject,
    /// The drill.
    pub drill: DrillId,
    /// What was wrong, first frames first.
    pub faults: Vec<String>,
}

/// What a run found.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// By family, in the catalogue's order.
    pub families: Vec<FamilyRow>,
    /// By subject of the plan.
    pub methods: Vec<Tally>,
    /// Everything that went wrong.
    pub failures: Vec<Failure>,
    /// Boxes that do not hold what they promise to hold: drill, and what lies outside.
    pub broken_bounds: Vec<String>,
}

impl Plan {
    /// The subject of a drill: as given, or at settings by chance.
    pub fn subject(&self, index: usize, drill: DrillId) -> Subject {
        let subject = &self.subjects[index];
        if self.as_given || (drill.seed == 0 && drill.family().name != CHANCE) {
            return subject.clone();
        }
        let seed =
            subject.options.method().bytes().fold(drill.seed, |seed, byte| seed.wrapping_mul(31) + u64::from(byte));
        settings::by_chance(subject, &mut Random::new(seed ^ drill.family as u64))
    }

    /// The drill, in the plan's size.
    pub fn drill(&self, id: DrillId) -> Drill {
        let mut drill = id.make(self.bodies);
        if let Some(size) = self.size {
            (drill.case.size, drill.sizes) = (size, Vec::new());
        }
        drill
    }
}

/// Runs all of it. `progress` gets how many drills are done; an error of its own ends the run.
///
/// # Errors
/// A scene that the device refuses, and what `progress` returns. What a method or its validation layer objects to is a failure
/// among the others.
pub fn run(gpu: &Gpu, plan: &Plan, progress: &mut dyn FnMut(usize, &Outcome) -> Result<()>) -> Result<Outcome> {
    let mut outcome = Outcome {
        families: vec![FamilyRow::default(); FAMILIES.len()],
        methods: vec![Tally::default(); plan.subjects.len()],
        ..Outcome::default()
    };
    for (done, id) in plan.drills.iter().enumerate() {
        progress(done, &outcome)?;
        one_drill(gpu, plan, *id, &mut outcome)?;
    }
    progress(plan.drills.len(), &outcome)?;
    Ok(outcome)
}

fn one_drill(gpu: &Gpu, plan: &Plan, id: DrillId, outcome: &mut Outcome) -> Result<()> {
    let drill = plan.drill(id);
    let mut lab = Lab::new(gpu, &drill.case)?;
    let (truths, sets) = truths(&mut lab, &drill)?;
    let row = &mut outcome.families[id.family];
    measure(&mut lab, &drill, &truths, row, &mut outcome.broken_bounds)?;
    for (index, method) in outcome.methods.iter_mut().enumerate() {
        let subject = plan.subject(index, id);
        let (tally, faults) = match play(&mut lab, &subject, &drill, &truths, &sets) {
            Ok(errors) => (tally_of(&errors), faults_of(&errors)),
            Err(error) => (Tally::default(), vec![format!("{error:#}")]),
        };
        row.tally.add(&tally);
        method.add(&tally);
        if !faults.is_empty() {
            outcome.failures.push(Failure { subject, drill: id, faults });
        }
    }
    Ok(())
}

/// The truth of each frame, and the visible sets.
pub(super) fn truths(lab: &mut Lab, drill: &Drill) -> Result<(Vec<Truth>, Arc<VisibleSets>)> {
    let mut sets = VisibleSets::new(lab.world.len());
    let mut truths = Vec::new();
    for (frame, shot) in drill.case.shots.iter().enumerate() {
        fit(lab, drill.size(frame))?;
        let truth = lab.truth(shot)?;
        sets.push_items(&truth.images().items);
        truths.push(truth);
    }
    Ok((truths, Arc::new(sets)))
}

fn fit(lab: &mut Lab, size: [u32; 2]) -> Result<()> {
    if lab.size == size {
        return Ok(());
    }
    lab.resize(size)
}

/// A method's errors in each frame of a drill.
pub(super) fn play(
    lab: &mut Lab,
    subject: &Subject,
    drill: &Drill,
    truths: &[Truth],
    sets: &Arc<VisibleSets>,
) -> Result<Vec<FrameError>> {
    let mut method = lab.make(subject, sets)?;
    let mut errors = Vec::new();
    for (frame, shot) in drill.case.shots.iter().enumerate() {
        fit(lab, drill.size(frame))?;
        if drill.forgets.contains(&frame) {
            method.forget()?;
        }
        let take = lab.take(&mut *method, shot, frame)?;
        errors.push(error_of(&truths[frame], &take)?);
    }
    Ok(errors)
}

fn tally_of(errors: &[FrameError]) -> Tally {
    let sum = |value: fn(&FrameError) -> usize| errors.iter().map(|error| value(error) as u64).sum();
    Tally {
        runs: 1,
        object_frames: sum(|error| error.objects),
        lost: sum(|error| error.false_negatives),
        differing: sum(|error| error.differing_pixels + error.wrong_colour_pixels),
        ties: sum(|error| error.tied_pixels),
    }
}

impl Tally {
    fn add(&mut self, other: &Tally) {
        self.runs += other.runs;
        self.object_frames += other.object_frames;
        self.lost += other.lost;
        self.differing += other.differing;
        self.ties += other.ties;
    }
}

/// What an exact method may not do, frame by frame.
pub(super) fn faults_of(errors: &[FrameError]) -> Vec<String> {
    let wrong = |error: &FrameError| error.false_negatives + error.differing_pixels + error.wrong_colour_pixels > 0;
    let told = errors.iter().enumerate().filter(|(_, error)| wrong(error));
    told.map(|(frame, error)| {
        let FrameError { false_negatives, differing_pixels, wrong_colour_pixels, .. } = error;
        format!("frame {frame}: {false_negatives} lost, {differing_pixels} pixels differ, {wrong_colour_pixels} of wrong colour")
    })
    .collect()
}

/// What bounds have to spare, in the first and in the middle frame.
fn measure(
    lab: &mut Lab,
    drill: &Drill,
    truths: &[Truth],
    row: &mut FamilyRow,
    broken: &mut Vec<String>,
) -> Result<()> {
    let shots = &drill.case.shots;
    for frame in [0, shots.len() / 2] {
        fit(lab, drill.size(frame))?;
        let seen = covered(lab, &shots[frame], |_, _| ())?;
        let name = &drill.case.name;
        broken.extend(seen.outside.iter().map(|text| format!("{name}, frame {frame}: {text}")));
        broken.extend(seen.too_near.iter().map(|near| format!("{name}, frame {frame}: {}", near.text)));
        row.margin.join(seen);
        let mut pixels = std::collections::HashMap::<u32, u64>::new();
        let images = truths[frame].images();
        let items = images.items.iter().filter(|item| **item != crate::metrics::NO_ITEM);
        items.for_each(|item| *pixels.entry(*item).or_default() += 1);
        row.fewest_pixels = row.fewest_pixels.into_iter().chain(pixels.into_values().min()).min();
    }
    Ok(())
}
