//! `sightline completions` and `sightline man`: the command line, told to shells and to `man`.

use super::put;
use crate::cli::Cli;
use anyhow::{bail, Result};
use clap::CommandFactory;
use clap_complete::Shell;

const NAME: &str = "sightline";

/// Prints what makes a shell complete the program's flags.
pub fn completions(shell: Shell) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), NAME, &mut script);
    put(&script)
}

/// Prints the manual page of the program, or of one of its commands.
pub fn page(command: Option<&str>) -> Result<()> {
    put(&manual(command)?)
}

fn manual(command: Option<&str>) -> Result<Vec<u8>> {
    let mut program = Cli::command();
    // Fills in what commands take over from the program.
    program.build();
    let described = match command {
        None => program.clone(),
        Some(name) => match program.find_subcommand(name) {
            Some(found) => found.clone().version(env!("CARGO_PKG_VERSION")),
            None => {
                let names: Vec<_> = program.get_subcommands().map(clap::Command::get_name).collect();
                bail!("there is no command '{name}'; choose from: {}", names.join(", "));
            }
        },
    };
    let mut page = Vec::new();
    clap_mangen::Man::new(described).render(&mut page)?;
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_a_page_that_tells_its_flags() {
        let program = Cli::command();
        for command in program.get_subcommands() {
            let page = String::from_utf8(manual(Some(command.get_name())).unwrap()).unwrap();
            for flag in command.get_arguments().filter_map(|argument| argument.get_long()) {
                // A manual page writes a hyphen as `\\-`.
                let written = flag.replace('-', "\\-");
                assert!(page.contains(&written), "{}: --{flag} is not told", command.get_name());
            }
        }
        let whole = String::from_utf8(manual(None).unwrap()).unwrap();
        assert!(whole.contains("bench") && whole.starts_with(".ie"), "{}", &whole[..40]);
        assert!(manual(Some("dance")).unwrap_err().to_string().contains("choose from: bench"));
    }

    #[test]
    fn shells_learn_of_every_command() {
        let mut script = Vec::new();
        clap_complete::generate(Shell::Bash, &mut Cli::command(), NAME, &mut script);
        let script = String::from_utf8(script).unwrap();
        for command in Cli::command().get_subcommands() {
            assert!(script.contains(&format!("{NAME},{})", command.get_name())), "{}", command.get_name());
        }
        assert!(script.contains("--screenshot") && script.contains("boxes-first-person"), "flags and their values");
    }
}
