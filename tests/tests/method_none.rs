//! The laws of `none`.

harness::exact_method_tests!("none");

#[test]
fn every_object_is_drawn_once_and_in_order() {
    let gpu = gpu();
    for case in worlds::special() {
        let mut lab = harness::Lab::new(&gpu, &case);
        let mut method = lab.make(&Subject::named("none"), &Default::default());
        let take = lab.take(&mut *method, &case.shots[0], 0);
        let drawn: Vec<u32> = take.commands.iter().map(|command| command.first_instance).collect();
        // Translucent ones come last, back to front: their order is the view's, and tests/materials.rs looks at it.
        let solid = lab.world.len();
        assert_eq!(drawn[..solid], (0..solid as u32).collect::<Vec<_>>(), "{}", case.name);
        let mut translucent = drawn[solid..].to_vec();
        translucent.sort_unstable();
        assert_eq!(translucent, (solid as u32..case.scene.objects.len() as u32).collect::<Vec<_>>(), "{}", case.name);
    }
}
