//! The stages of `hzb-iterative` in plain Rust: their definition.

