//! Compares pictures of scene files with the oracle (harness::oracle). For each file, `none` draws the frames of a camera path; the
//! program counts the pixels that show another object than the one that their ray meets first. Exit code 1 if there are any.
//!
//! `cargo run -p sightline-tests --example oracle -- [--frames N] [--path NAME] FILE.glb...`

use anyhow::{bail, Context, Result};
use engine::{Gpu, GpuOptions};
use harness::oracle::{faults, surfaces, Pixel, Rays};
use scenes::{SceneOptions, Shot};
use sightline::run::session::{Session, SessionOptions};
use sightline::run::truth::draw_truth;
use std::path::PathBuf;

fn main() -> Result<()> {
    let (mut frames, mut path, mut files) = (3, None, Vec::new());
    let mut arguments = std::env::args_os().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().with_context(|| format!("{} needs a value", argument.display()));
        match argument.to_str() {
            Some("--frames") => frames = value()?.to_string_lossy().parse().context("--frames takes a number")?,
            Some("--path") => path = Some(PathBuf::from(value()?)),
            _ => files.push(PathBuf::from(&argument)),
        }
    }
    if files.is_empty() {
        bail!("name scene files, or procedural scenes");
    }
    let gpu = Gpu::open(&GpuOptions { validation: true, ..GpuOptions::default() })?;
    let mut wrong = 0;
    for file in &files {
        wrong += check(&gpu, file, frames, path.clone())?;
    }
    match wrong {
        0 => Ok(()),
        _ => bail!("{wrong} pixels are wrong"),
    }
}

/// Prints the result of one file. Returns the number of wrong pixels.
fn check(gpu: &Gpu, file: &std::path::Path, frames: usize, path: Option<PathBuf>) -> Result<usize> {
    let scene = match scenes::open(file, &SceneOptions { scale: 0.05, ..SceneOptions::default() }) {
        Ok(scene) => scene,
        Err(error) => {
            println!("{}: not read: {error}", file.display());
            return Ok(0);
        }
    };
    let options = SessionOptions { path, whole_path: true, frames, size: [320, 180], ..SessionOptions::default() };
    let mut session = Session::with_scene(gpu, scene, options)?;
    let (mut wrong, mut clear, mut all) = (Vec::new(), 0, 0);
    for frame in 0..frames {
        let shot: Shot = session.shot(frame);
        let view = session.look(frame)?;
        let images = draw_truth(gpu, &session.world, &session.targets, &view)?;
        let object = |item: &u32| (*item != u32::MAX).then(|| session.world.scene_object(*item as usize) as u32);
        let items: Vec<Option<u32>> = images.items.iter().map(object).collect();
        let (surfaces, wide) = surfaces(&session.scene, shot.seconds);
        let snap_px = f64::from(session.targets.reach_px(gpu));
        let pixels = Rays::new(shot.pose, shot.projection, view.size, snap_px).cast(&surfaces, &wide);
        clear += pixels.iter().filter(|pixel| **pixel != Pixel::Open).count();
        all += pixels.len();
        wrong.extend(faults(&format!("frame {frame}"), &pixels, &items, view.size[0]));
    }
    println!("{}: {} wrong of {clear} clear pixels ({all} in all)", file.display(), wrong.len());
    wrong.iter().take(3).for_each(|line| println!("    {line}"));
    Ok(wrong.len())
}
