//! The laws of `ref`.

harness::exact_method_tests!("ref");

#[test]
fn exactly_the_visible_set_is_drawn() {
    let gpu = gpu();
    for case in worlds::special() {
        let mut lab = harness::Lab::new(&gpu, &case);
        let (truths, sets) = lab.truths(&case.shots);
        let mut method = lab.make(&Subject::named("ref"), &sets);
        for (take, truth) in lab.film(&mut *method, &case.shots).iter().zip(&truths) {
            let error = harness::lab::error_of(truth, take);
            assert_eq!((error.false_negatives, error.false_positives), (0, 0), "{}", case.name);
            assert_eq!(error.tied_pixels, 0, "{}: the packed order keeps ties", case.name);
        }
    }
}

#[test]
fn near_to_far_the_same_is_drawn() {
    let gpu = gpu();
    for case in worlds::special() {
        let mut lab = harness::Lab::new(&gpu, &case);
        let (truths, sets) = lab.truths(&case.shots);
        let mut method = lab.make(&Subject::named("ref").with("order", "near"), &sets);
        for (take, truth) in lab.film(&mut *method, &case.shots).iter().zip(&truths) {
            let error = harness::lab::error_of(truth, take);
            assert_eq!((error.false_negatives, error.false_positives), (0, 0), "{}", case.name);
            assert_eq!(error.differing_pixels, 0, "{}", case.name);
        }
    }
}

#[test]
fn without_visible_sets_it_says_what_is_missing() {
    let gpu = gpu();
    let lab = harness::Lab::new(&gpu, &worlds::walled(5));
    let subject = Subject::named("ref");
    let setup = culling::Setup { gpu: &gpu, world: &lab.world, options: &subject.options, visible: None };
    let error = (subject.make)(&setup).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.contains("truth pass"), "{error}");
}

#[test]
fn a_frame_past_the_last_visible_set_is_refused() {
    let gpu = gpu();
    let case = worlds::walled(5);
    let mut lab = harness::Lab::new(&gpu, &case);
    let (_, sets) = lab.truths(&case.shots[..2]);
    let mut method = lab.make(&Subject::named("ref"), &sets);
    let view = lab.look(&case.shots[0], 2);
    let error = method.prepare(&lab.world, &view).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.contains("frame 2") && error.contains("2 frames"), "{error}");
}
