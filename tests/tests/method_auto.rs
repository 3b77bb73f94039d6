//! The laws of `auto`. Its decisions are tested without a device (`culling/src/auto/choose/tests.rs`); here what it draws: candidates take
//! turns in every frame, which is the most that decisions by time could do.

use culling::drawn_objects;
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
