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
use crate::results::output::one_line;
pub(crate) use crate::results::output::{put, say, say_json, warn};
use anyhow::Result;
use std::ffi::OsStr;
use std::process::ExitCode;

/// Runs the command that was typed, and says by its exit code what became of it: 0 good, 1 an error, or a gate of `compare` that was
/// true; an error of `compare` is 2, so that CI can tell it from a gate.
pub fn exit_code(cli: Cli) -> ExitCode {
    let compares = matches!(cli.command, Command::Compare(_));
    match run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            tell(&error);
            let is_gate = error.is::<compare::GatesTrue>();
            ExitCode::from(if compares && !is_gate { 2 } else { 1 })
        }
    }
}

/// Prints an error: the chain of causes, outermost first, in one line.
pub(super) fn tell(error: &anyhow::Error) {
    warn(&format!("sightline: {}", one_line(&format!("{error:#}"))));
}

/// Returns the command line, quoted so that a shell runs the same again.
fn typed() -> String {
    std::env::args_os().map(|word| quoted(&word)).collect::<Vec<_>>().join(" ")
}

/// Quotes a word for a shell. Bytes that are not UTF-8 are lost.
fn quoted(word: &OsStr) -> String {
    let word = word.to_string_lossy();
    let is_special =
        |letter: char| letter.is_whitespace() || letter.is_control() || "'\"\\$`&|;<>()[]{}*?!#~".contains(letter);
    match word.is_empty() || word.contains(is_special) {
        true => format!("'{}'", word.replace('\'', "'\\''")),
        false => word.into_owned(),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_line_is_written_as_a_shell_reads_it() {
        for (word, written) in [
            ("bench", "bench"),
            ("none,hzb[texels=8]", "'none,hzb[texels=8]'"),
            ("", "''"),
            ("my scene.glb", "'my scene.glb'"),
            ("it's", "'it'\\''s'"),
            ("any.ratio>1", "'any.ratio>1'"),
        ] {
            assert_eq!(quoted(OsStr::new(word)), written);
        }
    }
}
