//! What the engine promises to everything above it.

#[path = "engine/device.rs"]
mod device;
#[path = "engine/draws.rs"]
mod draws;
#[path = "engine/frames.rs"]
mod frames;
#[path = "engine/memory.rs"]
mod memory;
#[path = "engine/ranges.rs"]
mod ranges;
#[path = "engine/replaced.rs"]
mod replaced;
#[path = "engine/times.rs"]
mod times;
