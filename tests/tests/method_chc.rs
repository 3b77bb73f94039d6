//! The laws of `chc`.

harness::exact_method_tests!("chc");
harness::skipping_method_tests!("chc");

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("chc"), &worlds::walled(400)));
}

#[test]
fn every_window_and_split_is_exact() {
    let gpu = gpu();
    for (window, bvh) in [("1", "sah"), ("5", "middle"), ("16384", "equal")] {
        let subject = Subject::named("chc").with("window", window).with("bvh", bvh);
        for case in [worlds::walled(100), worlds::special::topologies(), worlds::special::ties()] {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
    }
}
