//! From the words of a command line to an exit code.

use super::commands::{exit_code, tell};
use super::{with_config, Cli};
use crate::results::output::{is_obeyed, shown, warn, written};
use clap::error::ErrorKind;
use clap::Parser;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

/// The exit code of a command line that cannot be read.
const CANNOT_BE_READ: u8 = 2;

/// Runs a command line and returns its exit code: see `sightline --help`.
pub fn start(typed: Vec<OsString>) -> ExitCode {
    let words = match with_config(typed) {
        Ok(words) => words,
        Err(error) => {
            tell(&error);
            return ExitCode::FAILURE;
        }
    };
    match Cli::try_parse_from(&words) {
        Ok(cli) => exit_code(cli),
        Err(error) => refused(&error, &words),
    }
}

/// Prints clap's help, version or error.
fn refused(error: &clap::Error, words: &[OsString]) -> ExitCode {
    if !error.use_stderr() {
        let printed = error.print().and_then(|()| std::io::stdout().flush());
        return match written(printed) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                tell(&error);
                ExitCode::FAILURE
            }
        };
    }
    let text = error.render().to_string();
    let not_text = words.iter().find(|word| word.to_str().is_none());
    match not_text {
        Some(word) if error.kind() == ErrorKind::InvalidUtf8 => {
            warn(&format!(
                "sightline: {}: this argument is not UTF-8 text; only names of files need not be",
                word.to_string_lossy()
            ));
        }
        // Control characters from a --config file are escaped.
        _ if text.contains(|letter| is_obeyed(letter) && letter != '\n') => warn(shown(&text).trim_end()),
        _ => drop(error.print()),
    }
    ExitCode::from(CANNOT_BE_READ)
}
