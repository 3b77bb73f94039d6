//! GLSL, and the contract between GPU and CPU.
//!
//! `shaders/glsl/FAMILY/VERB_NOUN.{comp,vert,frag}` is the source of every fact that both sides share. `cargo shaders`
//! compiles it and writes `shaders/generated/`: SPIR-V and one Rust struct per stage. See `shaders/README.md`.

pub mod contract;
#[cfg(generated)]
#[path = "../generated/mod.rs"]
mod generated;
#[cfg(feature = "compile")]
pub mod generator;
pub mod reload;
pub mod sources;

pub use contract::*;
#[cfg(generated)]
pub use generated::*;
