//! How well depth is warped over a whole run: each frame's depth, as predicted from the frame before, against the real one.
//! Never timed.

use crate::measures::metrics::DepthErrors;
use crate::pictures::png_out::DepthScale;
use crate::pictures::warp_view::farthest_of_blocks;
use crate::results::files::{write_atomically, WriteError};
use crate::run::session::Session;
use crate::run::truth::draw_everything;
use anyhow::{bail, Context, Result};
use culling::warp::{Settings, Warp};
use culling::View;
use engine::{Buffer, Placement};
use shaders::types::DEPTH_FAR;
use std::collections::BTreeMap;
use std::path::Path;

/// The errors of each frame but the first, on the scale of the real depth's picture. `step` is called after each.
///
/// # Errors
/// A run of one frame, or a device that fails.
pub fn warp_errors(session: &mut Session, settings: Settings, step: &mut dyn FnMut()) -> Result<Vec<DepthErrors>> {
    if session.frames() < 2 {
        bail!("a warp starts from the frame before: give --frames 2 or more");
    }
    let first = session.look(0)?;
    let mut warp = Warp::new(&session.gpu, &session.world, first.size, settings).context("depth warping")?;
    let [width, height] = warp.texels();
    let warped = Buffer::new(&session.gpu, "warped", (width * height) as usize, Placement::Storage)?;
    draw_everything(session, 0)?;
    keep(session, &mut warp, &first)?;
    let mut errors = Vec::new();
    for frame in 1..session.frames() {
        let view = session.look(frame)?;
        let mut f = session.gpu.frame();
        warp.frame(&mut f, &session.world, &view, warped.all())?;
        f.finish().with_context(|| format!("warping to frame {frame}"))?;
        // Holes, which are farther than far, are compared as far.
        let predicted: Vec<f32> = warped.read()?.into_iter().map(|depth| depth.max(DEPTH_FAR)).collect();
        let truth = draw_everything(session, frame)?.depth;
        keep(session, &mut warp, &view)?;
        let scale = DepthScale::of(&truth);
        let truth = farthest_of_blocks(&truth, view.size, settings.reduction);
        errors.push(DepthErrors::of(&predicted, &truth, width, |depth| scale.brightness(depth))?);
        step();
    }
    Ok(errors)
}

fn keep(session: &Session, warp: &mut Warp, view: &View) -> Result<()> {
    let mut f = session.gpu.frame();
    warp.keep(&mut f, &session.world, view, &session.targets.with_items());
    f.finish().context("keeping a frame's depth")?;
    Ok(())
}

/// Writes one row per warp and frame; PSNR is empty where there is no such error.
///
/// # Errors
/// A file that cannot be written.
pub fn write_csv(errors: &BTreeMap<String, Vec<DepthErrors>>, path: &Path) -> Result<(), WriteError> {
    const HEADS: [&str; 9] = [
        "label",
        "frame",
        "psnr_db",
        "ssim",
        "nearer_psnr_db",
        "farther_psnr_db",
        "nearer_percent",
        "farther_percent",
        "hole_percent",
    ];
    let optional = |psnr: Option<f64>| psnr.map_or(String::new(), |psnr| psnr.to_string());
    write_atomically(path, |to| {
        let mut csv = csv::Writer::from_writer(to);
        csv.write_record(HEADS)?;
        for (label, frames) in errors {
            for (frame, errors) in (1..).zip(frames) {
                csv.write_record([
                    label.clone(),
                    u32::to_string(&frame),
                    optional(errors.psnr_db),
                    errors.ssim.to_string(),
                    optional(errors.nearer_psnr_db),
                    optional(errors.farther_psnr_db),
                    errors.nearer_percent.to_string(),
                    errors.farther_percent.to_string(),
                    errors.hole_percent.to_string(),
                ])?;
            }
        }
        csv.flush()
    })
}
