//! The laws of `hzb`, its stages against their twins, and what its footprints promise.

#[path = "method_hzb/footprint.rs"]
mod footprint;
#[path = "method_hzb/pyramid.rs"]
mod pyramid;
#[path = "method_hzb/stage.rs"]
mod stage;

harness::exact_method_tests!("hzb");
harness::skipping_method_tests!("hzb");

#[test]
fn any_size_is_exact() {
    let gpu = gpu();
    assert_none(&laws::any_size_is_exact(&gpu, &Subject::named("hzb"), &worlds::walled(100)));
}

#[test]
fn any_number_of_texels_is_exact() {
    let gpu = gpu();
    for texels in ["2", "3", "16"] {
        let subject = Subject::named("hzb").with("texels", texels);
        for case in [worlds::walled(300), worlds::walled(300).sized([640, 360])] {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
    }
}

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("hzb"), &worlds::walled(400)));
}
