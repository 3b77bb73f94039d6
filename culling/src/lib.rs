//! Occlusion culling methods, one folder a family, each frame readable as its paper's algorithm.
//!
//! A [`Method`] records a frame that draws what may be visible of a [`World`] as seen through a [`View`]. Methods are listed
//! in [`METHODS`]; adding one is a folder, a line in that list and a test file (see `culling/README.md`).

pub mod auto;
pub mod boxes;
pub mod eovc;
mod error;
pub mod farthest;
pub mod flares;
pub mod frustum;
pub mod horizon;
pub mod hzb;
mod method;
mod methods;
pub mod none;
mod options;
pub mod pack;
pub mod portals;
pub mod queries;
pub mod reference;
pub mod roc;
pub mod seeds;
pub mod translucent;
mod tree;
pub mod warp;
pub mod woc;
pub mod world;

pub use error::Error;
pub use method::{Flare, Guarantee, Method, Setup, TestedBoxes, Work};
pub use methods::{default_method, find, refusal, Entry, METHODS, PARTICULAR};
pub use options::{OptionInfo, Options};
pub use pack::DrawList;
pub use reference::VisibleSets;
pub use world::{draw_lists, drawn_by, drawn_objects, Drawn, Shading, View, World};

/// What culling calls return.
pub type Result<T> = std::result::Result<T, Error>;
