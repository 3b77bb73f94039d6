//! The `sightline` program: see `sightline --help`.

use clap::Parser;
use std::io::IsTerminal;
use std::process::ExitCode;
use tracing::Level;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::prelude::*;

/// What Sightline says of its work; of the libraries below it only errors, unless all is asked for.
fn told() -> Targets {
    if std::env::var_os("SIGHTLINE_LOG").is_some() {
        return Targets::new().with_default(Level::DEBUG);
    }
    let own = ["sightline", "culling", "engine", "scenes", "shaders"].map(|room| (room, Level::INFO));
    Targets::new().with_default(Level::ERROR).with_targets(own)
}

fn main() -> ExitCode {
    let colours = sightline::cli::coloured(std::io::stderr().is_terminal(), std::env::var_os("NO_COLOR").as_deref());
    let lines = tracing_subscriber::fmt::layer().with_ansi(colours).with_writer(std::io::stderr);
    tracing_subscriber::registry().with(lines.without_time().with_target(false).with_filter(told())).init();
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
