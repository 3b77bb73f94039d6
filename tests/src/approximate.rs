//! What must hold for methods that may miss objects: they say so, they miss few, and not for long.

use crate::lab::{error_of, Lab, Subject};
use crate::laws::faults_of;
use crate::{sessions, Case};
use engine::Gpu;
use sightline::run::truth::RunTruth;
use sightline::run::Contender;

/// Before a still camera the second frame and all others are exact: what the first missed is not in its depth, which hides it
/// no more. The camera comes from another place, without a cut.
pub fn a_still_camera_is_exact(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut lab = Lab::new(gpu, case);
    let shots: Vec<_> = case.shots.iter().flat_map(|shot| [*shot; 3]).collect();
    let (truths, sets) = lab.truths(&shots);
    let mut method = lab.make(subject, &sets);
    let takes = lab.film(&mut *method, &shots);
    let settled = truths.iter().zip(&takes).enumerate().filter(|(frame, _)| frame % 3 > 0);
    let place = |frame: usize| format!("{}, {}, frame {frame}", subject.options.label(), case.name);
    settled.flat_map(|(frame, (truth, take))| faults_of(&place(frame), &error_of(truth, take))).collect()
}

/// A first frame, and one after a cut that the method is told of, is exact.
pub fn a_first_frame_is_exact(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut lab = Lab::new(gpu, case);
    let (truths, sets) = lab.truths(&case.shots);
    let mut method = lab.make(subject, &sets);
    let mut faults = Vec::new();
    for (frame, (shot, truth)) in case.shots.iter().zip(&truths).enumerate() {
        method.forget().unwrap();
        let take = lab.take(&mut *method, shot, frame);
        let place = format!("{}, {}, frame {frame}, forgotten", subject.options.label(), case.name);
        faults.extend(faults_of(&place, &error_of(truth, &take)));
    }
    faults
}

/// What a method missed over all frames of some runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Missed {
    /// Visible objects, in all frames.
    pub visible: usize,
    /// Those that were not drawn.
    pub missed: usize,
    /// Pixels, in all frames.
    pub pixels: usize,
    /// Those that differ.
    pub differing: usize,
}

/// Runs a method along one of the sessions' paths at speed 1.
///
/// # Panics
/// If the device or its validation layer objects.
pub fn missed(gpu: &Gpu, subject: &Subject, id: &str, run: (&str, f64, &str), frames: usize) -> Missed {
    let mut session = sessions::open_at_speed_one(gpu, run, frames);
    let truth = RunTruth::draw(&mut session, || ()).unwrap();
    let visible = Some(truth.sets.clone());
    let entry = culling::find(id).unwrap();
    let mut contender = Contender::new(&session, entry, subject.options.clone(), &visible).unwrap();
    let mut sum = Missed::default();
    for frame in 0..session.frames() {
        let truth = truth.frame(&mut session, frame).unwrap();
        let found = contender.measured(&mut session, frame, &truth).unwrap();
        sum.visible += truth.visible_count();
        sum.missed += found.error.false_negatives as usize;
        sum.pixels += truth.images().depth.len();
        sum.differing += found.error.differing_pixels as usize;
    }
    sum
}

/// The tests that every approximate method has, named as laws. `$most_missed_percent` bounds the visible objects that it
/// misses on the paths of [`sessions::RUNS`] at speed 1, and `$most_differing_percent` the pixels.
#[macro_export]
macro_rules! approximate_method_tests {
    ($id:literal, $most_missed_percent:literal, $most_differing_percent:literal) => {
        use harness::{approximate, assert_none, gpu, laws, sessions, worlds, Subject};

        #[test]
        fn it_says_that_it_may_miss_objects() {
            let guarantee = culling::find($id).unwrap().guarantee;
            assert!(matches!(guarantee, culling::Guarantee::Approximate(why) if !why.is_empty()));
        }

        #[test]
        fn a_still_camera_is_exact() {
            let gpu = gpu();
            let cases = worlds::special().into_iter();
            let faults = cases.flat_map(|case| approximate::a_still_camera_is_exact(&gpu, &Subject::named($id), &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        fn a_first_frame_is_exact() {
            let gpu = gpu();
            let cases = worlds::special().into_iter();
            let faults = cases.flat_map(|case| approximate::a_first_frame_is_exact(&gpu, &Subject::named($id), &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        fn few_objects_are_missed_on_any_path() {
            let gpu = gpu();
            for run in sessions::RUNS {
                let found = approximate::missed(&gpu, &Subject::named($id), $id, run, 12);
                let percent = |part: usize, all: usize| 100.0 * part as f64 / all.max(1) as f64;
                let (missed, differing) =
                    (percent(found.missed, found.visible), percent(found.differing, found.pixels));
                println!("{run:?}: {missed:.4} % of {} visible objects missed, {differing:.4} % of pixels", found.visible);
                assert!(found.visible > 0, "{run:?} shows nothing, so it proves nothing");
                assert!(missed <= $most_missed_percent, "{run:?}: {missed:.4} % of visible objects missed");
                assert!(differing <= $most_differing_percent, "{run:?}: {differing:.4} % of pixels differ");
            }
        }

        #[test]
        fn a_resize_hides_nothing() {
            let gpu = gpu();
            assert_none(&laws::a_resize_hides_nothing(&gpu, &Subject::named($id), &worlds::walled(300)));
        }

        #[test]
        fn two_runs_give_the_same_bytes() {
            let gpu = gpu();
            let cases = worlds::special().into_iter();
            let faults = cases.flat_map(|case| laws::two_runs_give_the_same_bytes(&gpu, &Subject::named($id), &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        fn decisions_do_not_depend_on_the_pass() {
            let gpu = gpu();
            let cases = worlds::special().into_iter();
            let faults =
                cases.flat_map(|case| laws::decisions_do_not_depend_on_the_pass(&gpu, &Subject::named($id), &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        fn what_a_wall_hides_is_culled() {
            let gpu = gpu();
            assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named($id), &worlds::walled(400)));
        }

        #[test]
        fn skipping_changes_no_pixel() {
            let gpu = gpu();
            let cases = worlds::special().into_iter();
            let faults = cases.flat_map(|case| laws::skipping_changes_no_pixel(&gpu, &Subject::named($id), &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        #[should_panic(expected = "made for another world")]
        fn a_world_of_another_length_is_refused() {
            let gpu = gpu();
            let (long, short) = (worlds::walled(200), worlds::walled(20));
            let sets = Default::default();
            let mut method = harness::Lab::new(&gpu, &short).make(&Subject::named($id), &sets);
            harness::Lab::new(&gpu, &long).take(&mut *method, &long.shots[0], 0);
        }
    };
}
