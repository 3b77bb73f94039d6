//! The laws of `roc-iterative`, its stages against their twins, and what depth ranges promise.

#[path = "method_roc_iterative/stages.rs"]
mod stages;

use engine::Gpu;
use glam::DVec3;
use harness::worlds::{cube, shot, sized, wander, Case, Maker, PERSPECTIVE};
use harness::{Lab, Random, Take};
use scenes::Shot;

harness::exact_method_tests!("roc-iterative");
harness::skipping_method_tests!("roc-iterative");

/// Numbers of ranges, and ways to cut them.
const CUTS: [&[(&str, &str)]; 7] = [
    &[("ranges", "1")],
    &[("ranges", "2")],
    &[("ranges", "3"), ("factor", "16")],
    &[("ranges", "8")],
    &[("ranges", "3"), ("first", "2")],
    &[("ranges", "3"), ("first", "2"), ("beyond", "visible")],
    &[("ranges", "1"), ("first", "1"), ("beyond", "visible")],
];

fn cut(set: &[(&str, &str)]) -> Subject {
    set.iter().fold(Subject::named("roc-iterative"), |subject, (option, value)| subject.with(option, value))
}

/// Cuts take turns at the worlds.
#[test]
fn any_cut_is_exact() {
    let gpu = gpu();
    for (setting, subject) in CUTS.map(cut).into_iter().enumerate() {
        let cases = worlds::special().into_iter().enumerate();
        for (_, case) in cases.filter(|(case, _)| harness::takes_turn(setting, *case, 3)) {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
        assert_none(&laws::a_resize_hides_nothing(&gpu, &subject, &worlds::walled(200)));
        assert_none(&laws::a_camera_cut_hides_nothing(&gpu, &subject, &worlds::walled(200)));
    }
}

#[test]
fn any_cut_can_be_skipped_and_run_again() {
    let gpu = gpu();
    for subject in CUTS.map(cut) {
        for case in [worlds::walled(200), worlds::special::topologies(), worlds::special::ties(), layers()] {
            assert_none(&laws::skipping_changes_no_pixel(&gpu, &subject, &case));
            assert_none(&laws::two_runs_give_the_same_bytes(&gpu, &subject, &case));
        }
    }
}

#[test]
fn one_range_draws_what_roc_draws() {
    let gpu = gpu();
    for case in worlds::special().into_iter().chain([layers()]) {
        let film = |subject: Subject| film(&gpu, &subject, &case, &case.shots);
        let (one_range, roc) = (film(cut(&[("ranges", "1")])), film(Subject::named("roc")));
        for (frame, (one_range, roc)) in one_range.iter().zip(&roc).enumerate() {
            assert_eq!(one_range.drawn, roc.drawn, "{}, frame {frame}", case.name);
            assert!(one_range.images == roc.images, "{}, frame {frame}: another picture", case.name);
        }
    }
}

/// What lies in the nearest layers hides the farther ones although none of it was seen before.
#[test]
fn after_a_camera_cut_new_objects_hide_farther_ones() {
    let gpu = gpu();
    let case = layers();
    let mut lab = Lab::new(&gpu, &case);
    let visible = lab.truth(&case.shots[0]).visible_count();
    // From looking away, where nothing is seen, to all layers.
    let shots = [case.shots[3], case.shots[0]];
    let drawn = |subject: Subject| {
        let takes = film(&gpu, &subject, &case, &shots);
        takes[1].drawn.objects.iter().filter(|drawn| **drawn).count()
    };
    let (roc, by_range) =
        (drawn(Subject::named("roc")), ["2", "3", "8"].map(|ranges| drawn(cut(&[("ranges", ranges)]))));
    let hidden = |drawn: usize| drawn.checked_sub(visible).expect("all that is visible must be drawn");
    let hidden_by_range = by_range.map(hidden);
    let all = format!("of {visible} visible: roc {roc}, by ranges {by_range:?}");
    assert!(hidden_by_range[0] < hidden(roc), "{all}");
    assert!(hidden_by_range[1] < hidden_by_range[0] && hidden_by_range[2] <= hidden_by_range[1], "{all}");
    assert!(hidden_by_range[2] < hidden(roc) / 3, "{all}");
}

/// The thesis names it as a drawback: what begins past the last range is drawn, hidden or not.
#[test]
fn what_is_beyond_the_last_range_is_drawn_only_if_told_so() {
    let gpu = gpu();
    let case = layers();
    let shots = [case.shots[0]; 4];
    let drawn = |beyond: &str| {
        let takes = film(&gpu, &cut(&[("ranges", "2"), ("first", "4"), ("beyond", beyond)]), &case, &shots);
        takes[3].drawn.objects.iter().filter(|drawn| **drawn).count()
    };
    let (tested, shown) = (drawn("tested"), drawn("visible"));
    assert!(tested < shown / 4, "tested {tested}, visible {shown}");
    // Most of the layers begin more than 8 m from the eye, and none of their bodies is seen past the first.
    assert!(shown > case.scene.objects.len() / 2, "{shown} of {}", case.scene.objects.len());
}

fn film(gpu: &Gpu, subject: &Subject, case: &Case, shots: &[Shot]) -> Vec<Take> {
    let mut lab = Lab::new(gpu, case);
    let sets = lab.sets_for(subject, shots);
    let mut method = lab.make(subject, &sets);
    lab.film(&mut *method, shots)
}

/// Walls one behind the other, each twice as far as the last, wider than the view, with bodies behind each.
fn layers() -> Case {
    let mut maker = Maker::new("layers");
    let mut random = Random::new(91);
    let cube = maker.mesh(cube());
    // The farthest first: whoever draws in object order draws all of it.
    for layer in (0..5).rev() {
        let distance = 4.0 * 2f64.powi(layer);
        for _ in 0..40 {
            let spread = 0.4 * distance;
            let at = DVec3::new(
                random.range(-spread, spread),
                random.range(-spread, spread),
                -distance * random.range(1.15, 1.7),
            );
            maker.place(cube, sized(at, DVec3::splat(0.1 * distance)));
        }
        maker.place(cube, sized(DVec3::NEG_Z * distance, DVec3::new(4.0 * distance, 4.0 * distance, 0.01 * distance)));
    }
    let towards = DVec3::NEG_Z * 4.0;
    let mut shots = wander(DVec3::ZERO, towards, PERSPECTIVE);
    // Away from all of it.
    shots[3] = shot(DVec3::ZERO, DVec3::Z, PERSPECTIVE);
    Case::new("layers", maker.scene, shots)
}
