//! The laws of `roc`.

harness::exact_method_tests!("roc");
harness::skipping_method_tests!("roc");

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("roc"), &worlds::walled(400)));
}
