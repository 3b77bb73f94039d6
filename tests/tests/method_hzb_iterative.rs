//! The laws of `hzb-iterative`, its stages against their twins, and what depth ranges promise.

harness::exact_method_tests!("hzb-iterative");
harness::skipping_method_tests!("hzb-iterative");
