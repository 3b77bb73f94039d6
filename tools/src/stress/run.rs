//! Runs methods through drills, and says what they lost.

use super::catalogue::{Drill, DrillId, CHANCE, FAMILIES};
use super::conditions::judged;
use super::footprints::{covered, Covered};
use super::lab::{Lab, Take};
use super::{settings, Random, Subject};
use crate::measures::metrics::{FrameError, FrameImages, Truth};
use anyhow::Result;
use culling::{Method, VisibleSets};
use engine::Gpu;
use std::hash::{DefaultHasher, Hash, Hasher};
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
    /// Pixels outside the raster conditions that explain what was lost or differs there: counted here alone.
    pub thin: u64,
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
        let seed = subject
            .options
            .method()
            .bytes()
            .fold(drill.seed, |seed, byte| seed.wrapping_mul(31).wrapping_add(u64::from(byte)));
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
        // Every second drill is run again: what was drawn must be drawn again, to the bit.
        let (tally, faults) = match tried(&mut lab, &subject, &drill, (&truths, &sets), id.seed.is_multiple_of(2)) {
            Ok(verdict) => verdict,
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
    let mut sets = VisibleSets::new(lab.world.total());
    let mut truths = Vec::new();
    for (frame, shot) in drill.case.shots.iter().enumerate() {
        fit(lab, drill.size(frame))?;
        let truth = lab.truth(shot)?;
        sets.push_items(&truth.images().visible_items());
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

/// One frame of a method in a drill.
#[derive(Clone, Debug, PartialEq)]
struct Played {
    error: FrameError,
    /// Pixels outside the raster conditions, which the error leaves out.
    thin: u64,
    /// Of its pictures.
    pictures: u64,
    /// Of its draw lists.
    lists: u64,
}

fn hash_of(add: impl FnOnce(&mut DefaultHasher)) -> u64 {
    let mut hasher = DefaultHasher::new();
    add(&mut hasher);
    hasher.finish()
}

/// A pixel's colour, and whose it is.
fn pixels(images: &FrameImages) -> impl Iterator<Item = (&[u8; 4], &u32)> {
    images.colour.iter().zip(&images.items)
}

/// `subject`: `auto` may change its method while nothing moves, and each method decides by an order of its own which of two objects that are as
/// near has a pixel. A pixel that is another's than in the truth stands for the truth's then: the truth is compared with anyway.
fn played(subject: &Subject, truth: &Truth, take: &Take, (error, thin): (FrameError, u64)) -> Played {
    let (images, one_order) = (&take.images, subject.options.method() != "auto");
    let pictures = hash_of(|hasher| {
        images.depth.iter().for_each(|depth| depth.to_bits().hash(hasher));
        for (pixel, true_pixel) in pixels(images).zip(pixels(truth.images())) {
            let tied = !one_order && pixel.1 != true_pixel.1;
            (if tied { true_pixel } else { pixel }).hash(hasher);
        }
    });
    let lists = hash_of(|hasher| bytemuck::cast_slice::<_, u32>(&take.commands).hash(hasher));
    Played { error, thin, pictures, lists }
}

/// Runs a method through a drill. Returns its tally and its faults. With `twice`, another instance of the method runs too. In a drill that tells
/// methods to forget, the same instance is told once more and runs again: it must then draw as a new one does.
pub(super) fn tried(
    lab: &mut Lab,
    subject: &Subject,
    drill: &Drill,
    (truths, sets): (&[Truth], &Arc<VisibleSets>),
    twice: bool,
) -> Result<(Tally, Vec<String>)> {
    let mut method = lab.make(subject, sets)?;
    let once = film(lab, subject, &mut *method, drill, truths)?;
    let mut again = Vec::new();
    if twice {
        let mut other = lab.make(subject, sets)?;
        again.push(("another run", film(lab, subject, &mut *other, drill, truths)?));
    }
    if !drill.forgets.is_empty() {
        method.forget()?;
        again.push(("a run after forgetting", film(lab, subject, &mut *method, drill, truths)?));
    }
    Ok((tally_of(&once), faults_of(drill, &once, &again)))
}

/// What a method does in each frame of a drill.
fn film(
    lab: &mut Lab,
    subject: &Subject,
    method: &mut dyn Method,
    drill: &Drill,
    truths: &[Truth],
) -> Result<Vec<Played>> {
    let mut frames = Vec::new();
    for (frame, shot) in drill.case.shots.iter().enumerate() {
        fit(lab, drill.size(frame))?;
        if drill.forgets.contains(&frame) {
            method.forget()?;
        }
        let take = lab.take(&mut *method, shot, frame)?;
        let verdict = judged(lab, shot, &truths[frame], &take)?;
        frames.push(played(subject, &truths[frame], &take, verdict));
    }
    Ok(frames)
}

fn tally_of(frames: &[Played]) -> Tally {
    let sum = |value: fn(&FrameError) -> usize| frames.iter().map(|frame| value(&frame.error) as u64).sum();
    Tally {
        runs: 1,
        object_frames: sum(|error| error.objects),
        lost: sum(|error| error.false_negatives),
        differing: sum(|error| error.differing_pixels + error.wrong_colour_pixels),
        ties: sum(|error| error.tied_pixels),
        thin: frames.iter().map(|frame| frame.thin).sum(),
    }
}

impl Tally {
    fn add(&mut self, other: &Tally) {
        self.runs += other.runs;
        self.object_frames += other.object_frames;
        self.lost += other.lost;
        self.differing += other.differing;
        self.ties += other.ties;
        self.thin += other.thin;
    }
}

/// What an exact method may not do, frame by frame: lose objects, change pixels, show another picture while nothing changes, or
/// draw another list when it is run `again`, in one of the ways named.
fn faults_of(drill: &Drill, frames: &[Played], again: &[(&str, Vec<Played>)]) -> Vec<String> {
    let mut faults = Vec::new();
    for (frame, played) in frames.iter().enumerate() {
        faults.extend(wrong(&played.error).map(|what| format!("frame {frame}: {what}")));
        // The first frame knows nothing yet, which may decide ties; the second may be the first to know.
        if frame >= 2
            && drill.stands_still(frame - 1)
            && drill.stands_still(frame)
            && frames[frame - 1].pictures != played.pictures
        {
            faults.push(format!("frame {frame}: nothing changed, but the picture did"));
        }
        let left = |played: &Played| (played.pictures, played.lists);
        let others = again.iter().filter(|(_, again)| left(&again[frame]) != left(played));
        faults.extend(others.map(|(run, _)| format!("frame {frame}: {run} draws another picture or list")));
    }
    faults
}

/// What an exact method may not do in a frame.
pub(super) fn wrong(error: &FrameError) -> Option<String> {
    let FrameError { false_negatives, differing_pixels, wrong_colour_pixels, .. } = error;
    (false_negatives + differing_pixels + wrong_colour_pixels > 0).then(|| {
        format!("{false_negatives} lost, {differing_pixels} pixels differ, {wrong_colour_pixels} of wrong colour")
    })
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
        let promised = seen.too_near.iter().filter(|near| !near.thin);
        broken.extend(promised.map(|near| format!("{name}, frame {frame}: {}", near.text)));
        row.margin.join(seen);
        let mut pixels = std::collections::HashMap::<u32, u64>::new();
        let images = truths[frame].images();
        let items = images.items.iter().filter(|item| **item != crate::measures::metrics::NO_ITEM);
        items.for_each(|item| *pixels.entry(*item).or_default() += 1);
        row.fewest_pixels = row.fewest_pixels.into_iter().chain(pixels.into_values().min()).min();
    }
    Ok(())
}

#[cfg(test)]
mod tests;
