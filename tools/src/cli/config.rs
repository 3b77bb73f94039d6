//! Flags from a file: `--config sightline.toml`, for runs that are repeated.

use super::Cli;
use crate::results::files::read_text;
use anyhow::{bail, Context, Result};
use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

const FLAG: &str = "config";

/// Most bytes of a file of flags.
const MOST_BYTES: u64 = 1 << 20;

/// Adds the flags of `--config FILE` to a command line. The file has `[COMMAND]` with `flag = value`; flags that were typed are
/// skipped. A command of a command, such as `scene export`, has `[scene.export]`. A list is the flag given several times, `true` a flag
/// without a value.
///
/// # Errors
/// A file that cannot be read, or a flag that the command does not have.
pub fn with_config(typed: Vec<OsString>) -> Result<Vec<OsString>> {
    // clap parses the command line, so that a value is never taken for a command. Its errors are reported when the line is parsed
    // again.
    let Ok(matches) = Cli::command().ignore_errors(true).try_get_matches_from(&typed) else { return Ok(typed) };
    let Some(file) = file_in(&matches) else { return Ok(typed) };
    let mut program = Cli::command();
    program.build();
    let Chosen { names, command, matches } = Chosen::of(&program, &matches);
    if names.is_empty() {
        return Ok(typed);
    }
    let shown = file.display().to_string();
    let tables = tables(&file)?;
    check_names(&tables, &program, &shown)?;
    let Some(flags) = table_of(&tables, &names, &shown)? else { return Ok(typed) };
    let place = names.join(".");
    let mut added = Vec::new();
    for (flag, value) in flags {
        if command.find_subcommand(flag).is_some() {
            continue;
        }
        let id = id_of(command, flag, &format!("{shown}: [{place}]"))?;
        if matches.value_source(id) != Some(ValueSource::CommandLine) {
            added.extend(words(flag, value).with_context(|| format!("{shown}: [{place}] {flag}"))?);
        }
    }
    // No word behind `--` is a flag.
    let end = typed.iter().position(|word| word == "--").unwrap_or(typed.len());
    let mut all = typed;
    all.splice(end..end, added.into_iter().map(OsString::from));
    Ok(all)
}

/// The command that is run.
struct Chosen<'a> {
    /// Its name, after the name of the command that it belongs to.
    names: Vec<&'a str>,
    command: &'a clap::Command,
    matches: &'a ArgMatches,
}

impl<'a> Chosen<'a> {
    fn of(program: &'a clap::Command, matches: &'a ArgMatches) -> Self {
        let mut chosen = Chosen { names: Vec::new(), command: program, matches };
        while let Some((name, matches)) = chosen.matches.subcommand() {
            let Some(command) = chosen.command.find_subcommand(name) else { break };
            chosen.names.push(name);
            (chosen.command, chosen.matches) = (command, matches);
        }
        chosen
    }
}

/// Returns the file of `--config`, given before or after the command.
fn file_in(matches: &ArgMatches) -> Option<PathBuf> {
    let below = || matches.subcommand().and_then(|(_, below)| file_in(below));
    matches.try_get_one::<PathBuf>(FLAG).ok().flatten().cloned().or_else(below)
}

fn tables(file: &Path) -> Result<Table> {
    let text = read_text(file, MOST_BYTES).with_context(|| format!("{}: cannot read this file", file.display()))?;
    text.parse().map_err(|error: toml::de::Error| {
        let line = error.span().map_or(1, |span| text[..span.start].lines().count().max(1));
        anyhow::anyhow!("{}: line {line}: {}", file.display(), error.message())
    })
}

/// A misspelt command would else be passed over without a word.
fn check_names(tables: &Table, program: &clap::Command, file: &str) -> Result<()> {
    match tables.keys().find(|name| program.find_subcommand(name).is_none()) {
        None => Ok(()),
        Some(name) => {
            let names: Vec<_> = program.get_subcommands().map(clap::Command::get_name).collect();
            bail!("{file}: there is no command '{name}'; tables are {}", names.join(", "))
        }
    }
}

/// The table of a command; none if the file has none.
fn table_of<'a>(tables: &'a Table, names: &[&str], file: &str) -> Result<Option<&'a Table>> {
    let mut found = tables;
    for (depth, name) in names.iter().enumerate() {
        found = match found.get(*name) {
            None => return Ok(None),
            Some(Value::Table(below)) => below,
            Some(_) => {
                let place = names[..=depth].join(".");
                bail!("{file}: {place} is no table; write [{place}], and its flags below")
            }
        };
    }
    Ok(Some(found))
}

/// Returns clap's identifier of a command's flag.
fn id_of<'a>(command: &'a clap::Command, flag: &str, place: &str) -> Result<&'a str> {
    let others = |argument: &&clap::Arg| !matches!(argument.get_long(), None | Some(FLAG | "help" | "version"));
    let flags = || command.get_arguments().filter(others);
    if let Some(known) = flags().find(|argument| argument.get_long() == Some(flag)) {
        return Ok(known.get_id().as_str());
    }
    let all = flags().filter_map(clap::Arg::get_long).collect::<Vec<_>>().join(", ");
    let below = command.get_subcommands().map(clap::Command::get_name).filter(|name| *name != "help");
    match (all.is_empty(), below.collect::<Vec<_>>().join(", ")) {
        (true, below) if below.is_empty() => bail!("{place} has no flag '{flag}'; it has none"),
        (true, below) => bail!("{place} has no flag '{flag}'; its commands have: {below}"),
        (false, _) => bail!("{place} has no flag '{flag}'; it has {all}"),
    }
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
fn written(text: &str) -> PathBuf {
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
        let words = with_config(typed.split(' ').map(OsString::from).collect());
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
            (vec![PathBuf::from("rooms")], vec!["hzb.texels=8".to_owned(), "woc.size=2".to_owned()])
        );
        let typed = bench("bench --frames 3 --scene=boxes");
        assert_eq!(
            (typed.scene.frames, typed.scene.scene[0].as_path(), typed.scene.scale),
            (3, Path::new("boxes"), 0.5)
        );
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
        let missing = with_config(["sightline", "bench", "--config=nowhere.toml"].map(OsString::from).to_vec());
        assert!(missing.unwrap_err().to_string().contains("nowhere.toml: cannot read"));
    }

    /// `--config shot bench` took `shot`, the file, for the command.
    #[test]
    fn words_that_are_values_are_neither_commands_nor_flags() {
        let file = written(FILE);
        let folder = file.with_file_name(format!("sightline-words-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let shot = folder.join("shot");
        std::fs::copy(&file, &shot).unwrap();
        let words = |line: &[&str]| with_config(line.iter().map(OsString::from).collect()).unwrap();
        let shot_name = shot.to_str().unwrap();
        let bench = words(&["sightline", "--config", shot_name, "bench"]);
        assert!(bench.contains(&"--frames=60".into()) && !bench.contains(&"--method=eovc".into()), "{bench:?}");
        // A value that looks like a flag of the file, or like --config.
        let keys = words(&["sightline", "view", "--keys", "--config", "bench"]);
        assert_eq!(keys.len(), 5, "{keys:?}");
        let seen = words(&["sightline", "bench", "--out", "shot", "--config", shot_name]);
        assert!(seen.contains(&"--frames=60".into()), "{seen:?}");
        // Flags come before `--`, behind which none would be one.
        let report = written("[report]\nout = 'x.html'");
        let ended = words(&["sightline", "report", "--config", report.to_str().unwrap(), "--", "-odd.json"]);
        assert_eq!(ended[4..], ["--out=x.html", "--", "-odd.json"].map(OsString::from), "{ended:?}");
        for file in [file, report] {
            std::fs::remove_file(file).unwrap();
        }
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_command_of_a_command_has_a_table_below() {
        let export = |text: &str| -> Result<String> {
            match read(text, "scene export --scene rooms")?.command {
                Command::Scene(arguments) => Ok(format!("{:?}", arguments.action)),
                other => panic!("{other:?}"),
            }
        };
        let read = export("[scene.export]\nout = 'rooms.glb'\nscale = 0.5\nscene = 'boxes'").unwrap();
        assert!(read.contains("rooms.glb") && read.contains("scale: 0.5") && !read.contains("boxes"), "{read}");
        let fault = |text: &str| format!("{:#}", export(text).unwrap_err());
        assert!(
            fault("[scene.export]\nsize = 'x'\nouts = 1").contains("[scene.export] has no flag 'outs'; it has scene")
        );
        assert!(fault("[scene]\nexport = 3").contains("write [scene.export]"));
    }
}
