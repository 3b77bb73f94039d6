//! Writing `results.json` and `results.csv`, each whole or not at all.

use super::{read, Fault, Method, Results, ResultsError};
use crate::results::files::write_atomically;
use std::path::Path;

impl Results {
    /// Writes the contract. What does not keep it (a label twice, a NaN) is an error and nothing is written.
    pub fn write_json(&self, path: &Path) -> Result<(), ResultsError> {
        let broken = |Fault { field, fault }| ResultsError::Broken { path: path.to_path_buf(), field, fault };
        self.check().map_err(broken)?;
        let mut text = serde_json::to_string_pretty(self)
            .map_err(|error| broken(Fault { field: "the results".into(), fault: error.to_string() }))?;
        text.push('\n');
        // What is written can be read back: the contract is checked on the text, not on our intentions.
        read::parse(&text).map_err(broken)?;
        Ok(write_atomically(path, |to| to.write_all(text.as_bytes()))?)
    }

    /// Writes one row per method: the run, the method's scalar fields, then one column `stage:NAME` in milliseconds for
    /// each stage of any method (empty where a method has no such stage). The frames' arrays are only in the JSON.
    pub fn write_csv(&self, path: &Path) -> Result<(), ResultsError> {
        self.check().map_err(|Fault { field, fault }| ResultsError::Broken {
            path: path.to_path_buf(),
            field,
            fault,
        })?;
        let stages = self.stage_names();
        Ok(write_atomically(path, |to| {
            let mut csv = csv::Writer::from_writer(to);
            // Files of runs without flares stay as they are.
            let with_flares = self.methods.iter().any(|method| method.flare.is_some());
            let scalars = || SCALARS.iter().chain(FLARES.iter().filter(|_| with_flares));
            let columns = scalars().map(|(name, _)| (*name).to_string());
            let stage_columns = stages.iter().map(|name| format!("stage:{name}"));
            csv.write_record(columns.chain(stage_columns))?;
            for method in &self.methods {
                let scalars = scalars().map(|(_, of)| of(self, method));
                let times = stages.iter().map(|name| stage_ms(method, name));
                csv.write_record(scalars.chain(times))?;
            }
            csv.flush()
        })?)
    }

    /// The stages of all methods, each once, in the order of first appearance.
    fn stage_names(&self) -> Vec<&str> {
        let mut names = Vec::new();
        for stage in self.methods.iter().flat_map(|method| &method.stages) {
            if !names.contains(&stage.name.as_str()) {
                names.push(&stage.name);
            }
        }
        names
    }
}

fn stage_ms(method: &Method, name: &str) -> String {
    let stage = method.stages.iter().find(|stage| stage.name == name);
    stage.map_or(String::new(), |stage| stage.median_ms.to_string())
}

type Cell = fn(&Results, &Method) -> String;

/// Empty for `null`.
fn optional(value: Option<f64>) -> String {
    value.map_or(String::new(), |v| v.to_string())
}

/// Empty where nothing was measured but times.
fn measured(method: &Method, value: impl ToString) -> String {
    if method.is_measured() {
        value.to_string()
    } else {
        String::new()
    }
}

/// `name=value` pairs; strings without quotes.
fn options(method: &Method) -> String {
    let pairs = method.options.iter().map(|(name, value)| match value {
        serde_json::Value::String(text) => format!("{name}={text}"),
        other => format!("{name}={other}"),
    });
    pairs.collect::<Vec<_>>().join(";")
}

/// The columns before the stages.
const SCALARS: &[(&str, Cell)] = &[
    ("device", |r, _| r.device.name.clone()),
    ("scene", |r, _| r.scene.name.clone()),
    ("objects", |r, _| r.scene.objects.to_string()),
    ("path", |r, _| r.path.clone()),
    ("speed", |r, _| r.speed.to_string()),
    ("seed", |r, _| r.seed.to_string()),
    ("width", |r, _| r.size[0].to_string()),
    ("height", |r, _| r.size[1].to_string()),
    ("frames", |r, _| r.frames.to_string()),
    ("label", |_, m| m.label.clone()),
    ("method", |_, m| m.method.clone()),
    ("options", |_, m| options(m)),
    ("guarantee", |_, m| m.guarantee.clone()),
    ("frame_ms_median", |_, m| m.frame_ms.median.to_string()),
    ("frame_ms_p95", |_, m| m.frame_ms.p95.to_string()),
    ("frame_ms_mean", |_, m| m.frame_ms.mean.to_string()),
    ("host_ms", |_, m| optional(m.host_ms)),
    ("false_negatives", |_, m| measured(m, m.false_negatives)),
    ("false_negative_frames", |_, m| measured(m, m.false_negative_frames)),
    ("object_error_percent", |_, m| measured(m, m.object_error_percent)),
    ("differing_pixels_mean", |_, m| measured(m, m.differing_pixels_mean)),
    ("tied_pixels_mean", |_, m| measured(m, m.tied_pixels_mean)),
    ("psnr_mean_db", |_, m| optional(m.psnr_mean_db)),
    ("psnr_worst_db", |_, m| optional(m.psnr_worst_db)),
    ("ssim_mean", |_, m| measured(m, m.ssim_mean)),
    ("drawn_mean", |_, m| measured(m, m.drawn_mean)),
    ("culled_over_total", |_, m| measured(m, m.culled_over_total)),
    ("culled_over_ref", |_, m| measured(m, m.culled_over_ref)),
    ("triangles_mean", |_, m| measured(m, m.triangles_mean)),
    ("draws_mean", |_, m| measured(m, m.draws_mean)),
    ("overdraw_mean", |_, m| optional(m.overdraw_mean)),
    ("queries_mean", |_, m| measured(m, m.queries_mean)),
    ("state_changes_mean", |_, m| measured(m, m.state_changes_mean)),
    ("waits_mean", |_, m| measured(m, m.waits_mean)),
    ("plane_tests_mean", |_, m| measured(m, m.plane_tests_mean)),
    ("rays_mean", |_, m| measured(m, m.rays_mean)),
    ("boxes_mean", |_, m| measured(m, m.boxes_mean)),
    ("moving_bounds", |r, _| r.scene.moving_bounds.clone()),
    ("bounds_brought_mean", |_, m| measured(m, m.bounds_brought_mean)),
    ("refits_mean", |_, m| measured(m, m.refits_mean)),
    ("node_visits_mean", |_, m| measured(m, m.node_visits_mean)),
    ("device_memory_mib", |_, m| m.device_memory_mib.to_string()),
    ("thin_pixels_mean", |_, m| measured(m, m.thin_pixels_mean)),
];

/// The columns between those and the stages, of runs with lens flares.
const FLARES: &[(&str, Cell)] = &[
    ("flare_when", |_, m| m.flare.as_ref().map_or(String::new(), |flare| flare.when.clone())),
    ("flare_shows_mean", |_, m| optional(m.flare.as_ref().and_then(|flare| flare.shows_mean))),
    ("flare_error_mean", |_, m| optional(m.flare.as_ref().and_then(|flare| flare.error_mean))),
    ("flare_error_max", |_, m| optional(m.flare.as_ref().and_then(|flare| flare.error_max))),
];
