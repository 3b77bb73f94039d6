//! Reading `results.json` with errors that name the field.

use super::output::{is_obeyed, one_line};
use super::{Fault, Results, ResultsError};
use crate::results::files::read_text;
use serde_json::Value;
use std::path::Path;

/// Most bytes of a file that is read: an endless one (`/dev/zero`) must not fill the memory.
const MOST_BYTES: u64 = 4 << 30;

impl Results {
    /// Reads and checks a file. The error names the file and the field.
    pub fn read_json(path: &Path) -> Result<Self, ResultsError> {
        read(path, |_, results| Ok(results))
    }

    /// Reads and checks a file for a terminal: control characters in names and texts are escaped, as the file may come from anywhere.
    pub fn read_plain(path: &Path) -> Result<Self, ResultsError> {
        read(path, |text, results| if may_obey(text) { plain(&results) } else { Ok(results) })
    }
}

fn read(path: &Path, then: impl Fn(&str, Results) -> Result<Results, Fault>) -> Result<Results, ResultsError> {
    let text = read_text(path, MOST_BYTES).map_err(|cause| ResultsError::Read { path: path.to_path_buf(), cause })?;
    let read = parse(&text).and_then(|results| then(&text, results));
    read.map_err(|Fault { field, fault }| ResultsError::Broken { path: path.to_path_buf(), field, fault })
}

/// True if a string of this JSON text may hold a control character.
fn may_obey(text: &str) -> bool {
    text.contains(|letter| letter == '\\' || is_obeyed(letter) && !matches!(letter, '\n' | '\r' | '\t'))
}

/// Escapes the control characters of results.
fn plain(results: &Results) -> Result<Results, Fault> {
    let failed = |error: serde_json::Error| Fault { field: "the file".into(), fault: plain_words(&error) };
    let value = plain_value(serde_json::to_value(results).map_err(failed)?);
    let results: Results = serde_json::from_value(value).map_err(failed)?;
    // Two labels may be equal after escaping.
    results.check()?;
    Ok(results)
}

fn plain_value(value: Value) -> Value {
    match value {
        Value::String(text) => Value::String(one_line(&text).into_owned()),
        Value::Array(values) => values.into_iter().map(plain_value).collect(),
        Value::Object(fields) => {
            fields.into_iter().map(|(name, value)| (one_line(&name).into_owned(), plain_value(value))).collect()
        }
        other => other,
    }
}

/// Parses and checks. The schema comes first: a file of another version should not be told that a field is missing.
pub(super) fn parse(text: &str) -> Result<Results, Fault> {
    let located = |error: serde_json::Error| Fault {
        field: field_at(text, byte_at(text, error.line(), error.column())),
        fault: plain_words(&error),
    };
    check_is_object(text)?;
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

/// Refuses JSON that is not an object. serde would read a list as a struct, and name Rust types for other values.
fn check_is_object(text: &str) -> Result<(), Fault> {
    let start = text.trim_start();
    // Before anything is parsed: results can be large.
    if start.starts_with('{') {
        return Ok(());
    }
    let holds = match serde_json::from_str(text) {
        _ if start.is_empty() => "nothing",
        Ok(Value::Null) => "null",
        Ok(Value::Bool(_)) => "a truth value",
        Ok(Value::Number(_)) => "a number",
        Ok(Value::String(_)) => "a text",
        Ok(Value::Array(_)) => "a list",
        // The parser reports errors of JSON.
        Ok(Value::Object(_)) | Err(_) => return Ok(()),
    };
    let fault = format!("holds {holds}, but results are an object, as `sightline bench` writes them");
    Err(Fault { field: "the file".into(), fault })
}

/// Rewrites serde_json's message with JSON's types in place of Rust's.
fn plain_words(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let text = match error.classify() {
        serde_json::error::Category::Syntax => format!("is not JSON: {message}"),
        serde_json::error::Category::Eof => format!("the JSON ends too early; was the file cut off? ({message})"),
        _ => message,
    };
    let Some((before, expected)) = text.rsplit_once("expected ") else { return text };
    let end = expected.find(" at line ").unwrap_or(expected.len());
    let (wanted, place) = expected.split_at(end);
    let plain = match wanted {
        "f32" | "f64" => "a number",
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number of 0 or more",
        "i32" | "i64" | "isize" => "a whole number",
        "a sequence" => "a list",
        "a map" => "an object",
        "a string" => "a text",
        "a boolean" => "true or false",
        wanted if wanted.starts_with("struct ") => "an object",
        wanted => wanted,
    };
    format!("{before}expected {plain}{place}")
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
