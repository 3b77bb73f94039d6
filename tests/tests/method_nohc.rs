//! The laws of `nohc`, and its model of costs.

harness::exact_method_tests!("nohc");
harness::skipping_method_tests!("nohc");

/// What is measured has an order that no device turns round: costs are there, and more of anything costs no less.
#[test]
fn costs_are_fitted_once_and_grow() {
    let gpu = gpu();
    let costs = culling::queries::Costs::of(&gpu).unwrap();
    println!("{costs}");
    assert_eq!(costs, culling::queries::Costs::of(&gpu).unwrap(), "measured once");
    assert!(costs.query_ms(1.0) > 0.0, "{costs}");
    assert!(costs.query_ms(1e6) >= costs.query_ms(1.0));
    assert!(costs.draw_ms(1.0, 1e6) > costs.draw_ms(1.0, 10.0), "{costs}");
}

#[test]
fn it_prints_its_constants() {
    let gpu = gpu();
    let lab = harness::Lab::new(&gpu, &worlds::walled(20));
    let lines = lab.make(&Subject::named("nohc"), &Default::default()).choices();
    assert!(lines[0].contains("us") && lines[0].contains("a query") && lines[0].contains("a triangle"), "{lines:?}");
}
