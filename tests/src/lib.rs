//! The harness: a device with validation on, small worlds, laws that hold for every method, and checkers that can fail.
//!
//! Laws return their faults, one line each, instead of panicking: so a test can plant an error and see it reported.

pub mod approximate;
pub mod confetti;
pub mod device;
pub mod footprints;
pub mod golden;
pub mod guarded;
pub mod hazards;
pub mod lab;
pub mod laws;
pub mod occludees;
pub mod oracle;
pub mod replaced;
pub mod sessions;

pub use device::{gpu, options, Device};
pub use lab::{Lab, Subject, Take};
pub use sightline::stress::{worlds, Case, Random};

/// True if a setting takes its turn at a case: one in `of` does, each setting at some cases and each case with some settings;
/// all do if SIGHTLINE_STRESS_CASES is set. `sightline stress` runs settings by chance at many more worlds.
pub fn takes_turn(setting: usize, case: usize, of: usize) -> bool {
    std::env::var_os("SIGHTLINE_STRESS_CASES").is_some() || (setting + case).is_multiple_of(of)
}

/// Fails with every fault on a line of its own.
///
/// # Panics
/// If there is a fault.
#[track_caller]
pub fn assert_none(faults: &[String]) {
    assert!(faults.is_empty(), "{} faults:\n{}\n", faults.len(), faults.join("\n"));
}

/// Fails if no fault was found where one was planted.
///
/// # Panics
/// If there is none, or if none has `expected` in it.
#[track_caller]
pub fn assert_caught(faults: &[String], expected: &str) {
    assert!(
        faults.iter().any(|fault| fault.contains(expected)),
        "a planted error went unnoticed: no fault says '{expected}' among {faults:?}"
    );
}
