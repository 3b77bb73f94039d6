//! The laws of `woc`, and its stages against their twins.

#[path = "method_woc/hybrid.rs"]
mod hybrid;
#[path = "method_woc/planted.rs"]
mod planted;
#[path = "method_woc/rapid.rs"]
mod rapid;
#[path = "method_woc/stages.rs"]
mod stages;

harness::approximate_method_tests!("woc", 0.08, 0.01);
