//! Shaders that a program takes while it runs, in place of those that it was built with.

use crate::contract::ShaderKind;

#[cfg(all(feature = "compile", generated))]
mod reloader;

#[cfg(all(feature = "compile", generated))]
pub use reloader::Reloader;

/// A shader to use in place of the one that was built in: SPIR-V with the same bindings, push constants, constants, inputs and outputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NewShader {
    /// The stage's name, `family/verb_noun`.
    pub stage: String,
    /// Which of the stage's shaders.
    pub kind: ShaderKind,
    /// SPIR-V.
    pub words: Vec<u32>,
}
