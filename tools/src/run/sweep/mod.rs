//! `bench --sweep`: all combinations of some options' values, run in cells that are kept, so that a long sweep can be interrupted.
//!
//! A cell is a few settings and the baseline, timed by turns as in any run; the ratio to the baseline of its own cell is what
//! settings of different cells are compared by, because the machine may be busier in one than in another. Measured times stay as
//! they were measured.

mod cells;
mod grid;

pub use cells::{run, Kept, SweepPlan};
pub use grid::{Sweep, MOST_SETTINGS};
