//! The stages that methods share, against their twins.

#[path = "stages/groups.rs"]
mod groups;
#[path = "stages/pack.rs"]
mod pack;
#[path = "stages/trees.rs"]
mod trees;
#[path = "stages/world.rs"]
mod world;
