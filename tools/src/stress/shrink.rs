//! Makes a failing drill small: what still fails with fewer frames and objects says more.

use super::catalogue::Drill;
use super::run::{tried, truths};
use super::{Lab, Subject};
use engine::Gpu;
use scenes::{Motion, Scene};

/// Most runs of a method that shrinking may take.
const MOST_RUNS: u32 = 150;

/// The smallest drill found in which the method still does what it may not, by leaving out frames, then ever smaller runs of
/// objects (Zeller & Hildebrandt 2002, delta debugging, without its complements).
pub fn shrunk(gpu: &Gpu, subject: &Subject, drill: &Drill) -> Drill {
    let mut runs = 0;
    let mut still_fails = |drill: &Drill| {
        runs += 1;
        runs <= MOST_RUNS && fails(gpu, subject, drill)
    };
    let fewer_frames = shortened(drill, &mut still_fails);
    thinned(fewer_frames, &mut still_fails)
}

fn fails(gpu: &Gpu, subject: &Subject, drill: &Drill) -> bool {
    let played = || -> anyhow::Result<bool> {
        let mut lab = Lab::new(gpu, &drill.case)?;
        let (truths, sets) = truths(&mut lab, drill)?;
        let (_, faults) = tried(&mut lab, subject, drill, (&truths, &sets), true)?;
        Ok(!faults.is_empty())
    };
    // A frame that the device or its validation layer refuses is a failure too.
    played().unwrap_or(true)
}

/// Without frames after the first that fails, then without each before it that is not needed.
pub(super) fn shortened(drill: &Drill, still_fails: &mut dyn FnMut(&Drill) -> bool) -> Drill {
    let cut = |drill: &Drill, frames: usize| {
        let mut cut = drill.clone();
        cut.case.shots.truncate(frames);
        cut
    };
    let all = drill.case.shots.len();
    let needed = (1..all).find(|frames| still_fails(&cut(drill, *frames))).unwrap_or(all);
    let mut best = cut(drill, needed);
    let mut frame = 0;
    while frame + 1 < best.case.shots.len() {
        let mut without = best.clone();
        without.case.shots.remove(frame);
        if !best.sizes.is_empty() {
            without.sizes = (0..best.case.shots.len()).map(|frame| best.size(frame)).collect();
            without.sizes.remove(frame);
        }
        let earlier = |at: &usize| if *at > frame { *at - 1 } else { *at };
        without.forgets = best.forgets.iter().map(earlier).collect();
        if still_fails(&without) {
            best = without;
        } else {
            frame += 1;
        }
    }
    best
}

/// Drops all objects that are not needed, by halves, quarters and so on. Worlds of deformed meshes stay whole.
pub(super) fn thinned(mut best: Drill, still_fails: &mut dyn FnMut(&Drill) -> bool) -> Drill {
    if !best.case.scene.deformed.is_empty() {
        return best;
    }
    let mut step = best.case.scene.objects.len().div_ceil(2);
    while step > 0 {
        let mut first = 0;
        while first < best.case.scene.objects.len() {
            let mut without = best.clone();
            leave_out(&mut without.case.scene, first, step);
            if still_fails(&without) {
                best = without;
            } else {
                first += step;
            }
        }
        step = if step == 1 { 0 } else { step.div_ceil(2) };
    }
    best
}

/// Takes objects away, with their motion.
fn leave_out(scene: &mut Scene, first: usize, count: usize) {
    let end = (first + count).min(scene.objects.len());
    scene.objects.drain(first..end);
    if let Motion::Orbits(orbits) = &mut scene.motion {
        orbits.retain(|orbit| !(first..end).contains(&(orbit.object as usize)));
        let later = orbits.iter_mut().filter(|orbit| orbit.object as usize >= end);
        later.for_each(|orbit| orbit.object -= (end - first) as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::catalogue::DrillId;
    use glam::DVec3;

    #[test]
    fn only_what_is_needed_is_left() {
        for family in ["near-plane/1", "moving/1", "reuse/2"] {
            let drill = DrillId::parse(family).unwrap().make(60);
            let culprits = [drill.case.scene.objects[17].name.clone(), drill.case.scene.objects[40].name.clone()];
            let shot = drill.case.shots[3];
            let mut still_fails = |drill: &Drill| {
                let has = |name: &String| drill.case.scene.objects.iter().any(|object| object.name == *name);
                drill.case.scene.check().unwrap();
                culprits.iter().all(has) && drill.case.shots.contains(&shot)
            };
            let small = thinned(shortened(&drill, &mut still_fails), &mut still_fails);
            assert_eq!(small.case.scene.objects.len(), 2, "{family}");
            assert_eq!(small.case.shots, [shot], "{family}");
        }
    }

    #[test]
    fn sizes_and_forgetting_stay_with_their_frames() {
        let mut drill = DrillId::parse("resize/1").unwrap().make(5);
        drill.forgets = vec![4];
        let (shot, size) = (drill.case.shots[4], drill.size(4));
        let mut needed = |drill: &Drill| {
            let at = drill.case.shots.iter().position(|other| *other == shot);
            at.is_some_and(|at| drill.forgets == [at] && drill.size(at) == size)
        };
        assert!(needed(&drill), "the drill's fifth shot is its own");
        let small = shortened(&drill, &mut needed);
        assert_eq!((small.case.shots.len(), small.forgets.clone(), small.size(0)), (1, vec![0], size));
    }

    /// A failure of the first frame needs no other; one that needs all frames keeps all.
    #[test]
    fn as_few_frames_are_left_as_still_fail() {
        let drill = DrillId::parse("creeping/0").unwrap().make(3);
        let frames = drill.case.shots.len();
        for needed in [1, 2, 5, frames] {
            let mut tried = Vec::new();
            let small = shortened(&drill, &mut |drill| {
                tried.push(drill.case.shots.len());
                drill.case.shots.len() >= needed
            });
            assert_eq!(small.case.shots.len(), needed);
            assert_eq!(small.case.shots, drill.case.shots[..needed], "the later frames go first");
            assert_eq!(tried[..needed.min(frames - 1)], (1..frames).take(needed).collect::<Vec<_>>());
        }
    }

    /// What is left out takes its motion along, and the motion of what comes later stays with its object.
    #[test]
    fn motion_stays_with_its_objects() {
        let scene = DrillId::parse("moving/1").unwrap().make(12).case.scene;
        let moving = |scene: &Scene| -> Vec<(String, DVec3)> {
            let Motion::Orbits(orbits) = &scene.motion else { panic!("bodies go around") };
            orbits.iter().map(|orbit| (scene.objects[orbit.object as usize].name.clone(), orbit.axis)).collect()
        };
        let all = moving(&scene);
        for (first, count) in [(0, 1), (3, 2), (5, 1), (6, 4), (11, 9)] {
            let mut less = scene.clone();
            leave_out(&mut less, first, count);
            let gone: Vec<_> = scene.objects.iter().skip(first).take(count).map(|object| object.name.clone()).collect();
            assert_eq!(less.objects.len(), scene.objects.len() - gone.len());
            assert!(less.objects.iter().all(|object| !gone.contains(&object.name)));
            let stays: Vec<_> = all.iter().filter(|(name, _)| !gone.contains(name)).cloned().collect();
            assert_eq!(moving(&less), stays, "{first} and {count} on");
        }
    }

    #[test]
    fn objects_are_tried_in_ever_smaller_runs_and_deformed_worlds_stay_whole() {
        let drill = DrillId::parse("creeping/0").unwrap().make(10);
        let mut lengths = Vec::new();
        let small = thinned(drill.clone(), &mut |drill| {
            lengths.push(drill.case.scene.objects.len());
            false
        });
        assert_eq!(small.case.scene.objects, drill.case.scene.objects, "nothing was left out that was needed");
        // Of 11: runs of 6, 3, 2 and 1, the last of each as long as what is left.
        assert_eq!(lengths, [&[5, 6][..], &[8, 8, 8, 9], &[9, 9, 9, 9, 9, 10], &[10; 11]].concat());
        let bending = DrillId::parse("bending/0").unwrap().make(20);
        let mut runs = 0;
        let whole = thinned(bending.clone(), &mut |_| {
            runs += 1;
            true
        });
        assert_eq!((runs, whole.case.scene.objects.len()), (0, bending.case.scene.objects.len()));
    }
}
