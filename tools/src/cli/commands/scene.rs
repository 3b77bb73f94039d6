//! `sightline scene`: what there is, what it holds, and export.

use super::say;
use crate::cli::{SceneAction, SceneArgs, SceneChoice};
use crate::results::files::{check_file, write_atomically};
use crate::run::session::camera_path;
use anyhow::Result;
use scenes::procedural::SCENES;
use scenes::{CameraPath, Scene, SceneOptions};
use std::path::Path;

/// Lists, shows or exports.
pub fn run(arguments: &SceneArgs) -> Result<()> {
    match &arguments.action {
        None | Some(SceneAction::List) => list(),
        Some(SceneAction::Show(choice)) => show(choice),
        Some(SceneAction::Export { scene, out }) => export(scene, out),
    }
}

fn list() -> Result<()> {
    for entry in SCENES {
        let alias = if entry.alias.is_empty() { String::new() } else { format!(" ({})", entry.alias) };
        say(&format!("{:<20} {}", format!("{}{alias}", entry.name), entry.about))?;
    }
    say("any .glb or .gltf file   glTF 2.0")
}

fn open(choice: &SceneChoice) -> Result<(Scene, CameraPath)> {
    let SceneChoice { scale, seed, detail_level: detail, .. } = *choice;
    let scene = scenes::open(&choice.one_scene()?, &SceneOptions { scale, seed, detail })?;
    let path = camera_path(&scene, choice.path.as_deref(), choice.speed)?;
    let path = if choice.whole_path { path.whole() } else { path };
    Ok((scene, path))
}

fn show(choice: &SceneChoice) -> Result<()> {
    let (scene, path) = open(choice)?;
    let bounds = scene.bounds();
    let moving = scene.objects.iter().filter(|object| object.dynamic).count();
    say(&format!("scene      {}", scene.name))?;
    say(&format!("objects    {} ({moving} moving)", scene.objects.len()))?;
    say(&format!("meshes     {}", scene.meshes.len()))?;
    say(&format!("triangles  {}", scene.triangles()))?;
    say(&format!("bounds     {:.3} to {:.3} m", bounds.min, bounds.max))?;
    let cameras: Vec<_> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    say(&format!(
        "cameras    {}",
        if cameras.is_empty() { "none: made from the bounds".to_owned() } else { cameras.join(", ") }
    ))?;
    say(&format!("paths      {} (chosen: {})", CameraPath::names(&scene).join(", "), path.name()))
}

fn export(choice: &SceneChoice, out: &Path) -> Result<()> {
    check_file(out)?;
    let (scene, path) = open(choice)?;
    let bytes = scenes::export_glb(&scene, Some(&path), choice.frames as usize)?;
    write_atomically(out, |file| file.write_all(&bytes))?;
    say(&format!(
        "{}: {} objects, {:.1} MiB",
        out.display(),
        scene.objects.len(),
        bytes.len() as f64 / (1024.0 * 1024.0)
    ))
}
