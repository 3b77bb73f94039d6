//! The laws of `hom`, its stages against their twins, and what farthest-depth maps promise.

#[path = "method_hom/maps.rs"]
mod maps;
#[path = "method_hom/planted.rs"]
mod planted;
#[path = "method_hom/stage.rs"]
mod stage;

harness::exact_method_tests!("hom");
harness::skipping_method_tests!("hom");

/// Every structure at every size.
fn subjects() -> Vec<Subject> {
    let structures: [&[(&str, &str)]; 5] = [
        &[("structure", "n-buffer")],
        &[("structure", "y-map"), ("levels", "0")],
        &[("structure", "y-map"), ("levels", "1")],
        &[("structure", "y-map"), ("levels", "5")],
        &[("structure", "mip")],
    ];
    let set = |subject: Subject, options: &[(&str, &str)]| {
        options.iter().fold(subject, |subject, (option, value)| subject.with(option, value))
    };
    let with_sizes =
        |options: &[(&str, &str)]| ["1", "2", "4"].map(|size| set(Subject::named("hom").with("size", size), options));
    structures.iter().flat_map(|options| with_sizes(options)).collect()
}

#[test]
fn every_structure_is_exact_at_every_size() {
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
    for subject in [Subject::named("hom"), Subject::named("hom").with("structure", "n-buffer").with("size", "4")] {
        assert_none(&laws::any_size_is_exact(&gpu, &subject, &worlds::walled(100)));
    }
}

#[test]
fn every_structure_culls_what_a_wall_hides() {
    let gpu = gpu();
    for subject in subjects() {
        assert_none(&laws::what_a_wall_hides_is_culled(&gpu, &subject, &worlds::walled(400)));
    }
}
