//! The laws of `eovc`.

harness::exact_method_tests!("eovc");
harness::skipping_method_tests!("eovc");
