//! What can be wrong inside a glTF file, before the file's name is added.

use crate::error::SceneError;
use gltf::json::{Index, Root};
use std::path::Path;

/// Longest fault shown. Names and values in it come from the file, which may be hostile.
const LONGEST_FAULT: usize = 400;

/// A fault, still without the file it is in.
#[derive(Debug)]
pub(super) enum Fault {
    /// The file breaks the glTF specification.
    Broken(String),
    /// The file is legal but needs something Sightline does not do.
    Unsupported {
        /// The extension or feature.
        what: String,
        /// What the user can do about it.
        remedy: String,
    },
    /// More than the engine can address.
    TooLarge(String),
}

pub(super) type Outcome<T> = Result<T, Fault>;

/// Shorthand for the commonest fault.
pub(super) fn broken<T>(fault: impl Into<String>) -> Outcome<T> {
    Err(Fault::Broken(fault.into()))
}

impl Fault {
    /// Puts where it happened before what happened.
    pub(super) fn within(self, place: impl FnOnce() -> String) -> Self {
        match self {
            Fault::Broken(fault) => Fault::Broken(format!("{}: {fault}", place())),
            Fault::TooLarge(fault) => Fault::TooLarge(format!("{}: {fault}", place())),
            unsupported @ Fault::Unsupported { .. } => unsupported,
        }
    }

    /// What is wrong, in one line without the file: for what a file can be read without.
    pub(super) fn to_line(&self) -> String {
        match self {
            Fault::Broken(fault) | Fault::TooLarge(fault) => one_line(fault, LONGEST_FAULT),
            Fault::Unsupported { what, remedy } => one_line(&format!("{what}; {remedy}"), LONGEST_FAULT),
        }
    }

    /// The error for the user.
    pub(super) fn in_file(self, path: &Path) -> SceneError {
        match self {
            Fault::Broken(fault) => SceneError::Broken { path: path.into(), fault: one_line(&fault, LONGEST_FAULT) },
            Fault::Unsupported { what, remedy } => SceneError::Unsupported {
                path: path.into(),
                what: one_line(&what, LONGEST_FAULT),
                remedy: format!("; {remedy}"),
            },
            Fault::TooLarge(fault) => {
                SceneError::TooLarge { scene: path.display().to_string(), fault: one_line(&fault, LONGEST_FAULT) }
            }
        }
    }
}

/// The text without control characters, and cut after `longest` characters.
pub(super) fn one_line(text: &str, longest: usize) -> String {
    let mut line: String =
        text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).take(longest).collect();
    if text.chars().nth(longest).is_some() {
        line.push('…');
    }
    line
}

/// "node 5 'Door'", or "node 5" without a name.
pub(super) fn label(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{kind} {index} '{}'", one_line(name, 60)),
        _ => format!("{kind} {index}"),
    }
}

/// The element of one of the lists of the file that it refers to by index. The crate would panic where there is none.
pub(super) fn element<'a, T>(root: &'a Root, index: Index<T>, kind: &str) -> Outcome<&'a T>
where
    Root: AsRef<[T]>,
{
    let list = root.as_ref();
    match list.get(index.value()) {
        Some(element) => Ok(element),
        None => broken(format!("it refers to {kind} {index}, but the file has {}", list.len())),
    }
}
