//! The numbers of a method's row in `results.json`, by the names that they have there: what gates can ask for.
//!
//! They are read from the row as it is written, so that a new measure needs no line here.

use crate::results::Method;
use anyhow::Result;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// By name, such as `drawn_mean`, `frame_ms.median` or `stages.NAME.median_ms`. `None`: the run did not measure it. A PSNR
/// between identical pictures is infinite.
pub type Fields = BTreeMap<String, Option<f64>>;

/// What settings and single frames have is no measure of the method.
const NO_MEASURES: [&str; 2] = ["options", "frames"];

/// The numbers of a method.
///
/// # Errors
/// None that a checked file can cause.
pub fn fields(method: &Method) -> Result<Fields> {
    let mut found = Fields::new();
    if let Value::Object(row) = serde_json::to_value(method)? {
        let frames = row.get("frames").cloned().unwrap_or_default();
        for (name, value) in row.iter().filter(|(name, _)| !NO_MEASURES.contains(&name.as_str())) {
            let measured = is_measured(name, &frames);
            match value {
                Value::Object(inner) => add(&mut found, &format!("{name}."), inner, measured),
                Value::Array(inner) => add_named(&mut found, name, inner),
                _ => add_one(&mut found, name.clone(), value, measured),
            }
        }
    }
    Ok(found)
}

/// A measure that was not taken has no frames either: its number, 0 or `null`, says nothing. `bench --no-metrics` writes
/// such rows.
fn is_measured(name: &str, frames: &Value) -> bool {
    let array = match name {
        "false_negative_frames" | "object_error_percent" => "false_negatives",
        "culled_over_total" | "culled_over_ref" => "drawn",
        "psnr_mean_db" | "psnr_worst_db" => "psnr_db",
        "state_changes_mean" | "waits_mean" | "plane_tests_mean" | "bounds_brought_mean" | "refits_mean" => "queries",
        other => other.strip_suffix("_mean").unwrap_or(other),
    };
    frames.get(array).and_then(Value::as_array).is_none_or(|entries| !entries.is_empty())
}

fn add(found: &mut Fields, prefix: &str, values: &Map<String, Value>, measured: bool) {
    for (name, value) in values {
        add_one(found, format!("{prefix}{name}"), value, measured);
    }
}

/// Of a list, such as `stages`, entries are called by their names.
fn add_named(found: &mut Fields, list: &str, entries: &[Value]) {
    for entry in entries {
        if let (Some(name), Some(entry)) = (entry.get("name").and_then(Value::as_str), entry.as_object()) {
            add(found, &format!("{list}.{name}."), entry, true);
        }
    }
}

fn add_one(found: &mut Fields, name: String, value: &Value, measured: bool) {
    let number = match value {
        Value::Number(number) => number.as_f64(),
        Value::Null if name.starts_with("psnr_") => Some(f64::INFINITY),
        // The reason of a stage that was not skipped, and the like, are `null` too, but of text.
        Value::Null if !name.contains('.') => None,
        _ => return,
    };
    found.insert(name, number.filter(|_| measured));
}

/// B less A. Identical pictures on both sides are no difference, which infinity less infinity would not say.
pub fn delta(a: f64, b: f64) -> f64 {
    if a == b {
        0.0
    } else {
        b - a
    }
}

/// The names, for messages: stages are many, and are said once.
pub fn names(fields: &Fields) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in fields.keys() {
        let shown = match name.strip_prefix("stages.").and_then(|rest| rest.rsplit_once('.')) {
            Some((_, field)) => format!("stages.NAME.{field}"),
            None => name.clone(),
        };
        if !names.contains(&shown) {
            names.push(shown);
        }
    }
    names
}
