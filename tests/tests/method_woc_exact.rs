//! The laws of `woc-exact`.

harness::exact_method_tests!("woc-exact");
harness::skipping_method_tests!("woc-exact");

/// Settings that hide too much, or take too little care: what they get wrong must be repaired.
fn subjects() -> Vec<Subject> {
    let sets: [&[(&str, &str)]; 7] = [
        &[("erode", "none")],
        &[("erode", "footprint"), ("margin", "0"), ("structure", "n-buffer"), ("rapid", "0")],
        &[("erode", "none"), ("close", "false"), ("size", "2")],
        &[("size", "4")],
        &[("structure", "n-buffer"), ("seeds", "1"), ("iterations", "1")],
        &[("structure", "mip"), ("erode", "none"), ("steps", "0")],
        &[("seeds", "16"), ("threshold", "0.125"), ("tile", "1")],
    ];
    let set = |options: &[(&str, &str)]| {
        options.iter().fold(Subject::named("woc-exact"), |subject, (option, value)| subject.with(option, value))
    };
    sets.iter().map(|options| set(options)).collect()
}

#[test]
fn no_setting_misses_an_object() {
    let gpu = gpu();
    for subject in subjects() {
        for case in [worlds::walled(300), worlds::special::topologies(), worlds::walled(100).sized([640, 360])] {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
        assert_none(&laws::skipping_changes_no_pixel(&gpu, &subject, &worlds::walled(100)));
    }
}

#[test]
fn any_size_is_exact() {
    let gpu = gpu();
    for subject in [Subject::named("woc-exact"), Subject::named("woc-exact").with("size", "4").with("erode", "none")] {
        assert_none(&laws::any_size_is_exact(&gpu, &subject, &worlds::walled(100)));
    }
}

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("woc-exact"), &worlds::walled(400)));
}
