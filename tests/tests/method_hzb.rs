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
    let case = worlds::walled(400);
    let case = case.filmed(vec![case.shots[0]; 3]);
    let mut lab = harness::Lab::new(&gpu, &case);
    let (truths, sets) = lab.truths(&case.shots);
    let films = ["frustum", "hzb"].map(|id| {
        let mut method = lab.make(&Subject::named(id), &sets);
        lab.film(&mut *method, &case.shots)
    });
    // The third frame is the first that draws only what its predecessor, with all of the depth, has seen.
    let drawn = films.map(|film| film[2].drawn.objects.iter().filter(|drawn| **drawn).count());
    let visible = truths[2].visible_count();
    assert!(
        drawn[1] >= visible && drawn[1] - visible < (drawn[0] - visible) / 4,
        "of {visible}: frustum, hzb {drawn:?}"
    );
}
