//! `sightline compare`.

use super::{say, say_json};
use crate::cli::CompareArgs;
use crate::compare::{compare, gates_text, run_lines, text, Comparison, Outcome};
use crate::results::Results;
use anyhow::{bail, Result};
use serde::Serialize;
use std::path::Path;

/// Gates failed. Their figures were printed with the comparison.
#[derive(Debug, thiserror::Error)]
#[error("{failed} of {of} gates failed")]
pub struct GatesTrue {
    failed: usize,
    of: usize,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report {
    a: Option<String>,
    b: String,
    comparison: Option<Comparison>,
    gates: Vec<Outcome>,
}

/// Compares, looks at the gates, and prints both.
///
/// # Errors
/// [`GatesTrue`], to be told from all others; those have exit code 2, as faulty arguments have.
pub fn run(arguments: &CompareArgs) -> Result<()> {
    let (path_a, path_b) = match arguments.files.as_slice() {
        [a, b] => (Some(a.as_path()), b.as_path()),
        [b] if arguments.fail_if.is_empty() => {
            bail!("{}: one file has nothing to be compared with; name a second, or a gate (--fail-if)", b.display())
        }
        [b] => (None, b.as_path()),
        _ => bail!("name one file or two"),
    };
    let a = path_a.map(Results::read_plain).transpose()?;
    let b = Results::read_plain(path_b)?;
    let comparison = a.as_ref().map(|a| compare(a, &b, arguments.options())).transpose()?;
    let check = arguments.fail_if.iter().map(|gate| gate.check(a.as_ref(), &b, comparison.as_ref()));
    let gates = check.collect::<Result<Vec<_>>>()?;
    let (failed, of) = (gates.iter().filter(|gate| gate.failed).count(), gates.len());
    if arguments.json {
        let name = |path: &Path| path.display().to_string();
        say_json(&Report { a: path_a.map(name), b: name(path_b), comparison, gates })?;
    } else {
        for (name, path, results) in [("A", path_a, a.as_ref()), ("B", Some(path_b), Some(&b))] {
            if let (Some(path), Some(results)) = (path, results) {
                say(&run_lines(name, path, results))?;
            }
        }
        let compared = comparison.map_or(String::new(), |comparison| format!("{}\n", text(&comparison, &b)));
        say(format!("{compared}{}", gates_text(&gates)).trim_end())?;
    }
    if failed > 0 {
        return Err(GatesTrue { failed, of }.into());
    }
    Ok(())
}
