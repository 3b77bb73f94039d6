//! What each command does, from arguments to output.

mod bench;
mod compare;
mod info;
mod manual;
mod report;
mod scene;
mod shot;
mod stress;
mod sweep;
mod table;
mod view;

pub use stress::all_drills;

use crate::cli::{Cli, Command};
pub(crate) use crate::results::output::{put, say};
use anyhow::Result;
use std::process::ExitCode;

/// Runs the command that was typed, and says by its exit code what became of it: 0 good, 1 an error, or a gate of `compare` that was
/// true; an error of `compare` is 2, so that CI can tell it from a gate.
pub fn exit_code(cli: Cli) -> ExitCode {
    let compares = matches!(cli.command, Command::Compare(_));
    match run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // One line: the chain of causes, outermost first.
            eprintln!("sightline: {error:#}");
            let is_gate = error.is::<compare::GatesTrue>();
            ExitCode::from(if compares && !is_gate { 2 } else { 1 })
        }
    }
}

/// Runs the command that was typed.
pub fn run(cli: Cli) -> Result<()> {
    match cli.command {
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Bench(arguments) => match &arguments.table {
            Some(table) => table::run(&arguments, table),
            None if !arguments.sweeps.sweep.is_empty() => sweep::run(&arguments),
            None => bench::run(&arguments),
        },
        Command::Report(arguments) => report::run(&arguments),
        Command::Shot(arguments) => shot::run(&arguments),
        Command::View(arguments) => view::run(&arguments),
        Command::Stress(arguments) => stress::run(&arguments),
        Command::Scene(arguments) => scene::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { command } => manual::page(command.as_deref()),
    }
}
