//! Keeps a failure: its scene, its camera, and pictures of what is wrong.

use super::catalogue::Drill;
use super::conditions::judged;
use super::lab::Lab;
use super::run::{truths, wrong};
use super::Subject;
use crate::measures::metrics::{FrameImages, Truth};
use crate::pictures::png_out::Picture;
use crate::results::files::write_atomically;
use anyhow::{Context, Result};
use engine::Gpu;
use scenes::{export_glb, Shot};
use serde_json::{json, Value};
use std::path::Path;

/// Writes `scene.glb`, `drill.json` (shots, sizes, faults, and what glTF could not hold), and `truth.png`, `method.png` and
/// `difference.png` of the first wrong frame to a folder, which is made.
///
/// # Errors
/// A file that cannot be written.
pub fn save(gpu: &Gpu, subject: &Subject, drill: &Drill, faults: &[String], folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).with_context(|| format!("{}: cannot make this folder", folder.display()))?;
    let scene = match export_glb(&drill.case.scene, None, 1) {
        Ok(bytes) => {
            write_atomically(&folder.join("scene.glb"), |out| out.write_all(&bytes))?;
            "scene.glb".to_owned()
        }
        Err(error) => format!("not written: {error}"),
    };
    let pictures = match first_wrong_frame(gpu, subject, drill) {
        Ok(Some((frame, truth, images))) => {
            Picture::colour(&truth).write(&folder.join("truth.png"))?;
            Picture::colour(&images).write(&folder.join("method.png"))?;
            Picture::difference(&truth, &images).write(&folder.join("difference.png"))?;
            format!("frame {frame}")
        }
        Ok(None) => "none: no frame was wrong when it was run again".to_owned(),
        Err(error) => format!("none: {error:#}"),
    };
    let shots: Vec<Value> =
        drill.case.shots.iter().enumerate().map(|(frame, shot)| shot_value(drill, frame, shot)).collect();
    let objects: Vec<&str> = drill.case.scene.objects.iter().map(|object| object.name.as_str()).collect();
    let note = json!({
        "method": subject.options.label(),
        "drill": drill.case.name,
        "faults": faults,
        "scene": scene,
        "pictures": pictures,
        "objects": objects,
        "frames": shots,
    });
    let text = serde_json::to_string_pretty(&note)?;
    Ok(write_atomically(&folder.join("drill.json"), |out| out.write_all(text.as_bytes()))?)
}

/// Place and turn as in a recorded path, and the projection as the matrix it is.
fn shot_value(drill: &Drill, frame: usize, shot: &Shot) -> Value {
    let size = drill.size(frame);
    let clip_from_view = shot.projection.clip_from_view(f64::from(size[0]) / f64::from(size[1]));
    json!({
        "position": shot.pose.position.to_array(),
        "rotation": shot.pose.rotation.to_array(),
        "projection": format!("{:?}", shot.projection),
        "clip_from_view": clip_from_view.to_cols_array().map(|part| if part.is_finite() { json!(part) } else { json!(null) }),
        "seconds": shot.seconds,
        "size": size,
        "forgets": drill.forgets.contains(&frame),
    })
}

fn first_wrong_frame(gpu: &Gpu, subject: &Subject, drill: &Drill) -> Result<Option<(usize, FrameImages, FrameImages)>> {
    let mut lab = Lab::new(gpu, &drill.case)?;
    let (truths, sets): (Vec<Truth>, _) = truths(&mut lab, drill)?;
    let mut method = lab.make(subject, &sets)?;
    for (frame, shot) in drill.case.shots.iter().enumerate() {
        if lab.size != drill.size(frame) {
            lab.resize(drill.size(frame))?;
        }
        if drill.forgets.contains(&frame) {
            method.forget()?;
        }
        let take = lab.take(&mut *method, shot, frame)?;
        if wrong(&judged(&mut lab, shot, &truths[frame], &take)?.0).is_some() {
            return Ok(Some((frame, truths[frame].images().clone(), take.images)));
        }
    }
    Ok(None)
}
