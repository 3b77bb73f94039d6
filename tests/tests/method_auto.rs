//! The laws of `auto`. Its decisions are tested without a device (`culling/src/auto/choose/tests.rs`); here what it draws: candidates take
//! turns in every frame, which is the most that decisions by time could do.

use culling::auto::trust::EVERY;
use culling::{drawn_objects, Drawn};
use sightline::run::session::{Session, SessionOptions};
use sightline::run::truth::RunTruth;
use sightline::run::Contender;

harness::exact_method_tests!("auto");
harness::skipping_method_tests!("auto");

#[test]
fn changing_the_method_in_every_frame_is_exact() {
    let gpu = gpu();
    let subject = Subject::named("auto").with("by", "turns");
    for case in worlds::special() {
        assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
    }
    assert_none(&laws::a_camera_cut_hides_nothing(&gpu, &subject, &worlds::walled(300)));
    assert_none(&laws::a_resize_hides_nothing(&gpu, &subject, &worlds::walled(300)));
    assert_none(&laws::objects_that_come_and_go_are_seen(&gpu, &subject, &worlds::walled(150)));
    assert_none(&sessions::all_faults(&gpu, "auto", &[("by", "turns")]));
}

/// What is measured without a clock is what was timed.
#[test]
fn a_repeated_run_draws_what_the_timed_one_drew() {
    let gpu = gpu();
    let mut session = sessions::open_at_speed_one(&gpu, sessions::RUNS[0], 12);
    let entry = culling::find("auto").unwrap();
    let mut auto = Contender::new(&session, entry, entry.default_options(), &None).unwrap();
    let mut film = |timed: bool| {
        auto.method.forget().unwrap();
        let frames = 0..session.frames();
        let one = |frame| {
            let report = if timed { auto.timed(&mut session, frame) } else { auto.staged(&mut session, frame) };
            drawn_objects(&session.gpu, &session.world, &report.unwrap()).unwrap()
        };
        let drawn: Vec<_> = frames.map(one).collect();
        auto.method.repeat();
        drawn
    };
    let (timed, staged, again) = (film(true), film(false), film(true));
    assert!(timed == staged && timed == again, "other objects were drawn");
    let choices = auto.method.choices();
    assert_eq!(choices.len(), 12);
    for id in ["hzb-iterative", "eovc", "frustum"] {
        assert!(choices.iter().any(|choice| choice.contains(id)), "{id} was never tried: {choices:#?}");
    }
    assert!(choices.iter().all(|choice| !choice.contains("took - ms")), "{choices:#?}");
}

const CALM: (&str, f64, &str) = ("city-block", 0.05, "walk");

fn open(gpu: &engine::Gpu, (scene, scale, path): (&str, f64, &str), speed: f64) -> Session {
    let (scene, path) = (scene.into(), Some(path.into()));
    let run = SessionOptions { scene, path, scale, speed, frames: 40, size: [320, 180], ..SessionOptions::default() };
    Session::on(gpu, run).unwrap()
}

/// The method chosen in each frame, and the objects drawn, when `woc` is said to take a quarter of the time of others.
fn film_where_woc_is_cheap(session: &mut Session, allow: &str) -> (Vec<String>, Vec<Drawn>) {
    let entry = culling::find("auto").unwrap();
    let mut options = entry.default_options();
    options.set("allow-error", allow).unwrap();
    let mut auto = Contender::new(session, entry, options, &None).unwrap();
    let (mut chosen, mut drawn) = (Vec::new(), Vec::new());
    for frame in 0..session.frames() {
        // Staged frames are not measured: the times are made up.
        let report = auto.staged(session, frame).unwrap();
        drawn.push(drawn_objects(&session.gpu, &session.world, &report).unwrap());
        let choice = auto.method.choices().last().unwrap().clone();
        let id = choice.split([':', ',']).nth(1).unwrap().trim().to_owned();
        auto.method.measured(if id == "woc" { 5.0 } else { 20.0 });
        chosen.push(id);
    }
    (chosen, drawn)
}

#[test]
fn errors_are_made_only_where_they_are_allowed_and_checked_frames_make_none() {
    let gpu = gpu();
    let mut session = open(&gpu, CALM, 1.0);
    let (exact, _) = film_where_woc_is_cheap(&mut session, "0");
    assert!(exact.iter().all(|id| id != "woc"), "{exact:?}");
    let (chosen, drawn) = film_where_woc_is_cheap(&mut session, "10");
    let truth = RunTruth::draw(&mut session, || ()).unwrap();
    assert!(chosen[20..].iter().all(|id| id == "woc"), "{chosen:?}");
    let began = chosen.iter().position(|id| id == "woc").unwrap();
    for (frame, drawn) in drawn.iter().enumerate() {
        let in_row = if chosen[frame] == "woc" { frame - began + 1 } else { 0 };
        if in_row <= 2 || in_row % EVERY as usize == 0 {
            let visible = truth.sets.frame(frame).unwrap();
            let lost = (0..drawn.objects.len()).filter(|at| visible.contains(*at) && !drawn.objects[*at]).count();
            assert_eq!(lost, 0, "frame {frame}, the {in_row}. of woc");
        }
    }
}

/// Where all moves quickly, `woc` errs by a tenth of a percent and more: a check that finds that ends it, where less is allowed.
#[test]
fn who_errs_more_than_is_allowed_is_not_used_any_more() {
    let gpu = gpu();
    let mut balloons = open(&gpu, ("moving-balloons", 0.3, "still"), 32.0);
    let mut used = |allow| {
        let (chosen, _) = film_where_woc_is_cheap(&mut balloons, allow);
        (chosen.iter().filter(|id| *id == "woc").count(), chosen)
    };
    let (allowed, chosen) = used("1");
    assert!(allowed > 20, "{chosen:?}");
    let (forbidden, chosen) = used("0.05");
    // Its first frame is not judged; the second is, and the sixteenth.
    assert!([2, 16].contains(&forbidden) && chosen[30..].iter().all(|id| id != "woc"), "{forbidden}: {chosen:?}");
}
