//! `results.json`, the contract with everything that reads Sightline's results: its structs, how it is written and read,
//! and its two other faces, the CSV file and the tables on the terminal.
//!
//! Fields are only ever added; a change of meaning raises [`SCHEMA`]. Readers ignore fields they do not know.

mod read;
mod table;
#[cfg(test)]
mod tests;
mod write;

pub use table::{stages_table, table};

use crate::files::WriteError;
use crate::metrics::MethodErrors;
use crate::stats;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The version of the contract that this program writes and reads.
pub const SCHEMA: u32 = 1;

/// One run: methods over the same frames of one scene on one device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Version of this contract, [`SCHEMA`].
    pub schema: u32,
    /// Version of the program that wrote it.
    pub sightline_version: String,
    /// The command line that makes this run again.
    pub command: String,
    /// What it ran on.
    pub device: Device,
    /// What was drawn.
    pub scene: Scene,
    /// Name or file of the camera path.
    pub path: String,
    /// Speed along the path; 1 is as recorded.
    pub speed: f64,
    /// Seed of everything random in scene and methods.
    pub seed: u64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Measured frames.
    pub frames: u32,
    /// The methods in the order in which they were asked for.
    pub methods: Vec<Method>,
}

/// The Vulkan device of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Device {
    /// Name as the driver gives it.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`. Absolute times of `cpu` are no results.
    #[serde(rename = "type")]
    pub kind: String,
    /// Driver and its version.
    pub driver: String,
    /// Vulkan version, such as `1.3.230`.
    pub api_version: String,
    /// How stage times were taken: `timestamps` or `submits`.
    pub timer_mode: String,
    /// More about the device, for people.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub details: BTreeMap<String, String>,
}

/// The scene of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Name or file.
    pub name: String,
    /// Objects (N).
    pub objects: u64,
    /// Triangles of all objects.
    pub triangles: u64,
}

/// One method's row.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Method {
    /// The method's id, and `[option=value,…]` for what differs from its defaults. Unique in the file.
    pub label: String,
    /// The method's id.
    pub method: String,
    /// All options with the values used, defaults included.
    pub options: BTreeMap<String, serde_json::Value>,
    /// `exact`, or `approximate: ` and why.
    pub guarantee: String,
    /// Time from a frame's first submit to the idle device.
    pub frame_ms: FrameMs,
    /// Median per frame of the host's time outside the driver.
    #[serde(default)]
    pub host_ms: Option<f64>,
    /// The stages in the order of the frame.
    pub stages: Vec<Stage>,
    /// Visible objects that were not drawn, summed over frames.
    pub false_negatives: u64,
    /// Frames with at least one of them.
    pub false_negative_frames: u32,
    /// False negatives in percent of the visible objects.
    pub object_error_percent: f64,
    /// Pixels whose depth differs from the truth.
    pub differing_pixels_mean: f64,
    /// Pixels of equal depth won by another object: no error.
    #[serde(default)]
    pub tied_pixels_mean: f64,
    /// Mean over the frames that are not identical; `null`: all are identical.
    pub psnr_mean_db: Option<f64>,
    /// The worst frame; `null`: all are identical.
    pub psnr_worst_db: Option<f64>,
    /// Structural similarity; 1: identical.
    pub ssim_mean: f64,
    /// Objects drawn.
    pub drawn_mean: f64,
    /// C/N: culled over all objects.
    pub culled_over_total: f64,
    /// C/R: culled over the objects that REF culls.
    pub culled_over_ref: f64,
    /// Triangles drawn.
    pub triangles_mean: f64,
    /// Draw commands executed.
    pub draws_mean: f64,
    /// Fragments shaded per covered pixel; `null`: not measured.
    #[serde(default)]
    pub overdraw_mean: Option<f64>,
    /// Occlusion queries issued.
    pub queries_mean: f64,
    /// Rays cast.
    pub rays_mean: f64,
    /// Boxes rasterised to test what is in them.
    #[serde(default)]
    pub boxes_mean: f64,
    /// Nodes that rays looked at.
    #[serde(default)]
    pub node_visits_mean: f64,
    /// Device memory that the method holds.
    pub device_memory_mib: f64,
    /// The measures of each frame.
    pub frames: Frames,
}

/// The spread of a method's frame times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameMs {
    /// Half of the frames took no longer.
    pub median: f64,
    /// 95 % of the frames took no longer.
    pub p95: f64,
    /// Mean.
    pub mean: f64,
}

impl FrameMs {
    /// From the time of each frame; `None` if there is none, or one that is not a number.
    pub fn from_samples(frame_ms: &[f64]) -> Option<Self> {
        Some(Self { median: stats::median(frame_ms)?, p95: stats::p95(frame_ms)?, mean: stats::mean(frame_ms)? })
    }
}

/// What one stage of a method costs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stage {
    /// The stage's name, which is its shader's path or the name of a step of the frame.
    pub name: String,
    /// Median over the frames in which it ran; 0 if it ran in none.
    pub median_ms: f64,
    /// Its part of the time of all frames together, 0 to 1.
    pub share: f64,
    /// Frames in which it was skipped.
    pub skipped: u32,
    /// Why it was skipped, or `null`.
    pub reason: Option<String>,
}

/// The measures of each frame, in the order of the path. An array is empty if the measure was not taken; otherwise it
/// has as many entries as the run has frames.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Frames {
    /// Frame times (the median of the frame's repetitions).
    pub frame_ms: Vec<f64>,
    /// Objects drawn.
    pub drawn: Vec<u64>,
    /// Size of the visible set.
    pub ref_visible: Vec<u64>,
    /// Visible objects not drawn.
    pub false_negatives: Vec<u64>,
    /// Pixels whose depth differs.
    pub differing_pixels: Vec<u64>,
    /// Pixels of equal depth won by another object.
    pub tied_pixels: Vec<u64>,
    /// `null`: identical.
    pub psnr_db: Vec<Option<f64>>,
    /// 1: identical.
    pub ssim: Vec<f64>,
    /// Triangles drawn.
    pub triangles: Vec<u64>,
    /// Draw commands executed.
    pub draws: Vec<u64>,
    /// Fragments shaded per covered pixel.
    pub overdraw: Vec<f64>,
    /// Occlusion queries issued.
    pub queries: Vec<u64>,
    /// Rays cast.
    pub rays: Vec<u64>,
}

impl Frames {
    /// Name and length of every array.
    fn lengths(&self) -> [(&'static str, usize); 13] {
        [
            ("frame_ms", self.frame_ms.len()),
            ("drawn", self.drawn.len()),
            ("ref_visible", self.ref_visible.len()),
            ("false_negatives", self.false_negatives.len()),
            ("differing_pixels", self.differing_pixels.len()),
            ("tied_pixels", self.tied_pixels.len()),
            ("psnr_db", self.psnr_db.len()),
            ("ssim", self.ssim.len()),
            ("triangles", self.triangles.len()),
            ("draws", self.draws.len()),
            ("overdraw", self.overdraw.len()),
            ("queries", self.queries.len()),
            ("rays", self.rays.len()),
        ]
    }
}

/// Why results could not be written or read. One line that names the file, and the field where there is one.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The file could not be read.
    #[error("{}: cannot read it: {source}", path.display())]
    Read {
        /// The file asked for.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The content breaks the contract.
    #[error("{}: {field}: {fault}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// The field, such as `methods[2].frame_ms.median`.
        field: String,
        /// What is wrong with it.
        fault: String,
    },
}

/// A field that breaks the contract, and how.
struct Fault {
    field: String,
    fault: String,
}

impl Results {
    /// The method with this label.
    pub fn method(&self, label: &str) -> Option<&Method> {
        self.methods.iter().find(|method| method.label == label)
    }

    /// What the types do not say: the schema, unique labels, lengths of arrays, and numbers that are numbers.
    fn check(&self) -> Result<(), Fault> {
        let fault = |field: String, fault: String| Err(Fault { field, fault });
        if self.schema != SCHEMA {
            let reads = format!("is {}, but this program reads {SCHEMA}", self.schema);
            return fault("schema".into(), reads);
        }
        if !self.speed.is_finite() {
            return fault("speed".into(), "is not a finite number".into());
        }
        for (index, method) in self.methods.iter().enumerate() {
            let at = |field: &str| format!("methods[{index}].{field}");
            if method.label.is_empty() {
                return fault(at("label"), "is empty".into());
            }
            let mut earlier = self.methods[..index].iter();
            if earlier.any(|other| other.label == method.label) {
                let twice = format!("`{}` is there twice; labels are unique", method.label);
                return fault(at("label"), twice);
            }
            for (name, length) in method.frames.lengths() {
                if length != 0 && length != self.frames as usize {
                    let wrong = format!("has {length} entries for {} frames", self.frames);
                    return fault(at(&format!("frames.{name}")), wrong);
                }
            }
            if let Some(name) = method.first_not_finite() {
                return fault(at(&name), "is not a finite number".into());
            }
        }
        Ok(())
    }
}

impl Method {
    /// Takes over everything that the comparison with the truth says.
    pub fn set_errors(&mut self, errors: &MethodErrors) {
        self.false_negatives = errors.false_negatives as u64;
        self.false_negative_frames = errors.false_negative_frames as u32;
        self.object_error_percent = errors.object_error_percent;
        self.differing_pixels_mean = errors.differing_pixels_mean;
        self.tied_pixels_mean = errors.tied_pixels_mean;
        self.psnr_mean_db = errors.psnr_mean_db;
        self.psnr_worst_db = errors.psnr_worst_db;
        self.ssim_mean = errors.ssim_mean;
        self.drawn_mean = errors.drawn_mean;
        self.culled_over_total = errors.culled_over_total;
        self.culled_over_ref = errors.culled_over_ref;
    }

    /// JSON has no NaN and no infinity: serde writes `null`, which would read as "identical" or not at all.
    fn first_not_finite(&self) -> Option<String> {
        let scalars = [
            ("frame_ms.median", Some(self.frame_ms.median)),
            ("frame_ms.p95", Some(self.frame_ms.p95)),
            ("frame_ms.mean", Some(self.frame_ms.mean)),
            ("host_ms", self.host_ms),
            ("object_error_percent", Some(self.object_error_percent)),
            ("differing_pixels_mean", Some(self.differing_pixels_mean)),
            ("tied_pixels_mean", Some(self.tied_pixels_mean)),
            ("psnr_mean_db", self.psnr_mean_db),
            ("psnr_worst_db", self.psnr_worst_db),
            ("ssim_mean", Some(self.ssim_mean)),
            ("drawn_mean", Some(self.drawn_mean)),
            ("culled_over_total", Some(self.culled_over_total)),
            ("culled_over_ref", Some(self.culled_over_ref)),
            ("triangles_mean", Some(self.triangles_mean)),
            ("draws_mean", Some(self.draws_mean)),
            ("overdraw_mean", self.overdraw_mean),
            ("queries_mean", Some(self.queries_mean)),
            ("rays_mean", Some(self.rays_mean)),
            ("device_memory_mib", Some(self.device_memory_mib)),
        ];
        let scalars = scalars.map(|(name, value)| (name.to_string(), value));
        let stages = self.stages.iter().enumerate().flat_map(|(index, stage)| {
            let at = |field: &str| format!("stages[{index}].{field}");
            [(at("median_ms"), Some(stage.median_ms)), (at("share"), Some(stage.share))]
        });
        let plain =
            [("frame_ms", &self.frames.frame_ms), ("ssim", &self.frames.ssim), ("overdraw", &self.frames.overdraw)];
        let arrays = plain.into_iter().flat_map(|(name, values)| {
            let at = move |(frame, &value)| (format!("frames.{name}[{frame}]"), Some(value));
            values.iter().enumerate().map(at)
        });
        let psnr = self.frames.psnr_db.iter().enumerate();
        let psnr = psnr.map(|(frame, &value)| (format!("frames.psnr_db[{frame}]"), value));
        let mut all = scalars.into_iter().chain(stages).chain(arrays).chain(psnr);
        all.find(|(_, value)| value.is_some_and(|v| !v.is_finite())).map(|(name, _)| name)
    }
}
