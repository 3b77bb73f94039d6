//! What the engine promises to everything above it.

#[path = "engine/device.rs"]
mod device;
#[path = "engine/frames.rs"]
mod frames;
#[path = "engine/memory.rs"]
mod memory;
#[path = "engine/replaced.rs"]
mod replaced;
