//! Reading `results.json` with errors that name the field.

use super::{Fault, Results, ResultsError};
use std::path::Path;

impl Results {
    /// Reads and checks a file. The error names the file and the field.
    pub fn read_json(path: &Path) -> Result<Self, ResultsError> {
        let text =
            std::fs::read_to_string(path).map_err(|cause| ResultsError::Read { path: path.to_path_buf(), cause })?;
        parse(&text).map_err(|Fault { field, fault }| ResultsError::Broken { path: path.to_path_buf(), field, fault })
    }
}

/// Parses and checks. The schema comes first: a file of another version should not be told that a field is missing.
pub(super) fn parse(text: &str) -> Result<Results, Fault> {
    let located = |error: serde_json::Error| Fault {
        field: field_at(text, byte_at(text, error.line(), error.column())),
        fault: error.to_string(),
    };
    #[derive(serde::Deserialize)]
    struct Version {
        schema: u32,
    }
    let version: Version = serde_json::from_str(text).map_err(located)?;
    if version.schema != super::SCHEMA {
        return Err(Fault {
            field: "schema".into(),
            fault: format!("is {}, but this program reads {}", version.schema, super::SCHEMA),
        });
    }
    let results: Results = serde_json::from_str(text).map_err(located)?;
    results.check()?;
    Ok(results)
}

/// The byte that serde_json calls `line`, `column` (both from 1; column 0 is the end of the line before).
fn byte_at(text: &str, line: usize, column: usize) -> usize {
    let before = text.split_inclusive('\n').take(line.saturating_sub(1));
    before.map(str::len).sum::<usize>() + column
}

/// A container that encloses the place, and where in it we are.
enum Step {
    Object(Option<String>),
    Array(usize),
}

/// The path of the field in whose value the first `end` bytes of a JSON text end. serde_json gives only line and
/// column; this walks the text up to there. At the end of an object with a missing field it names that object.
fn field_at(text: &str, end: usize) -> String {
    let bytes = &text.as_bytes()[..end.min(text.len())];
    let mut steps: Vec<Step> = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        match bytes[at] {
            b'{' => steps.push(Step::Object(None)),
            b'[' => steps.push(Step::Array(0)),
            // The last byte is where the fault is: there the container is still the one to name.
            b'}' | b']' if at + 1 < bytes.len() => drop(steps.pop()),
            b',' => match steps.last_mut() {
                Some(Step::Array(index)) => *index += 1,
                Some(Step::Object(key)) => *key = None,
                None => {}
            },
            b'"' => {
                let (string, after) = string_from(bytes, at);
                if let Some(Step::Object(key @ None)) = steps.last_mut() {
                    *key = Some(string);
                }
                at = after;
                continue;
            }
            b'}' => {
                // A missing field: the object itself, not its last field.
                if let Some(Step::Object(key)) = steps.last_mut() {
                    *key = None;
                }
            }
            _ => {}
        }
        at += 1;
    }
    path_of(&steps)
}

/// The string that opens at `open`, escapes left as they are, and the index after its closing quote.
fn string_from(bytes: &[u8], open: usize) -> (String, usize) {
    let mut close = open + 1;
    while close < bytes.len() && bytes[close] != b'"' {
        close += if bytes[close] == b'\\' { 2 } else { 1 };
    }
    let inside = &bytes[open + 1..close.min(bytes.len())];
    (String::from_utf8_lossy(inside).into_owned(), close + 1)
}

fn path_of(steps: &[Step]) -> String {
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Object(Some(key)) if path.is_empty() => path.push_str(key),
            Step::Object(Some(key)) => {
                path.push('.');
                path.push_str(key);
            }
            Step::Object(None) => {}
            Step::Array(index) => path.push_str(&format!("[{index}]")),
        }
    }
    if path.is_empty() {
        path.push_str("the file");
    }
    path
}
