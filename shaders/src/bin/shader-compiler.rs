//! `cargo shaders`: compiles every shader and writes `shaders/generated/`; with `--check`, only compares.

use shaders::{generator, sources};
use std::process::ExitCode;

const HELP: &str = "\
Compiles shaders/glsl and writes shaders/generated: SPIR-V and one Rust struct per stage.

Usage: cargo shaders [-- --check]

  --check  write nothing; list what differs from shaders/generated, and exit 1 if anything does
  --help   this text

shaders/README.md says how to add a stage.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // `cargo shaders -- --check` and `cargo shaders --check` both arrive here.
    let mut flags = arguments.iter().map(String::as_str).filter(|flag| *flag != "--");
    let result = match (flags.next(), flags.next()) {
        (None, _) => run(false),
        (Some("--check"), None) => run(true),
        (Some("--help" | "-h"), None) => {
            println!("{HELP}");
            Ok(())
        }
        _ => Err(vec![format!("unknown arguments {arguments:?}\n\n{HELP}")]),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(errors) => {
            for error in &errors {
                eprintln!("{error}");
            }
            ExitCode::FAILURE
        }
    }
}

fn run(check: bool) -> Result<(), Vec<String>> {
    let root = sources::crate_root();
    let output = generator::generate(root).map_err(|mut errors| {
        errors.push("shaders/generated is unchanged".to_owned());
        errors
    })?;
    for note in &output.notes {
        eprintln!("note: {note}");
    }
    let count = output.stages.len();
    if !check {
        let changed = generator::write(root, &output).map_err(|error| vec![error])?;
        println!("{count} stages; {changed} files of shaders/generated changed");
        return Ok(());
    }
    let mut differences = generator::differences(root, &output).map_err(|error| vec![error])?;
    if differences.is_empty() {
        println!("{count} stages; shaders/generated is up to date");
        return Ok(());
    }
    differences.push("shaders/generated is out of date: run `cargo shaders` and commit it".to_owned());
    Err(differences)
}
