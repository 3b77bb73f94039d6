//! The laws of `awoc`.

harness::approximate_method_tests!("awoc", 1.0, 0.1);
