//! One way in for every scene: by name, or from a file.

use crate::error::SceneError;
use crate::model::Scene;
use crate::procedural::{SceneOptions, MOST_DETAIL, SCENES};
use std::path::Path;

/// Opens a procedural scene by name or alias, or a .glb or .gltf file. A name goes before a file of the same name.
/// The scene has passed [`Scene::check`], and wrong declared bounds are repaired with a warning.
///
/// # Errors
/// An unknown name, a scale that is not above 0 and finite, a detail level above [`MOST_DETAIL`], a file that cannot be read or is not a good scene.
pub fn open(name_or_file: &str, options: &SceneOptions) -> Result<Scene, SceneError> {
    let entry = SCENES
        .iter()
        .find(|entry| name_or_file == entry.name || (name_or_file == entry.alias && !entry.alias.is_empty()));
    let mut scene = match entry {
        Some(entry) => {
            check_scale(options.scale)?;
            check_detail(options.detail)?;
            let scene = (entry.make)(options);
            scene.faults()?;
            scene
        }
        // Files are found in order as they are read.
        None => open_file(name_or_file)?,
    };
    scene.repair_bounds(name_or_file);
    Ok(scene)
}

fn check_scale(scale: f64) -> Result<(), SceneError> {
    if scale.is_finite() && scale > 0.0 {
        return Ok(());
    }
    let choices = "any number above 0; 1 is the scene's standard size".into();
    Err(SceneError::Unknown { kind: "scene scale", name: scale.to_string(), choices })
}

fn check_detail(detail: u32) -> Result<(), SceneError> {
    if detail <= MOST_DETAIL {
        return Ok(());
    }
    let choices = (0..=MOST_DETAIL).map(|level| level.to_string()).collect::<Vec<_>>().join(", ");
    Err(SceneError::Unknown { kind: "detail level", name: detail.to_string(), choices })
}

fn open_file(name_or_file: &str) -> Result<Scene, SceneError> {
    let path = Path::new(name_or_file);
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("glb" | "gltf") => crate::gltf::import(path),
        Some(extension) if path.is_file() => Err(SceneError::Unsupported {
            path: path.into(),
            what: format!("the file type .{extension}"),
            remedy: "; convert it to .glb or .gltf".into(),
        }),
        _ => {
            let names: Vec<&str> = SCENES.iter().map(|entry| entry.name).collect();
            let choices = names.join(", ") + ", or a .glb or .gltf file";
            Err(SceneError::Unknown { kind: "scene", name: name_or_file.into(), choices })
        }
    }
}
