//! The arguments of `sightline shot`.

use super::{DeviceArgs, FlareChoice, SampleChoice, SceneChoice};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// What a shot shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Show {
    /// The picture
    Colour,
    /// Depth as grey: near is bright
    Depth,
    /// One colour an object
    Items,
    /// How often each pixel was shaded
    Overdraw,
    /// The boxes that the method rasterised to test what is in them, over the whole scene seen from above
    Boxes,
    /// The same boxes over the picture itself
    BoxesFirstPerson,
    /// Where each pixel of the frame before goes: direction as hue, length as brightness
    Motion,
    /// The depth that the frame before predicts for this one, as grey
    Warp,
    /// Where it predicts nothing: orange over the real depth
    Holes,
    /// Where it is wrong: red is nearer than the real depth (may hide what shows), blue farther (hides less), dark blue a hole
    WarpError,
}

/// `sightline shot`.
#[derive(Args, Clone, Debug)]
pub struct ShotArgs {
    /// Scene, path and size.
    #[command(flatten)]
    pub scene: SceneChoice,
    /// Samples.
    #[command(flatten)]
    pub samples: SampleChoice,
    /// Lens flares.
    #[command(flatten)]
    pub flares: FlareChoice,
    /// Device.
    #[command(flatten)]
    pub device: DeviceArgs,
    /// The method that draws it
    #[arg(long, value_name = "METHOD", default_value = culling::default_method().id)]
    pub method: String,
    /// Sets the method's option, or how depth is warped for a view of that (warp.seeds=8); may be given several times
    #[arg(long, value_name = "METHOD.OPTION=VALUE")]
    pub set: Vec<String>,
    /// The frame of the run
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub frame: usize,
    /// Captures this frame with RenderDoc, to a file beside the picture: that of --frame, or one of the two before it, which run
    /// so that the method has a past
    #[arg(long, value_name = "FRAME")]
    pub capture: Option<usize>,
    /// What to show
    #[arg(long, value_name = "VIEW", default_value = "colour")]
    pub view: Show,
    /// The PNG file
    #[arg(long, value_name = "FILE", default_value = "out/shot.png")]
    pub out: PathBuf,
}
