//! What each command does, from arguments to output.

mod bench;
mod info;
mod report;
mod scene;
mod shot;
mod stress;
mod table;

pub use stress::all_drills;

use crate::cli::{Cli, Command};
use anyhow::Result;
use std::io::{ErrorKind, Write};

/// Runs the command that was typed.
pub fn run(cli: Cli) -> Result<()> {
    match cli.command {
        Command::Bench(arguments) => match &arguments.table {
            Some(table) => table::run(&arguments, table),
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
