//! The `sightline` program: see `sightline --help`.

use clap::Parser;
use std::io::IsTerminal;
use std::process::ExitCode;

fn main() -> ExitCode {
    let level = if std::env::var_os("SIGHTLINE_LOG").is_some() { tracing::Level::DEBUG } else { tracing::Level::INFO };
    tracing_subscriber::fmt()
        .with_ansi(sightline::cli::coloured(std::io::stderr().is_terminal(), std::env::var_os("NO_COLOR").as_deref()))
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .without_time()
        .with_target(false)
        .init();
    // File names that are no text are left to clap, without a file of flags.
    let Some(typed) = std::env::args_os().map(|word| word.into_string().ok()).collect() else {
        return sightline::cli::commands::exit_code(sightline::cli::Cli::parse());
    };
    match sightline::cli::with_config(typed) {
        Ok(words) => sightline::cli::commands::exit_code(sightline::cli::Cli::parse_from(words)),
        Err(error) => {
            eprintln!("sightline: {error:#}");
            ExitCode::FAILURE
        }
    }
}
