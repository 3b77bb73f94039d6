//! `results.json`, the contract with everything that reads Sightline's results: its structs, how it is written and read,
//! and its two other faces, the CSV file and the tables on the terminal.
//!
//! Fields are only ever added; a change of meaning raises [`SCHEMA`]. Readers ignore fields they do not know.

mod check;
pub mod files;
mod flares;
pub(crate) mod grid;
pub(crate) mod output;
mod parts;
mod read;
mod table;
#[cfg(test)]
pub(crate) mod tests;
pub mod trace;
mod write;

pub use flares::flares_table;
pub use parts::parts_table;
pub(crate) use table::{decibels, error, heading, percent, quantity};
pub use table::{stages_table, table};

use crate::measures::metrics::MethodErrors;
use crate::measures::stats;
use crate::results::files::WriteError;
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
    /// How depth was kept, such as `D32_SFLOAT (reversed)`, with which alone the exact methods are exact. Empty in older files: that.
    #[serde(default)]
    pub depth_format: String,
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
    /// SHA-256 of all that is drawn, in hexadecimal; empty: not known (results of before it was written).
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub hash: String,
    /// How the bounds of what moves were had: `per-frame`, `per-animation`, `union` or `in-place`; empty: nothing moves, or (in older files)
    /// per frame.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub moving_bounds: String,
    /// How materials were drawn: `lambert` or `textured`; empty: not known (results of before it was written).
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub shading: String,
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
    /// In a sweep, the median as a multiple of that of `ref` in the same cell: what settings of different cells are compared by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ratio_to_ref: Option<f64>,
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
    /// Wrong pixels that only a primitive under 1/8 pixel can have made: they are outside the raster conditions of promised depths. If
    /// they explain every error of a frame, the frame's false negatives, differing pixels, PSNR and SSIM count as right. If not,
    /// nothing is excused and none are counted here. 0 with several samples a pixel or another depth format.
    #[serde(default)]
    pub thin_pixels_mean: f64,
    /// Mean over the frames that are not identical; `null`: all are identical.
    pub psnr_mean_db: Option<f64>,
    /// The worst frame; `null`: all are identical.
    pub psnr_worst_db: Option<f64>,
    /// By label of another method of the run: PSNR between the pictures of the two, mean over the frames that differ, ties
    /// with the other's colours; `null`: no frame differs. Only of those that a table compares.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub psnr_between_db: BTreeMap<String, Option<f64>>,
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
    /// Changes between drawing and testing.
    #[serde(default)]
    pub state_changes_mean: f64,
    /// Times that the host waited for answers.
    #[serde(default)]
    pub waits_mean: f64,
    /// Tests of a box or sphere against a plane of the view volume; 0 for methods that do not count them.
    #[serde(default)]
    pub plane_tests_mean: f64,
    /// Rays cast.
    pub rays_mean: f64,
    /// Boxes rasterised to test what is in them.
    #[serde(default)]
    pub boxes_mean: f64,
    /// Bounds of moving objects brought to the device.
    #[serde(default)]
    pub bounds_brought_mean: f64,
    /// Nodes of a hierarchy fitted to bounds that had changed.
    #[serde(default)]
    pub refits_mean: f64,
    /// Nodes that rays looked at.
    #[serde(default)]
    pub node_visits_mean: f64,
    /// Device memory that the method holds.
    pub device_memory_mib: f64,
    /// What the lens flare over the method's frames knew of its light; none without `--flares`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flare: Option<FlareErrors>,
    /// The measures of each frame.
    pub frames: Frames,
    /// What the method decided in each frame, warm-up included, and why; empty for methods that decide nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub choices: Vec<String>,
}

/// How far a lens flare was from its light. Parts of the light's block of pixels, 0 to 1; `null`: not measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlareErrors {
    /// Whose query said how bright it is: that of the frame before (`next`) or its own (`same`).
    pub when: String,
    /// Where its light is: `towards X,Y,Z` or `at X,Y,Z`.
    pub light: String,
    /// Measured frames in which the light's block is on the screen.
    pub frames_on_screen: u32,
    /// What shows of the light, by the depth buffer.
    pub shows_mean: Option<f64>,
    /// Between what the flare's brightness came from and what shows.
    pub error_mean: Option<f64>,
    /// The same of the worst frame.
    pub error_max: Option<f64>,
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
    /// Why it was skipped, or `null`; where that differs by frame, each reason once, apart by `; `.
    pub reason: Option<String>,
    /// Milliseconds a frame that skipping it saves, as a mean over all frames: what it takes where it runs (median, the
    /// warm-up's frames included), for each frame in which it was skipped. `null`: it never ran, so that nobody knows.
    #[serde(default)]
    pub saved_ms: Option<f64>,
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
    /// Pixels outside the raster conditions; see [`Method::thin_pixels_mean`].
    pub thin_pixels: Vec<u64>,
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
    /// Boxes rasterised to test what is in them.
    pub boxes: Vec<u64>,
    /// Nodes that rays looked at.
    pub node_visits: Vec<u64>,
    /// What of the light the lens flare's brightness came from, 0 to 1; empty without flares.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub flare_by_query: Vec<f64>,
    /// What of it the frame's depth buffer leaves visible.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub flare_by_oracle: Vec<f64>,
    /// Frame times of the frames whose stages were timed, timers included: what [`Frames::stages`] are parts of.
    #[serde(default)]
    pub staged_frame_ms: Vec<f64>,
    /// By stage, under the names of [`Method::stages`], its milliseconds in each frame; `null`: it did not run there.
    pub stages: BTreeMap<String, Vec<Option<f64>>>,
}

impl Frames {
    /// Frame times that the stages' add up to. Results from before stages had frames of their own have one set for both.
    pub fn staged_ms(&self) -> &[f64] {
        if self.staged_frame_ms.is_empty() {
            &self.frame_ms
        } else {
            &self.staged_frame_ms
        }
    }
}

/// Why results could not be written or read. One line that names the file, and the field where there is one.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The file could not be read.
    #[error("{}: cannot read it: {cause}", path.display())]
    Read {
        /// The file asked for.
        path: PathBuf,
        /// What the system said. Not a `source`: the line has it already.
        cause: std::io::Error,
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
}

impl Method {
    /// Was the untimed pass run? Without it nothing is known but times, and every other figure is 0 or `null`.
    pub fn is_measured(&self) -> bool {
        !self.frames.drawn.is_empty()
    }

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
}
