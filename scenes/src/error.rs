//! What can be wrong with a scene, said in one line that names the file or object and the remedy.

use std::path::PathBuf;

/// Why a scene could not be made. Every message is one line and names the file or object.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file could not be read.
    #[error("{}: cannot read it: {cause}", path.display())]
    Read {
        /// The file asked for.
        path: PathBuf,
        /// What the system said.
        cause: std::io::Error,
    },
    /// The file is not a legal scene.
    #[error("{}: {fault}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// The fault, with the element it is in and, where there is one, the remedy.
        fault: String,
    },
    /// The file is legal but needs something that Sightline does not do.
    #[error("{}: {what} is not supported{remedy}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// The extension or feature.
        what: String,
        /// What the user can do, starting with "; ", or empty.
        remedy: String,
    },
    /// An object has a transform or bounds without a meaning.
    #[error("object '{object}': {fault}")]
    BadObject {
        /// The object's name.
        object: String,
        /// What is wrong with it.
        fault: String,
    },
    /// No scene or path of that name.
    #[error("there is no {kind} '{name}'; choose one of: {choices}")]
    Unknown {
        /// "scene" or "camera path".
        kind: &'static str,
        /// The name asked for.
        name: String,
        /// What there is, separated by commas.
        choices: String,
    },
    /// The scene is too large for what the engine can address.
    #[error("scene '{scene}': {fault}")]
    TooLarge {
        /// The scene's name.
        scene: String,
        /// What is too large, and the limit.
        fault: String,
    },
}

/// A number as people type it: 1e308 has no 308 zeros.
pub(crate) fn typed_number(number: f64) -> String {
    match number.abs() {
        size if size == 0.0 || (1e-4..1e9).contains(&size) || !size.is_finite() => number.to_string(),
        _ => format!("{number:e}"),
    }
}
