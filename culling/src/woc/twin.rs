//! The stages of warping-based occlusion culling in plain Rust: their definition.

/// 1 for each object that is among `objects` and not among `excluded`. Twin of `woc/exclude_objects`.
pub fn exclude_objects(objects: &[u32], excluded: &[u32]) -> Vec<u32> {
    objects.iter().zip(excluded).map(|(object, excluded)| u32::from(*object != 0 && *excluded == 0)).collect()
}
