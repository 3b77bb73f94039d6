//! What `view` writes: cameras and recordings as paths, and screenshots.

use crate::pictures::png_out::Picture;
use crate::results::files::write_atomically;
use crate::run::bench::make_folder;
use anyhow::{Context, Result};
use scenes::{record_shots, Shot};
use std::path::{Path, PathBuf};

/// Writes shots as a path that `--path FILE` takes, under the first free name `STEM-NNN.json` of a folder.
pub fn path(folder: &Path, stem: &str, shots: &[Shot]) -> Result<PathBuf> {
    let text = record_shots(stem, shots)?;
    let file = free_name(folder, stem, "json")?;
    write_atomically(&file, |to| to.write_all(text.as_bytes()))?;
    Ok(file)
}

/// Writes what a window showed, under a name or the first free one.
pub fn screenshot(folder: &Path, name: Option<&Path>, shown: Option<([u32; 2], Vec<u8>)>) -> Result<PathBuf> {
    let ([width, height], bytes) = shown.context("the window has shown nothing yet: it may be minimised")?;
    let pixels = bytes.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let file = match name {
        Some(name) => name.to_owned(),
        None => free_name(folder, "screenshot", "png")?,
    };
    if let Some(parent) = file.parent().filter(|parent| !parent.as_os_str().is_empty() && !parent.is_dir()) {
        make_folder(parent)?;
    }
    Picture { width, height, pixels }.write(&file)?;
    Ok(file)
}

fn free_name(folder: &Path, stem: &str, ending: &str) -> Result<PathBuf> {
    make_folder(folder)?;
    let mut names = (1u32..).map(|number| folder.join(format!("{stem}-{number:03}.{ending}")));
    names.find(|name| !name.exists()).context("no name is free")
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenes::{CameraPath, Pose, Projection};

    #[test]
    fn a_saved_camera_is_a_path_that_reads_back_the_same() {
        let folder = std::env::temp_dir().join(format!("sightline-view-{}", std::process::id()));
        let pose = Pose::looking_at(glam::DVec3::new(1.0, 2.0, 3.0), glam::DVec3::ZERO);
        let projection = Projection::Perspective { fov_y: 60.0_f64.to_radians(), near: 0.1, far: None };
        let shot = Shot { pose, projection, seconds: 2.5 };
        let files = [path(&folder, "camera", &[shot]).unwrap(), path(&folder, "camera", &[shot, shot]).unwrap()];
        assert!(files[0].ends_with("camera-001.json") && files[1].ends_with("camera-002.json"), "{files:?}");
        for file in &files {
            let read = CameraPath::from_file(file, 1.0).unwrap().sample(0, 30);
            assert_eq!(read.seconds, shot.seconds);
            assert!(read.pose.position == pose.position && read.pose.forward().distance(pose.forward()) < 1e-12);
        }
        let error = screenshot(&folder, None, None).unwrap_err().to_string();
        assert!(error.contains("shown nothing yet"), "{error}");
        std::fs::remove_dir_all(folder).unwrap();
    }
}
