//! Scenes without a GPU: objects, meshes, bounds, cameras, paths, glTF and procedural scenes.
//!
//! Nothing here knows Vulkan. A [`Scene`] is plain data in `f64` world space; the `culling` crate uploads it.

pub mod animation;
mod bend;
mod bounds;
pub mod bvh;
mod camera;
mod cells;
mod check;
mod declared;
mod error;
mod gltf;
mod gltf_export;
mod hash;
mod mesh_boxes;
mod model;
mod morph;
mod moving;
mod open;
mod path;
pub mod procedural;
mod skin;
mod texture;
mod winding;

pub use animation::Motion;
pub use bounds::WorldBounds;
pub use camera::{Camera, Fit, Pose, Projection};
pub use check::MOST_OBJECTS;
pub use error::SceneError;
pub use gltf::{import, import_bytes};
pub use gltf_export::export_glb;
pub use mesh_boxes::{primitives, MeshBoxes, MOST_BOXES};
pub use model::{Aabb, Building, Cell, Cells, Mesh, Object, Portal, Scene, Surface, Topology, Walk};
pub use morph::{Deformed, Displacement, MorphTarget, Shapes, MOST_TARGETS};
pub use moving::{MovingBounds, MovingBoxes};
pub use open::open;
pub use path::{record, record_shots, CameraPath, PathKind, Shot};
pub use procedural::SceneOptions;
pub use skin::{weights_of_sum_one, JointPlaces, RestVertex, Skin, JOINTS_A_VERTEX};
pub use texture::{Texture, Wrap};
pub use winding::Windings;
