//! The laws of `chc++`, and what it is for: fewer queries and state changes than `chc`.

harness::exact_method_tests!("chc++");
harness::skipping_method_tests!("chc++");

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("chc++"), &worlds::walled(400)));
}

#[test]
fn every_setting_is_exact() {
    let gpu = gpu();
    let settings: [&[(&str, &str)]; 5] = [
        &[("n_av", "1"), ("b", "1")],
        &[("d_max", "0"), ("multi", "false")],
        &[("d_max", "6"), ("s_max", "10")],
        &[("window", "1"), ("b", "3")],
        &[("n_av", "1000"), ("b", "1000"), ("window", "16384")],
    ];
    for setting in settings {
        let subject =
            setting.iter().fold(Subject::named("chc++"), |subject, (option, value)| subject.with(option, value));
        for case in [worlds::walled(100), worlds::special::topologies(), worlds::special::ties()] {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
    }
}

/// Queries and state changes of all frames of a run.
fn asked(gpu: &engine::Gpu, id: &str, run: (&str, f64, &str)) -> [u64; 2] {
    let mut session = sessions::open_at_speed_one(gpu, run, 12);
    let entry = culling::find(id).unwrap();
    let mut contender = sightline::run::Contender::new(&session, entry, entry.default_options(), &None).unwrap();
    let mut sum = [0; 2];
    for frame in 0..session.frames() {
        contender.timed(&mut session, frame).unwrap();
        let work = contender.method.work().unwrap();
        sum[0] += work.queries;
        sum[1] += work.state_changes;
    }
    sum
}

#[test]
fn it_asks_and_changes_state_less_than_chc() {
    let gpu = gpu();
    for run in
        [("city-block", 0.02, "walk"), ("rooms", 0.1, "walk"), ("factory", 0.02, "walk"), ("moving-boxes", 1.0, "walk")]
    {
        let [chc, chcpp, nohc] = ["chc", "chc++", "nohc"].map(|id| asked(&gpu, id, run));
        println!("{run:?}: queries and state changes of 12 frames: chc {chc:?}, chc++ {chcpp:?}, nohc {nohc:?}");
        assert!(chcpp[0] < chc[0], "{run:?}: {} queries, chc {}", chcpp[0], chc[0]);
        assert!(chcpp[1] < chc[1], "{run:?}: {} state changes, chc {}", chcpp[1], chc[1]);
        assert!(nohc[0] <= chc[0], "{run:?}: nohc asks {} times, chc {}", nohc[0], chc[0]);
    }
}
