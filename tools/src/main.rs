//! The `sightline` program: see `sightline --help`.

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
    // An error of standard error itself cannot be reported anywhere.
    let lines =
        tracing_subscriber::fmt::layer().with_ansi(colours).with_writer(std::io::stderr).log_internal_errors(false);
    tracing_subscriber::registry().with(lines.without_time().with_target(false).with_filter(told())).init();
    sightline::cli::start(std::env::args_os().collect())
}
