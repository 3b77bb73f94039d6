//! The laws of `eovc`, at its defaults and in every setting of its thesis' tables 3 and 4.

harness::exact_method_tests!("eovc");
harness::skipping_method_tests!("eovc");

/// Accelerations (III.6) by splits (table 4).
fn settings() -> Vec<[(&'static str, &'static str); 4]> {
    let mut settings = Vec::new();
    for bvh in ["sah", "middle", "equal"] {
        for commands in ["packed", "zero-instance"] {
            for (of, cr) in [("false", "false"), ("false", "true"), ("true", "false"), ("true", "true")] {
                settings.push([("bvh", bvh), ("commands", commands), ("of", of), ("cr", cr)]);
            }
        }
    }
    settings
}

fn subjects() -> Vec<Subject> {
    let with = |setting: [(&str, &str); 4]| {
        setting.iter().fold(Subject::named("eovc"), |subject, (option, value)| subject.with(option, value))
    };
    settings().into_iter().map(with).collect()
}

/// Settings take turns at the worlds.
#[test]
fn no_setting_culls_a_visible_object() {
    let gpu = gpu();
    let cases = worlds::special();
    let subjects = subjects();
    assert_eq!(subjects.len(), 24);
    let mut faults = Vec::new();
    for (setting, subject) in subjects.iter().enumerate() {
        for (_, case) in cases.iter().enumerate().filter(|(case, _)| harness::takes_turn(setting, *case, 4)) {
            faults.extend(laws::no_visible_object_is_culled(&gpu, subject, case));
        }
    }
    assert_none(&faults);
}

#[test]
fn no_setting_fails_at_a_cut_or_resize() {
    let gpu = gpu();
    let case = worlds::walled(200);
    let faults = subjects().into_iter().flat_map(|subject| {
        let mut faults = laws::a_camera_cut_hides_nothing(&gpu, &subject, &case);
        faults.extend(laws::a_resize_hides_nothing(&gpu, &subject, &case));
        faults
    });
    assert_none(&faults.collect::<Vec<_>>());
}

/// Each setting takes its turn at the scenes and paths of the bench; all take all of them if SIGHTLINE_STRESS_CASES is set.
#[test]
fn no_setting_fails_on_a_path() {
    let gpu = gpu();
    let all = std::env::var_os("SIGHTLINE_STRESS_CASES").is_some();
    let mut faults = Vec::new();
    for (turn, setting) in settings().iter().enumerate() {
        let chosen = |index: usize| all || index == turn % sessions::RUNS.len();
        for (_, run) in sessions::RUNS.iter().enumerate().filter(|(index, _)| chosen(*index)) {
            faults.extend(sessions::faults(&mut sessions::open(&gpu, *run, 8), "eovc", setting));
        }
    }
    assert_none(&faults);
}

#[test]
fn the_thesis_own_groups_hide_nothing() {
    let gpu = gpu();
    let thesis = Subject::named("eovc").with("coherent", "false");
    for subject in [thesis.clone(), thesis.with("of", "false")] {
        let faults =
            worlds::special().into_iter().flat_map(|case| laws::no_visible_object_is_culled(&gpu, &subject, &case));
        assert_none(&faults.collect::<Vec<_>>());
    }
    assert_none(&sessions::all_faults(&gpu, "eovc", &[("coherent", "false")]));
}

/// Early tests let hidden objects through that are drawn before what hides them; the item buffer does not (table 5).
#[test]
fn occluder_filtering_draws_fewer_hidden_objects() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let case = case.filmed(vec![case.shots[0]; 4]);
    let mut lab = harness::Lab::new(&gpu, &case);
    let (truths, sets) = lab.truths(&case.shots);
    let drawn = ["false", "true"].map(|of| {
        let mut method = lab.make(&Subject::named("eovc").with("of", of), &sets);
        let takes = lab.film(&mut *method, &case.shots);
        takes[3].drawn.objects.iter().filter(|drawn| **drawn).count()
    });
    assert!(drawn[1] >= truths[3].visible_count() && drawn[1] < drawn[0], "unfiltered, filtered: {drawn:?}");
}

/// The stall of a read-back is a row of the frame, and a list that is read back draws as many commands as there are.
#[test]
fn a_read_back_shows_and_counts_exactly() {
    let gpu = gpu();
    let case = worlds::walled(200);
    let mut lab = harness::Lab::new(&gpu, &case);
    let (_, sets) = lab.truths(&case.shots);
    let mut method = lab.make(&Subject::named("eovc").with("cr", "true"), &sets);
    for take in lab.film(&mut *method, &case.shots) {
        let stalls = take.report.stages.iter().filter(|stage| stage.label.starts_with("frame/read_back"));
        assert!(take.report.submissions > 1 && stalls.count() >= 3, "{:?}", take.report.stages);
        assert!(take.report.draws.iter().all(|draw| draw.count.is_none()));
        assert_eq!(take.report.draws.iter().map(|draw| draw.max_draws).sum::<u32>() as usize, take.commands.len());
        assert!(take.commands.iter().all(|command| command.instance_count == 1));
    }
}

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("eovc"), &worlds::walled(400)));
}
