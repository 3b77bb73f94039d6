//! The raster conditions ([`raster`](crate::run::raster)) in the laboratory.

use super::lab::{error_of, Lab, Take};
use crate::measures::metrics::{FrameError, Truth};
use crate::run::raster::{self, Sight};
use anyhow::Result;
use scenes::Shot;

/// Returns the error of a frame, and the number of its thin pixels, by the rule of [`raster::judged`].
///
/// # Errors
/// The device's.
pub fn judged(lab: &mut Lab, shot: &Shot, truth: &Truth, take: &Take) -> Result<(FrameError, u64)> {
    let error = error_of(truth, take)?;
    let promised = raster::is_promised(lab.targets.samples(), lab.gpu.depth());
    if !promised || !raster::is_wrong(truth, &take.images, &take.drawn.objects) {
        return Ok((error, 0));
    }
    let view = lab.look(shot, 0)?;
    let sight = Sight::of(&lab.world, &view, shot.seconds)?;
    Ok(raster::judged(&lab.scene, &sight, truth, (&take.images, &take.drawn.objects), error))
}
