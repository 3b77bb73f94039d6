//! What each command does, from arguments to output.

mod bench;
mod compare;
mod info;
mod report;
mod scene;
mod shot;
mod stress;
mod sweep;
mod table;

pub use stress::all_drills;

use crate::cli::{Cli, Command};
use anyhow::Result;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

/// Runs the command that was typed. An error is told in one line: the chain of causes, outermost first.
pub fn exit_code(cli: Cli) -> ExitCode {
    let error_code = if matches!(cli.command, Command::Compare(_)) { compare::ERROR } else { 1 };
    run(cli).unwrap_or_else(|error| {
        eprintln!("sightline: {error:#}");
        ExitCode::from(error_code)
    })
}

/// Runs the command that was typed, and says how a program that did so ends.
pub fn run(cli: Cli) -> Result<ExitCode> {
    match cli.command {
        Command::Compare(arguments) => return compare::run(&arguments),
        Command::Bench(arguments) => match &arguments.table {
            Some(table) => table::run(&arguments, table),
            None if !arguments.sweeps.sweep.is_empty() => sweep::run(&arguments),
            None => bench::run(&arguments),
        },
        Command::Report(arguments) => report::run(&arguments),
        Command::Shot(arguments) => shot::run(&arguments),
        Command::Stress(arguments) => stress::run(&arguments),
        Command::Scene(arguments) => scene::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
    }
}

/// Prints to standard output. A reader that has gone away (`| head`) is no error.
pub(crate) fn say(text: &str) -> Result<()> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
