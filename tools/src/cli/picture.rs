//! How large and how fine a picture is, and what is drawn.

use crate::run::samples::SAMPLES;
use crate::run::session::SessionOptions;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::Args;
use culling::Shading;
use scenes::{Fit, MovingBounds};

/// How finely pixels are drawn.
#[derive(Args, Clone, Copy, Debug)]
pub struct SampleChoice {
    /// Samples a pixel: 1, or 4 for smooth edges. What is culled is then hidden at all of them, and errors are counted by samples
    #[arg(long, value_name = "1|4", default_value_t = 1, value_parser = parse_samples)]
    pub samples: u32,
}

impl SampleChoice {
    /// A session with so many samples a pixel.
    pub fn of(self, session: SessionOptions) -> SessionOptions {
        SessionOptions { samples: self.samples, ..session }
    }
}

fn parse_samples(text: &str) -> Result<u32, String> {
    match text {
        "1" => Ok(1),
        "4" => Ok(SAMPLES),
        _ => Err("1 or 4 samples a pixel".to_owned()),
    }
}

/// A size in pixels, as in 1280x720.
pub(super) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let parts =
        text.split_once(['x', 'X']).and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    match parts {
        Some(size) if !size.contains(&0) => Ok(size),
        _ => Err("give width and height in pixels, as in 1280x720".to_owned()),
    }
}

/// The ways to have bounds of what moves, by name.
pub(super) fn bounds_names() -> impl TypedValueParser<Value = MovingBounds> {
    let named = |name: String| MovingBounds::ALL.into_iter().find(|mode| mode.name() == name).unwrap_or_default();
    PossibleValuesParser::new(MovingBounds::ALL.map(MovingBounds::name)).map(named)
}

/// The ways to fit a camera's rectangle into a picture, by name.
pub(super) fn fit_names() -> impl TypedValueParser<Value = Fit> {
    let named = |name: String| Fit::ALL.into_iter().find(|fit| fit.name() == name).unwrap_or_default();
    PossibleValuesParser::new(Fit::ALL.map(Fit::name)).map(named)
}

/// What is drawn of materials.
pub(super) fn parse_shading(text: &str) -> Result<Shading, String> {
    match text {
        "lambert" => Ok(Shading::Lambert),
        "textured" => Ok(Shading::Textured),
        _ => Err("it is lambert or textured".to_owned()),
    }
}
