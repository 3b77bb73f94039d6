//! The laws of `frustum`, and its stages against their twins and the f64 oracle.

#[path = "method_frustum/shapes.rs"]
mod shapes;
#[path = "method_frustum/stage.rs"]
mod stage;

harness::exact_method_tests!("frustum");
harness::skipping_method_tests!("frustum");
