//! Flags from a file: `--config sightline.toml`, for runs that are repeated.

use super::Cli;
use anyhow::{bail, Context, Result};
use clap::CommandFactory;
use toml::{Table, Value};

const FLAG: &str = "--config";

/// The command line with what a `--config FILE` in it says: `[COMMAND]` with `flag = value`, for each flag that was not typed. A list is the
/// flag given several times, `true` a flag without a value.
///
/// # Errors
/// A file that cannot be read, or a flag that the command does not have.
pub fn with_config(typed: Vec<String>) -> Result<Vec<String>> {
    let Some(file) = file_in(&typed) else { return Ok(typed) };
    let text = std::fs::read_to_string(&file).with_context(|| format!("{file}: cannot read this file"))?;
    let mut program = Cli::command();
    program.build();
    let Some(command) = typed.iter().skip(1).find_map(|word| program.find_subcommand(word)) else {
        // Help, or an error of the command line, which is told as ever.
        return Ok(typed);
    };
    let tables: Table = text.parse().map_err(|error: toml::de::Error| {
        let line = error.span().map_or(1, |span| text[..span.start].lines().count().max(1));
        anyhow::anyhow!("{file}: line {line}: {}", error.message())
    })?;
    check_tables(&tables, &program, &file)?;
    let mut all = typed.clone();
    match tables.get(command.get_name()) {
        None => {}
        Some(Value::Table(flags)) => {
            for (flag, value) in flags {
                check_flag(command, flag, &file)?;
                if !is_typed(&typed, flag) {
                    all.extend(words(flag, value).with_context(|| format!("{file}: [{}] {flag}", command.get_name()))?);
                }
            }
        }
        Some(_) => bail!("{file}: {0} is no table; write [{0}], and its flags below", command.get_name()),
    }
    Ok(all)
}

/// The file that a command line names, if it does.
fn file_in(typed: &[String]) -> Option<String> {
    let place = typed.iter().position(|word| word == FLAG || word.starts_with("--config="))?;
    match typed[place].split_once('=') {
        Some((_, file)) => Some(file.to_owned()),
        None => typed.get(place + 1).cloned(),
    }
}

/// A misspelt command would else be passed over without a word.
fn check_tables(tables: &Table, program: &clap::Command, file: &str) -> Result<()> {
    match tables.keys().find(|name| program.find_subcommand(name).is_none()) {
        None => Ok(()),
        Some(name) => {
            let names: Vec<_> = program.get_subcommands().map(clap::Command::get_name).collect();
            bail!("{file}: there is no command '{name}'; tables are {}", names.join(", "))
        }
    }
}

fn check_flag(command: &clap::Command, flag: &str, file: &str) -> Result<()> {
    let flags =
        || command.get_arguments().filter_map(clap::Arg::get_long).filter(|long| !["config", "help"].contains(long));
    if flags().any(|known| known == flag) {
        return Ok(());
    }
    let all = flags().collect::<Vec<_>>().join(", ");
    bail!("{file}: [{}] has no flag '{flag}'; it has {all}", command.get_name())
}

fn is_typed(typed: &[String], flag: &str) -> bool {
    let long = format!("--{flag}");
    typed.iter().any(|word| *word == long || word.starts_with(&format!("{long}=")))
}

/// A flag and its value as they would be typed. The two are one word, so that a value may begin with a hyphen.
fn words(flag: &str, value: &Value) -> Result<Vec<String>> {
    Ok(match value {
        Value::Boolean(true) => vec![format!("--{flag}")],
        Value::Boolean(false) => Vec::new(),
        Value::String(text) => vec![format!("--{flag}={text}")],
        Value::Integer(number) => vec![format!("--{flag}={number}")],
        Value::Float(number) => vec![format!("--{flag}={number}")],
        Value::Array(values) => values.iter().map(|value| words(flag, value)).collect::<Result<Vec<_>>>()?.concat(),
        Value::Table(_) | Value::Datetime(_) => bail!("a flag is a text, a number, true, or a list of these"),
    })
}

/// A file of such text, of its own for each test.
#[cfg(test)]
fn written(text: &str) -> std::path::PathBuf {
    use std::sync::atomic::{AtomicU32, Ordering};
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let name = format!("sightline-config-{}-{}.toml", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
    let file = std::env::temp_dir().join(name);
    std::fs::write(&file, text).unwrap();
    file
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::Command;
    use clap::Parser;

    fn read(text: &str, line: &str) -> Result<Cli> {
        let file = written(text);
        let typed = format!("sightline {line} --config {}", file.display());
        let words = with_config(typed.split(' ').map(str::to_owned).collect());
        std::fs::remove_file(file).unwrap();
        Ok(Cli::try_parse_from(words?)?)
    }

    const FILE: &str =
        "[bench]\nframes = 60\nscene = 'rooms'\nscale = 0.5\nset = ['hzb.texels=8', 'woc.size=2']\nexplain = true\n\
        no-report = false\n[shot]\nmethod = 'eovc'\n";

    #[test]
    fn flags_come_from_the_table_of_the_command_unless_typed() {
        let bench = |line: &str| match read(FILE, line).unwrap().command {
            Command::Bench(arguments) => arguments,
            other => panic!("{other:?}"),
        };
        let plain = bench("bench");
        assert_eq!((plain.scene.frames, plain.scene.scale, plain.explain, plain.no_report), (60, 0.5, true, false));
        assert_eq!(
            (plain.scene.scene, plain.methods.set),
            (vec!["rooms".to_owned()], vec!["hzb.texels=8".to_owned(), "woc.size=2".to_owned()])
        );
        let typed = bench("bench --frames 3 --scene=boxes");
        assert_eq!((typed.scene.frames, typed.scene.scene[0].as_str(), typed.scene.scale), (3, "boxes", 0.5));
    }

    #[test]
    fn other_commands_take_their_own_table_or_none() {
        let method = |line: &str| match read(FILE, line).unwrap().command {
            Command::Shot(arguments) => arguments.method,
            other => panic!("{other:?}"),
        };
        assert_eq!(method("shot"), "eovc");
        assert!(
            matches!(read(FILE, "view").unwrap().command, Command::View(arguments) if arguments.scene.scale == 0.25)
        );
    }

    #[test]
    fn faults_are_told_with_file_table_and_flag() {
        let fault = |text: &str| format!("{:#}", read(text, "bench").unwrap_err());
        assert!(fault("[bench]\nframe = 3").contains("[bench] has no flag 'frame'; it has scene, scale"));
        assert!(fault("[bank]\nframes = 3").contains("there is no command 'bank'; tables are bench"));
        assert!(fault("bench = 3").contains("write [bench]"));
        assert!(fault("[bench]\nframes = {a = 1}").contains("[bench] frames: a flag is a text"));
        assert!(fault("[bench]\nframes = ").contains("line 2"));
        let missing = with_config(["sightline", "bench", "--config=nowhere.toml"].map(str::to_owned).to_vec());
        assert!(missing.unwrap_err().to_string().contains("nowhere.toml: cannot read"));
    }
}
