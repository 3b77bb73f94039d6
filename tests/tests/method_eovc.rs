//! The laws of `eovc`.

harness::exact_method_tests!("eovc");
harness::skipping_method_tests!("eovc");

#[test]
fn what_a_wall_hides_is_culled() {
    let gpu = gpu();
    assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &Subject::named("eovc"), &worlds::walled(400)));
}
