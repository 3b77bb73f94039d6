//! What an object really covers, against the footprint that its box promises: as `sightline stress` measures it.

use crate::{Case, Lab};
use shaders::types::{Bounds, CullView};
use sightline::stress::footprints;
pub use sightline::stress::footprints::{Covered, TooNear};

/// Draws a case's first shot and holds every pixel against its object's footprint; `shape` may change bounds and view
/// first, to plant errors.
pub fn covered(lab: &mut Lab, case: &Case, shape: impl Fn(&mut Bounds, &mut CullView)) -> Covered {
    footprints::covered(lab, &case.shots[0], shape).unwrap_or_else(|error| panic!("{error:#}"))
}
