//! What must hold for every exact method and every world. Each law returns its faults.

mod drawn;
mod planted;

pub use drawn::{
    what_a_wall_hides_after_a_cut_is_culled, what_a_wall_hides_is_culled, what_is_no_longer_seen_is_no_longer_drawn,
};
pub use planted::{a_defect_alone_loses_objects, Make};

use crate::lab::{error_of, Lab, Subject, Take};
use crate::{Case, Random};
use culling::world::Still;
use engine::Gpu;
use sightline::measures::metrics::FrameError;

/// What an exact method may not do in a frame.
pub fn faults_of(place: &str, error: &FrameError) -> Vec<String> {
    let counts = [
        (error.false_negatives, "false negatives"),
        (error.differing_pixels, "differing pixels"),
        (error.wrong_colour_pixels, "wrong colours"),
    ];
    counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{place}: {count} {what}")).collect()
}

/// Every object that owns a pixel is drawn, and the picture is that of `none`.
pub fn no_visible_object_is_culled(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut lab = Lab::new(gpu, case);
    let (truths, sets) = lab.truths(&case.shots);
    let mut method = lab.make(subject, &sets);
    let takes = lab.film(&mut *method, &case.shots);
    let faults = |(frame, (truth, take)): (usize, (_, &Take))| {
        faults_of(&format!("{}, {}, frame {frame}", subject.options.label(), case.name), &error_of(truth, take))
    };
    truths.iter().zip(&takes).enumerate().flat_map(faults).collect()
}

/// Leaving stages out gives the same bytes and the same draw lists as running them; and while nothing changes, stages are
/// left out.
pub fn skipping_changes_no_pixel(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    // Long enough for methods whose lists need some frames to settle.
    const STILL: usize = 5;
    let shots: Vec<_> = case.shots.iter().flat_map(|shot| [*shot; STILL]).collect();
    let mut lab = Lab::new(gpu, case);
    let sets = lab.sets_for(subject, &shots);
    let mut skipping = lab.make(&subject.clone().with("skip", "true"), &sets);
    let mut thorough = lab.make(&subject.clone().with("skip", "false"), &sets);
    let mut faults = Vec::new();
    for (frame, shot) in shots.iter().enumerate() {
        let place = format!("{}, {}, frame {frame}", subject.options.label(), case.name);
        let (left_out, ran) = (lab.take(&mut *skipping, shot, frame), lab.take(&mut *thorough, shot, frame));
        let learns = LEARNING.iter().any(|id| subject.options.label().starts_with(id));
        let draws_less =
            DRAWS_LESS.iter().any(|id| subject.options.label().starts_with(id)) && draws_no_more(&left_out, &ran);
        let differ = differences(&place, &left_out, &ran);
        faults.extend(
            differ.into_iter().filter(|fault| !(learns || draws_less) || !fault.ends_with("drawn objects differ")),
        );
        let skips = |take: &Take| take.report.skips.iter().filter(|skip| skip.reason == Still::REASON).count();
        if skips(&ran) > 0 {
            faults.push(format!("{place}: skipped a stage although told not to"));
        }
        if frame % STILL == STILL - 1 && skips(&left_out) == 0 {
            faults.push(format!("{place}: nothing changed, but no stage was left out"));
        }
        if skips(&left_out) > 0 && shot_changed(&shots, frame) {
            faults.push(format!("{place}: the camera moved, but a stage was left out"));
        }
    }
    faults
}

/// Methods that test more finely where earlier frames saw something, and filter occluders every few frames: how many frames
/// ran decides which hidden objects they draw, never what is seen. The law is about pictures.
const LEARNING: [&str; 1] = ["eovc"];

/// Methods that leave out a draw while nothing changes, of objects of which a frame before found that they own no pixel: they may draw
/// less where they skip, but never anything else. `auto` begins with one.
const DRAWS_LESS: [&str; 2] = ["hzb-iterative", "auto"];

fn draws_no_more(one: &Take, other: &Take) -> bool {
    one.drawn.objects.iter().zip(&other.drawn.objects).all(|(one, other)| *other || !*one)
}

fn shot_changed(shots: &[scenes::Shot], frame: usize) -> bool {
    frame == 0 || shots[frame - 1] != shots[frame]
}

/// Two takes differ in a picture or in what they drew.
fn differences(place: &str, one: &Take, other: &Take) -> Vec<String> {
    let (a, b) = (&one.images, &other.images);
    let differ = [
        (a.colour != b.colour, "colours"),
        (a.depth.iter().map(|d| d.to_bits()).ne(b.depth.iter().map(|d| d.to_bits())), "depths"),
        (a.items != b.items, "items"),
        (one.drawn.objects != other.drawn.objects, "drawn objects"),
    ];
    differ.iter().filter(|(differs, _)| *differs).map(|(_, what)| format!("{place}: {what} differ")).collect()
}

/// Methods whose sets follow from fragments as they are drawn: one of two objects at the same depth owns the pixel, and an
/// object drawn before its occluder is seen. Their depths do not depend on the order all the same.
const ORDER_DECIDES: [&str; 8] = ["ref", "roc", "eovc", "hzb-iterative", "auto", "query-wait", "chc", "nohc"];

/// Objects in another order: the same objects are drawn, and depths are the same. Only for scenes that do not move.
pub fn the_order_of_objects_does_not_matter(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut order: Vec<usize> = (0..case.scene.objects.len()).collect();
    Random::new(5).shuffle(&mut order);
    let mut shuffled = case.clone();
    shuffled.scene.objects = order.iter().map(|from| case.scene.objects[*from].clone()).collect();
    for building in &mut shuffled.scene.buildings {
        let place = order.iter().position(|from| *from == building.object as usize);
        building.object = place.expect("each object once") as u32;
    }
    let film = |case: &Case| {
        let mut lab = Lab::new(gpu, case);
        let sets = lab.sets_for(subject, &case.shots);
        let mut method = lab.make(subject, &sets);
        (
            lab.film(&mut *method, &case.shots),
            (0..lab.world.total()).map(|object| lab.world.scene_object(object)).collect(),
        )
    };
    let ((straight, straight_scene), (mixed, mixed_scene)): ((_, Vec<usize>), (_, Vec<usize>)) =
        (film(case), film(&shuffled));
    let mut faults = Vec::new();
    for (frame, (straight, mixed)) in straight.iter().zip(&mixed).enumerate() {
        let place = format!("{}, {}, frame {frame}", subject.options.label(), case.name);
        let mut drawn = vec![false; order.len()];
        straight.drawn.objects.iter().zip(&straight_scene).for_each(|(was_drawn, object)| drawn[*object] = *was_drawn);
        let mapped = |world: usize| order[mixed_scene[world]];
        let moved =
            mixed.drawn.objects.iter().enumerate().filter(|(object, was_drawn)| drawn[mapped(*object)] != **was_drawn);
        let free = !ORDER_DECIDES.iter().any(|id| subject.options.label().starts_with(id));
        let moved = if free { moved.count() } else { 0 };
        if moved > 0 {
            faults.push(format!("{place}: {moved} objects drawn in one order only"));
        }
        if straight.images.depth != mixed.images.depth {
            faults.push(format!("{place}: depths depend on the order"));
        }
    }
    faults
}

/// The picture changes its size between frames: each frame is still exact.
pub fn a_resize_hides_nothing(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let sizes = [[161, 97], [161, 97], [64, 64], [200, 30], [199, 31], [161, 97], [1, 1], [161, 97]];
    let shots: Vec<_> = (0..sizes.len()).map(|frame| case.shots[frame / 3 % case.shots.len()]).collect();
    let mut lab = Lab::new(gpu, case);
    let mut sets = culling::VisibleSets::new(lab.world.total());
    let mut truths = Vec::new();
    for (size, shot) in sizes.iter().zip(&shots) {
        lab.resize(*size);
        truths.push(lab.truth(shot));
        sets.push_items(&truths[truths.len() - 1].images().visible_items());
    }
    let mut method = lab.make(subject, &sets.into());
    let mut faults = Vec::new();
    for (frame, size) in sizes.iter().enumerate() {
        lab.resize(*size);
        let take = lab.take(&mut *method, &shots[frame], frame);
        let place = format!("{}, {}, frame {frame} at {size:?}", subject.options.label(), case.name);
        faults.extend(faults_of(&place, &error_of(&truths[frame], &take)));
    }
    faults
}

/// The camera jumps and comes back, and the method is told to forget or is not: each frame is exact. After forgetting, a run
/// gives the bytes of its first time.
pub fn a_camera_cut_hides_nothing(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut lab = Lab::new(gpu, case);
    let cut: Vec<_> = [3, 0, 5, 5, 0, 3, 0].iter().map(|shot| case.shots[shot % case.shots.len()]).collect();
    let (truths, sets) = lab.truths(&cut);
    let mut faults = Vec::new();
    for forgets in [false, true] {
        let mut method = lab.make(subject, &sets);
        for (frame, shot) in cut.iter().enumerate() {
            if forgets && (frame == 2 || frame == 4) {
                method.forget().unwrap();
            }
            let take = lab.take(&mut *method, shot, frame);
            let place = format!("{}, {}, frame {frame}, forgets: {forgets}", subject.options.label(), case.name);
            faults.extend(faults_of(&place, &error_of(&truths[frame], &take)));
        }
        let mut fresh = lab.make(subject, &sets);
        let expected = lab.film(&mut *fresh, &cut);
        method.forget().unwrap();
        let again = lab.film(&mut *method, &cut);
        faults.extend(film_differences(
            &format!("{}, {}, after forgetting", subject.options.label(), case.name),
            &expected,
            &again,
        ));
    }
    faults
}

fn film_differences(place: &str, one: &[Take], other: &[Take]) -> Vec<String> {
    let frames = one.iter().zip(other).enumerate();
    let pictures = frames.flat_map(|(frame, (one, other))| {
        let place = format!("{place}, frame {frame}");
        let mut faults = differences(&place, one, other);
        if one.commands != other.commands {
            faults.push(format!("{place}: draw lists differ"));
        }
        faults
    });
    pictures.collect()
}

/// Two runs of two instances give the same bytes: pictures and draw lists.
pub fn two_runs_give_the_same_bytes(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let film = || {
        let mut lab = Lab::new(gpu, case);
        let sets = lab.sets_for(subject, &case.shots);
        let mut method = lab.make(subject, &sets);
        lab.film(&mut *method, &case.shots)
    };
    film_differences(&format!("{}, {}", subject.options.label(), case.name), &film(), &film())
}

/// The draw lists, colours and depths of timed frames are those of measured ones.
pub fn decisions_do_not_depend_on_the_pass(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut lab = Lab::new(gpu, case);
    let sets = lab.sets_for(subject, &case.shots);
    let (mut measured, mut timed) = (lab.make(subject, &sets), lab.make(subject, &sets));
    let mut faults = Vec::new();
    for (frame, shot) in case.shots.iter().enumerate() {
        // The timed frame goes second: its item image is then what the measured frame left.
        let (measured, timed) = (lab.take(&mut *measured, shot, frame), lab.take_timed(&mut *timed, shot, frame));
        let place = format!("{}, {}, frame {frame}, timed", subject.options.label(), case.name);
        faults.extend(film_differences(&place, &[measured], &[timed]));
    }
    faults
}

/// While nothing changes, so does no pixel, ties included: the order of drawing is stable. The first frame may differ in
/// ties, because a method does not know yet what it will see.
pub fn a_still_camera_shows_one_picture(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let shots = [case.shots[0]; 5];
    let mut lab = Lab::new(gpu, case);
    let sets = lab.sets_for(subject, &shots);
    let mut method = lab.make(subject, &sets);
    let takes = lab.film(&mut *method, &shots);
    let pairs = takes[1..].windows(2).enumerate();
    let changed = pairs.filter(|(_, pair)| pair[0].images != pair[1].images);
    changed
        .map(|(frame, _)| format!("{}, {}: flickers in frame {}", subject.options.label(), case.name, frame + 2))
        .collect()
}

/// Exact at sizes that pyramids get wrong.
pub fn any_size_is_exact(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let sizes = [[1, 1], [2, 1], [1, 257], [257, 1], [3, 3], [63, 65], [64, 64], [127, 129], [641, 359], [1023, 1025]];
    let case = case.filmed(case.shots.iter().step_by(2).copied().collect());
    sizes.iter().flat_map(|size| no_visible_object_is_culled(gpu, subject, &case.sized(*size))).collect()
}

/// Objects come and go: each time there is a new world and a new method, and nothing is left of the old ones.
pub fn objects_that_come_and_go_are_seen(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut faults = no_visible_object_is_culled(gpu, subject, case);
    let without = |object: usize| {
        let mut case = case.clone();
        case.scene.objects.remove(object);
        Case { name: format!("{} without object {object}", case.name), ..case }
    };
    // Object 0 is the wall that hides the others.
    for changed in [without(0), case.clone(), without(case.scene.objects.len() - 1)] {
        faults.extend(no_visible_object_is_culled(gpu, subject, &changed));
    }
    faults
}

/// The tests that every exact method has, named as laws. Those of methods that leave stages out are in
/// [`skipping_method_tests`](crate::skipping_method_tests).
#[macro_export]
macro_rules! exact_method_tests {
    ($id:literal) => {
        use harness::{assert_none, gpu, laws, sessions, worlds, Subject};

        #[test]
        fn no_visible_object_is_culled() {
            let gpu = gpu();
            let subject = Subject::named($id);
            let faults =
                worlds::special().into_iter().flat_map(|case| laws::no_visible_object_is_culled(&gpu, &subject, &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        fn no_visible_object_is_culled_on_any_path() {
            let gpu = gpu();
            assert_none(&sessions::all_faults(&gpu, $id, &[]));
        }

        #[test]
        fn the_order_of_objects_does_not_matter() {
            let gpu = gpu();
            let cases = worlds::special().into_iter();
            let faults =
                cases.flat_map(|case| laws::the_order_of_objects_does_not_matter(&gpu, &Subject::named($id), &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        fn a_resize_hides_nothing() {
            let gpu = gpu();
            assert_none(&laws::a_resize_hides_nothing(&gpu, &Subject::named($id), &worlds::walled(300)));
        }

        #[test]
        fn a_camera_cut_hides_nothing() {
            let gpu = gpu();
            assert_none(&laws::a_camera_cut_hides_nothing(&gpu, &Subject::named($id), &worlds::walled(300)));
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
        fn a_still_camera_shows_one_picture() {
            let gpu = gpu();
            let cases = worlds::special().into_iter();
            let faults =
                cases.flat_map(|case| laws::a_still_camera_shows_one_picture(&gpu, &Subject::named($id), &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        fn objects_that_come_and_go_are_seen() {
            let gpu = gpu();
            assert_none(&laws::objects_that_come_and_go_are_seen(&gpu, &Subject::named($id), &worlds::walled(150)));
        }
    };
}

/// The tests of methods that leave out what cannot change the result.
#[macro_export]
macro_rules! skipping_method_tests {
    ($id:literal) => {
        #[test]
        fn skipping_changes_no_pixel() {
            let gpu = gpu();
            let cases = worlds::special().into_iter();
            let faults = cases.flat_map(|case| laws::skipping_changes_no_pixel(&gpu, &Subject::named($id), &case));
            assert_none(&faults.collect::<Vec<_>>());
        }

        #[test]
        fn no_visible_object_is_culled_without_skipping() {
            let gpu = gpu();
            assert_none(&sessions::all_faults(&gpu, $id, &[("skip", "false")]));
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
