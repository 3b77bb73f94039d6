//! The world's stages in plain Rust: their definition.

use shaders::types::{Bounds, MovedObject, MovedTransform, Object};

/// Puts each moved object in its place. Twin of `world/move_objects`.
pub fn move_objects(moves: &[MovedObject], objects: &mut [Object], bounds: &mut [Bounds]) {
    for moved in moves {
        objects[moved.index as usize] = moved.object;
        bounds[moved.index as usize] = moved.bounds;
    }
}

/// Puts each moved object in its place, whose bounds stay. Twin of `world/move_transforms`.
pub fn move_transforms(moves: &[MovedTransform], objects: &mut [Object]) {
    for moved in moves {
        objects[moved.index as usize] = moved.object;
    }
}
