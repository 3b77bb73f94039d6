//! One way in for every scene: by name, or from a file.

use crate::error::SceneError;
use crate::model::Scene;
use crate::procedural::{SceneOptions, MOST_DETAIL, SCENES};
use std::path::Path;

/// At this scale, scenes of a few thousand objects reach the largest number that a scene may have.
const LARGEST_SCALE: f64 = 1e4;

/// Opens a procedural scene by name or alias, or a .glb or .gltf file. A name goes before a file of the same name.
/// The scene has passed [`Scene::check`], and wrong declared bounds are repaired with a warning.
///
/// # Errors
/// An unknown name, a scale that is not above 0 and at most 10,000, a detail level above [`MOST_DETAIL`], or a file that cannot be read
/// or is not a good scene.
pub fn open(name_or_file: impl AsRef<Path>, options: &SceneOptions) -> Result<Scene, SceneError> {
    let path = name_or_file.as_ref();
    let named = |name: &str| !name.is_empty() && path.as_os_str() == name;
    let entry = SCENES.iter().find(|entry| named(entry.name) || named(entry.alias));
    let mut scene = match entry {
        Some(entry) => {
            check_scale(options.scale)?;
            check_detail(options.detail)?;
            let scene = (entry.make)(options);
            scene.faults()?;
            scene
        }
        // Files are found in order as they are read.
        None => open_file(path)?,
    };
    scene.repair_bounds(&path.to_string_lossy());
    Ok(scene)
}

fn check_scale(scale: f64) -> Result<(), SceneError> {
    if scale > 0.0 && scale <= LARGEST_SCALE {
        return Ok(());
    }
    let choices = "any number above 0 and up to 10000; 1 is the scene's standard size".into();
    Err(SceneError::Unknown { kind: "scene scale", name: crate::error::typed_number(scale), choices })
}

fn check_detail(detail: u32) -> Result<(), SceneError> {
    if detail <= MOST_DETAIL {
        return Ok(());
    }
    let choices = (0..=MOST_DETAIL).map(|level| level.to_string()).collect::<Vec<_>>().join(", ");
    Err(SceneError::Unknown { kind: "detail level", name: detail.to_string(), choices })
}

fn open_file(path: &Path) -> Result<Scene, SceneError> {
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
            Err(SceneError::Unknown { kind: "scene", name: path.to_string_lossy().into_owned(), choices })
        }
    }
}
