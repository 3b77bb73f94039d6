//! What was skipped, and why.

use crate::results::Results;
use serde::Serialize;

/// A stage that did not run for one reason, in how many frames of which methods.
#[derive(Serialize)]
pub struct Skipped {
    stage: String,
    reason: String,
    methods: Vec<String>,
}

/// One row a stage and reason, in the order of first appearance.
pub fn skipped(results: &Results) -> Vec<Skipped> {
    let mut rows: Vec<Skipped> = Vec::new();
    for method in &results.methods {
        for stage in method.stages.iter().filter(|stage| stage.skipped > 0) {
            let reason = stage.reason.as_deref().unwrap_or("no reason was given");
            let of = format!("{} ({} of {} frames)", method.label, stage.skipped, results.frames);
            match rows.iter_mut().find(|row| row.stage == stage.name && row.reason == reason) {
                Some(row) => row.methods.push(of),
                None => {
                    rows.push(Skipped { stage: stage.name.clone(), reason: reason.to_owned(), methods: vec![of] });
                }
            }
        }
    }
    rows
}
