//! The laws of `roc`.

harness::exact_method_tests!("roc");
harness::skipping_method_tests!("roc");
