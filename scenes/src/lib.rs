//! Scenes without a GPU: objects, meshes, bounds, cameras, paths, glTF and procedural scenes.
//!
//! Nothing here knows Vulkan. A [`Scene`] is plain data in `f64` world space; the `culling` crate uploads it.

pub mod animation;
mod camera;
mod error;
mod model;

pub use animation::Motion;
pub use camera::{Camera, Pose, Projection};
pub use error::SceneError;
pub use model::{Aabb, Mesh, Object, Scene, Topology};
