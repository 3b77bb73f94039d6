//! The oracle in plain Rust: its definition.

use shaders::types::FlareBlock;

/// Pixels of a light's block that a depth buffer leaves visible: those of which nothing is nearer than the light. Depths are reversed, a row
/// after the other, as wide as the picture. Twin of `flares/count_block`.
pub fn count_block(depth: &[f32], block: &FlareBlock) -> u32 {
    let rows = block.from_px[1]..block.to_px[1];
    let row = |y: u32| (block.from_px[0]..block.to_px[0]).map(move |x| depth[(y * block.size_px[0] + x) as usize]);
    rows.flat_map(row).filter(|kept| block.depth >= *kept).count() as u32
}

/// The same of a picture that shows each of four samples, twice as wide and high. Twin of `flares/count_samples`.
pub fn count_samples(depth: &[f32], block: &FlareBlock) -> u32 {
    let twice = |corner: [u32; 2]| corner.map(|side| 2 * side);
    let [from_px, to_px, size_px] = [block.from_px, block.to_px, block.size_px].map(twice);
    count_block(depth, &FlareBlock { from_px, to_px, size_px, ..*block })
}
