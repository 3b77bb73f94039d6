//! Vulkan for Sightline: device, memory, frames with derived barriers, timers.
//!
//! The only crate that calls `ash`. A [`Gpu`] owns the device; a [`Frame`] records stages that the `shaders` crate
//! generated, derives the barriers between them, runs them and reports what each cost. Nothing here knows a culling method.

mod adapter;
mod barriers;
mod capture;
mod depth;
mod descriptors;
mod error;
mod features;
mod frame;
mod gpu;
mod image;
mod instance;
mod lock;
mod lost;
mod lower;
mod memory;
mod messages;
mod names;
mod open;
mod pipeline;
mod pipeline_cache;
mod recorder;
mod retired;
mod surfaces;
mod swapchain;
mod target;
mod timers;
mod transfer;
mod window;

pub use adapter::{adapters, device_lines, AdapterInfo, DeviceKind};
pub use barriers::{Barrier, BarrierTracker, Point, Use};
pub use capture::Capture;
pub use depth::DepthFormat;
pub use error::Error;
pub use features::{Extra, Feature};
pub use frame::{Frame, FrameReport, OcclusionQueries, Queried, Skip, Statistics};
pub use gpu::{Gpu, GpuOptions};
pub use image::Image;
pub use lower::folded;
pub use memory::{Buffer, Placement};
pub use messages::Message;
pub use recorder::{Faces, IndexedIndirect, Op, Primitives, QueriesRef, Recorded, Recorder, Shapes, Surface};
pub use target::{Format, KeptSample, Samples, Target};
pub use timers::{StageTime, TimerMode};
pub use window::{Panel, Shown, Window};

/// What the engine's calls return.
pub type Result<T> = std::result::Result<T, Error>;
