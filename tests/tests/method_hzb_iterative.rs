//! The laws of `hzb-iterative`, its stages against their twins, and what depth ranges promise.

#[path = "method_hzb_iterative/input.rs"]
mod input;
#[path = "method_hzb_iterative/seeds.rs"]
mod seeds;
#[path = "method_hzb_iterative/stages.rs"]
mod stages;

harness::exact_method_tests!("hzb-iterative");
harness::skipping_method_tests!("hzb-iterative");

/// Settings unlike the default; they take turns at the worlds.
const SETTINGS: [&[(&str, &str)]; 7] = [
    &[("ranges", "1")],
    &[("ranges", "2"), ("boxes", "false"), ("finest", "2"), ("rays", "off")],
    &[("ranges", "3"), ("factor", "16"), ("small", "0"), ("rays", "device")],
    &[("ranges", "5"), ("every", "1"), ("finest", "1"), ("rays", "off")],
    &[("ranges", "5"), ("small", "0"), ("texels", "2"), ("rays", "off")],
    &[("ranges", "1"), ("small", "0"), ("every", "64"), ("rays", "device")],
    &[("rays", "off")],
];

fn setting(set: &[(&str, &str)]) -> Subject {
    set.iter().fold(Subject::named("hzb-iterative"), |subject, (option, value)| subject.with(option, value))
}

#[test]
fn any_setting_is_exact() {
    let gpu = gpu();
    for (number, subject) in SETTINGS.map(setting).into_iter().enumerate() {
        let cases = worlds::special().into_iter().enumerate();
        for (_, case) in cases.filter(|(case, _)| harness::takes_turn(number, *case, 3)) {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
        assert_none(&laws::a_resize_hides_nothing(&gpu, &subject, &worlds::walled(200)));
        assert_none(&laws::a_camera_cut_hides_nothing(&gpu, &subject, &worlds::walled(200)));
    }
}

#[test]
fn any_number_of_ranges_can_be_skipped() {
    // In several ranges every step's list is drawn again before a still camera; left to itself the method takes one there.
    let gpu = gpu();
    for subject in [setting(SETTINGS[1]), setting(SETTINGS[4])] {
        for case in [worlds::walled(200), worlds::materials::masked_wall()] {
            assert_none(&laws::skipping_changes_no_pixel(&gpu, &subject, &case));
        }
    }
}

#[test]
fn any_size_is_exact() {
    let gpu = gpu();
    assert_none(&laws::any_size_is_exact(&gpu, &setting(SETTINGS[4]), &worlds::walled(100)));
}

#[test]
fn what_is_no_longer_seen_is_no_longer_drawn() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let law = |subject: &Subject| laws::what_is_no_longer_seen_is_no_longer_drawn(&gpu, subject, &case);
    assert_none(&law(&Subject::named("hzb-iterative")));
    let never = Subject::named("hzb-iterative").with("every", "64");
    assert!(!law(&never).is_empty(), "who is seen is not looked at again for 64 frames, and the law does not notice");
}

#[test]
fn a_still_camera_has_only_drawn_who_owns_a_pixel() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let case = case.filmed(vec![case.shots[0]; 8]);
    let mut lab = harness::Lab::new(&gpu, &case);
    let (truths, sets) = lab.truths(&case.shots);
    let mut method = lab.make(&Subject::named("hzb-iterative"), &sets);
    let takes = lab.film(&mut *method, &case.shots);
    let last = harness::lab::error_of(&truths[7], &takes[7]);
    assert_eq!((last.false_negatives, last.false_positives, last.differing_pixels), (0, 0, 0));
    let before = harness::lab::error_of(&truths[3], &takes[3]);
    assert!(before.false_positives > 0, "hidden objects whose boxes show were drawn before, or this proves nothing");
}

/// How many commands with an instance each draw of a frame has, in order.
fn drawn_by_step(gpu: &engine::Gpu, take: &harness::Take) -> Vec<usize> {
    let read = |draw: &engine::IndexedIndirect| {
        let commands = gpu.read_bound::<shaders::types::DrawCommand>(&draw.commands).unwrap();
        let count = draw.count.map_or(draw.max_draws, |count| gpu.read_bound::<u32>(&count.into()).unwrap()[0]);
        commands[..count as usize].iter().filter(|command| command.instance_count > 0).count()
    };
    take.report.draws.iter().map(read).collect()
}

#[test]
fn what_a_box_brought_in_is_drawn_ahead_in_the_next_frame() {
    let gpu = gpu();
    let case = worlds::walled(400);
    // By a hair, up so that bodies come into view from behind the wall, and on by a hair.
    let shot = |height: f64| {
        let pose = scenes::Pose::looking_at(glam::DVec3::new(0.7, height, 7.0), glam::DVec3::ZERO);
        scenes::Shot { pose, ..case.shots[0] }
    };
    let case = case.filmed([3.0, 3.0001, 3.8, 3.8001].map(shot).to_vec());
    let mut lab = harness::Lab::new(&gpu, &case);
    // In two ranges, with every box tested, and nobody looking at the item buffer between the frames.
    let subject = setting(&[("ranges", "2"), ("rays", "off"), ("small", "0"), ("every", "64")]);
    let mut method = lab.make(&subject, &Default::default());
    let mut steps = Vec::new();
    for (frame, shot) in case.shots.iter().enumerate() {
        let take = lab.take(&mut *method, shot, frame);
        steps.push(drawn_by_step(&gpu, &take));
    }
    let last_step = |frame: usize| *steps[frame].last().unwrap();
    let drawn = |frame: usize| steps[frame].iter().sum::<usize>();
    assert!(last_step(2) > 10, "nothing comes into view, so this proves nothing: {steps:?}");
    assert_eq!((last_step(3), drawn(3)), (0, drawn(2)), "{steps:?}");
}

#[test]
fn a_list_that_serves_again_is_made_of_owners_every_few_frames() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let shot = |frame: u32| {
        let height = if frame < 3 { 3.0 } else { 3.8 } + 1e-4 * f64::from(frame);
        scenes::Shot {
            pose: scenes::Pose::looking_at(glam::DVec3::new(0.7, height, 7.0), glam::DVec3::ZERO),
            ..case.shots[0]
        }
    };
    let case = case.filmed((0..9).map(shot).collect());
    let mut lab = harness::Lab::new(&gpu, &case);
    let mut method = lab.make(&setting(&[("ranges", "1"), ("rays", "off"), ("every", "4")]), &Default::default());
    let (mut steps, mut anew) = (Vec::new(), Vec::new());
    for (frame, shot) in case.shots.iter().enumerate() {
        let take = lab.take(&mut *method, shot, frame);
        steps.push(drawn_by_step(&gpu, &take));
        anew.push(!take.report.skips.iter().any(|skip| skip.reason == "an earlier frame's list serves"));
    }
    assert_eq!(
        anew,
        [true, true, false, false, false, true, false, false, false],
        "looked at owners in frames 0, 4 and 8"
    );
    // What comes into view in frame 3 is tested until owners are known, and drawn ahead from then on.
    let [(ahead, came), (_, again)] = [3, 4].map(|frame: usize| (steps[frame][0], steps[frame][1]));
    assert!(came > 10 && again > 10, "{steps:?}");
    assert!(steps[5][0] > ahead && steps[5][1] < again, "{steps:?}");
}

/// What a frame drew needs no box in the next ones, until owners are looked at: it is drawn again though its box no longer shows, if the
/// pyramid lets it through. Without such a frame before it, the box decides.
#[test]
fn what_is_known_to_show_needs_no_box() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let at = |height: f64| scenes::Shot {
        pose: scenes::Pose::looking_at(glam::DVec3::new(0.7, height, 7.0), glam::DVec3::ZERO),
        ..case.shots[0]
    };
    let drawn = |heights: [f64; 4]| {
        let case = case.filmed(heights.map(at).to_vec());
        let mut lab = harness::Lab::new(&gpu, &case);
        let subject = setting(&[("ranges", "1"), ("rays", "off"), ("small", "0"), ("finest", "3"), ("texels", "2")]);
        let mut method = lab.make(&subject, &Default::default());
        let [.., before, last] = &lab.film(&mut *method, &case.shots)[..] else { panic!("four frames") };
        [before.drawn.objects.clone(), last.drawn.objects.clone()]
    };
    // The list of step 0 is that of the first height; the last picture is the same.
    let [met, known] = drawn([3.0, 3.001, 3.8, 3.6]);
    let [_, unknown] = drawn([3.0, 3.001, 3.001, 3.6]);
    let only = |one: &[bool], other: &[bool]| -> Vec<usize> {
        (0..one.len()).filter(|object| one[*object] && !other[*object]).collect()
    };
    assert_eq!(only(&unknown, &known), [0usize; 0], "what shows is drawn, known or not");
    let boxless = only(&known, &unknown);
    assert!(!boxless.is_empty() && boxless.iter().all(|object| met[*object]), "{boxless:?} have been drawn before");
}

/// Where cut follows cut, what a frame finds out of owners would be forgotten unread.
#[test]
fn owners_are_looked_at_where_a_next_frame_reads_of_them() {
    let gpu = gpu();
    let case = worlds::walled(100);
    let from = |x: f64, z: f64| scenes::Shot {
        pose: scenes::Pose::looking_at(glam::DVec3::new(x, 3.0, z), glam::DVec3::ZERO),
        ..case.shots[0]
    };
    let shots = [from(0.7, 7.0), from(0.7, -7.0), from(7.0, 0.7), from(7.0, 0.7001), from(7.0, 0.7002), from(0.7, 7.0)];
    let case = case.filmed(shots.to_vec());
    let mut lab = harness::Lab::new(&gpu, &case);
    let mut method = lab.make(&Subject::named("hzb-iterative"), &Default::default());
    let takes = lab.film(&mut *method, &case.shots);
    let looked = takes.iter().map(|take| !take.report.skips.iter().any(|skip| skip.label == "eovc/filter_occluders"));
    assert_eq!(
        looked.collect::<Vec<_>>(),
        [true, false, false, true, false, true],
        "a cut, two more, calm, calm, a cut"
    );
}

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("hzb-iterative"), &worlds::walled(400)));
}
