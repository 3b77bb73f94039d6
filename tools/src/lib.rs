//! The `sightline` program as a library: sessions, truth, metrics, results, and the commands.

pub mod bench;
pub mod boxes_view;
pub mod cli;
pub mod commands;
pub mod compare;
pub mod files;
mod grid;
mod lines;
pub mod metrics;
pub mod pareto;
pub mod png_out;
pub mod report;
pub mod results;
pub mod run;
pub mod session;
pub mod stats;
pub mod stress;
pub mod sweep;
pub mod tables;
pub mod targets;
pub mod trace;
pub mod truth;
pub mod view;
pub mod warp_errors;
pub mod warp_view;
