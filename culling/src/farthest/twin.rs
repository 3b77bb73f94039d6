//! The stages of farthest-depth maps in plain Rust: their definition.

use crate::frustum::twin::clip_from_bounds;
use crate::hzb::twin::{footprint_of, reduce_levels};
use shaders::types::{Bounds, CullView, FarthestShape, PyramidLevel, OBJECT_ALWAYS_KEPT, REDUCED_LEVELS};

/// The farthest depth of the pixels under each texel of a base that has a texel for 2^`reduction` pixels a side. Twin of
/// `farthest/fill_from_depth`.
pub fn fill_from_depth(depth: &[f32], size_px: [u32; 2], reduction: u32) -> Vec<f32> {
    let [width, height] = size_px.map(|side| side.div_ceil(1 << reduction));
    let mut base = vec![f32::INFINITY; (width * height) as usize];
    for (pixel, depth) in (0..).zip(depth) {
        let (x, y) = ((pixel % size_px[0]) >> reduction, (pixel / size_px[0]) >> reduction);
        let texel = &mut base[(y * width + x) as usize];
        *texel = texel.min(*depth);
    }
    base
}

/// The farthest of the four squares of `source` that tile each square of `doubled`. Twin of `farthest/double_squares`.
pub fn double_squares(texels: &[f32], source: PyramidLevel, doubled: PyramidLevel, side: u32) -> Vec<f32> {
    let at = |x: u32, y: u32| texels[(source.first + y * source.width + x) as usize];
    let farthest = |x: u32, y: u32| at(x, y).min(at(x + side, y)).min(at(x, y + side)).min(at(x + side, y + side));
    (0..doubled.height).flat_map(|y| (0..doubled.width).map(move |x| (x, y))).map(|(x, y)| farthest(x, y)).collect()
}

/// A farthest-depth map.
#[derive(Clone, Debug)]
pub struct Map {
    /// Where each level lies.
    pub levels: Vec<PyramidLevel>,
    /// What it consists of.
    pub shape: FarthestShape,
    /// All texels.
    pub texels: Vec<f32>,
}

impl Map {
    /// The whole map over a base, by levels and shape as [`layout`](super::layout) gives them.
    pub fn over(base: &[f32], (levels, shape): (Vec<PyramidLevel>, FarthestShape)) -> Map {
        let mut texels = base.to_vec();
        for source_level in (0..shape.mip_levels).step_by(REDUCED_LEVELS as usize) {
            let made = reduce_levels(&texels, &levels, source_level);
            // A reduction makes three levels, of which the map may have no more than the first.
            let wanted = &levels[source_level as usize + 1..=(source_level + REDUCED_LEVELS) as usize];
            texels.extend(&made[..wanted.iter().map(|level| (level.width * level.height) as usize).sum()]);
        }
        let mut source = levels[shape.mip_levels as usize];
        for (n, doubled) in levels[shape.squares_after as usize + 1..].iter().enumerate() {
            texels.extend(double_squares(&texels, source, *doubled, 1 << n));
            source = *doubled;
        }
        Map { levels, shape, texels }
    }

    /// The farthest depth from the first to the last pixel. Twin of `farthest_within`.
    pub fn farthest_within(&self, first_px: [u32; 2], last_px: [u32; 2]) -> f32 {
        let level_within = |first: [u32; 2], last: [u32; 2]| (0..2).map(|i| (last[i] - first[i] + 1).ilog2()).min();
        let FarthestShape { reduction, mip_levels, squares_after, coarsest_square } = self.shape;
        let (first, last) = (first_px.map(|side| side >> reduction), last_px.map(|side| side >> reduction));
        let mip = level_within(first, last).unwrap_or(0).min(mip_levels);
        let (first, last) = (first.map(|side| side >> mip), last.map(|side| side >> mip));
        let square = if mip < mip_levels { 0 } else { level_within(first, last).unwrap_or(0).min(coarsest_square) };
        let level = self.levels[if square == 0 { mip } else { squares_after + square } as usize];
        let side = 1 << square;
        // Where squares begin: side by side, the last moved back to end with the region.
        let begins =
            |i: usize| (first[i]..=last[i]).step_by(side).map(move |begin| begin.min(last[i] + 1 - side as u32));
        let texel = |x: u32, y: u32| self.texels[(level.first + y * level.width + x) as usize];
        begins(1).flat_map(|y| begins(0).map(move |x| texel(x, y))).fold(1.0, f32::min)
    }

    /// True if a box in the view volume may show. Twin of `is_visible`.
    pub fn shows(&self, bounds: &Bounds, view: &CullView) -> bool {
        if bounds.flags & OBJECT_ALWAYS_KEPT != 0 {
            return true;
        }
        let footprint = footprint_of(&clip_from_bounds(bounds, view), view, bounds.flags);
        let behind = || footprint.nearest < self.farthest_within(footprint.first, footprint.last);
        footprint.crosses_near || (!footprint.empty && !behind())
    }
}

/// Which of the objects that were kept show: 1 or 0 each. Twin of `farthest/test_bounds`.
pub fn test_bounds(bounds: &[Bounds], kept: &[u32], view: &CullView, map: &Map) -> Vec<u32> {
    bounds.iter().zip(kept).map(|(bounds, kept)| u32::from(*kept != 0 && map.shows(bounds, view))).collect()
}
