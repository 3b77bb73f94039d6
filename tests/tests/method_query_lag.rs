//! The laws of `query-lag`: it errs, says so, and stops erring when the camera stops.

use harness::{approximate, assert_none, gpu, laws, worlds, Subject};

fn subjects() -> [Subject; 2] {
    ["1", "5"].map(|every| Subject::named("query-lag").with("every", every))
}

#[test]
fn it_says_that_it_may_miss_objects() {
    let guarantee = culling::find("query-lag").unwrap().guarantee;
    assert!(matches!(guarantee, culling::Guarantee::Approximate(why) if !why.is_empty()));
}

#[test]
fn a_still_camera_is_exact() {
    let gpu = gpu();
    for subject in subjects() {
        let cases = worlds::special().into_iter();
        let faults = cases.flat_map(|case| approximate::a_still_camera_is_exact(&gpu, &subject, &case));
        assert_none(&faults.collect::<Vec<_>>());
    }
}

#[test]
fn a_first_frame_is_exact() {
    let gpu = gpu();
    for subject in subjects() {
        let cases = worlds::special().into_iter();
        let faults = cases.flat_map(|case| approximate::a_first_frame_is_exact(&gpu, &subject, &case));
        assert_none(&faults.collect::<Vec<_>>());
    }
}

/// It lags: where the camera jumps from view to view, something that comes into view is missing, and is counted.
#[test]
fn what_comes_into_view_is_counted_as_missed() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let shots: Vec<_> = case.shots.iter().flat_map(|shot| [*shot; 3]).collect();
    let faults = laws::no_visible_object_is_culled(&gpu, &Subject::named("query-lag"), &case.filmed(shots));
    assert!(faults.iter().any(|fault| fault.contains("false negatives")), "{faults:?}");
    for fault in &faults {
        let frame: usize =
            fault.split("frame ").nth(1).and_then(|rest| rest.split(':').next()).unwrap().parse().unwrap();
        assert_eq!(frame % 3, 0, "only the first frame of a view errs: {fault}");
    }
}

/// On the bench's paths at speed 1 it misses few.
#[test]
fn few_objects_are_missed() {
    let gpu = gpu();
    for run in
        [("city-block", 0.02, "walk"), ("city-block", 0.02, "rotate"), ("rooms", 0.1, "walk"), ("boxes", 1.0, "pan")]
    {
        let found = approximate::missed(&gpu, &Subject::named("query-lag"), "query-lag", run, 8);
        let missed = 100.0 * found.missed as f64 / found.visible as f64;
        println!("{run:?}: {missed:.4} % of {} visible objects missed", found.visible);
        assert!(found.visible > 0, "{run:?} shows nothing, so it proves nothing");
        assert!(missed <= 1.0, "{run:?}: {missed:.4} % of visible objects missed");
    }
}

#[test]
fn two_runs_give_the_same_bytes() {
    let gpu = gpu();
    for case in worlds::special() {
        assert_none(&laws::two_runs_give_the_same_bytes(&gpu, &Subject::named("query-lag"), &case));
        assert_none(&laws::decisions_do_not_depend_on_the_pass(&gpu, &Subject::named("query-lag"), &case));
    }
}

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("query-lag"), &worlds::walled(400)));
}
