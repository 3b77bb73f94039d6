//! The arguments of `sightline view`.

use super::{DeviceArgs, FlareChoice, MethodChoice, SceneChoice};
use crate::view::keys::KEYS;
use clap::Args;
use std::path::PathBuf;

/// `sightline view`.
#[derive(Args, Clone, Debug)]
#[command(mut_arg("frames", |frames| frames.default_value("960").help(
    "Frames of the path; with --keys or --screenshot, also of the window, which then closes"
)))]
pub struct ViewArgs {
    /// Scene, path and the window's first size.
    #[command(flatten)]
    pub scene: SceneChoice,
    /// Lens flares.
    #[command(flatten)]
    pub flares: FlareChoice,
    /// Methods and options, in the order of the Tab key.
    #[command(flatten)]
    pub methods: MethodChoice,
    /// Device.
    #[command(flatten)]
    pub device: DeviceArgs,
    /// Presses keys by itself, one step a frame, for tests: see below
    #[arg(long, value_name = "STEPS", allow_hyphen_values = true)]
    pub keys: Option<String>,
    /// Saves what the window shows in the last frame to this PNG file
    #[arg(long, value_name = "FILE")]
    pub screenshot: Option<PathBuf>,
    /// Captures this frame of the window (counted from 0) with RenderDoc, to a file in --out
    #[arg(long, value_name = "FRAME")]
    pub capture: Option<usize>,
    /// Folder for screenshots, saved cameras and recorded paths
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

/// What `--help` says below the options.
pub fn view_help() -> String {
    let keys = KEYS.iter().filter(|(.., help)| !help.is_empty()).map(|(.., help)| format!("  {help}\n"));
    format!(
        "Keys:\n{}\nSteps of --keys, separated by commas: {}",
        keys.collect::<String>(),
        crate::view::keys::STEPS_HELP
    )
}
