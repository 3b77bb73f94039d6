//! The hierarchical-Z stages in plain Rust: their definition.

use super::fronts::Fronts;
use crate::frustum::twin::{clip_from_bounds, farthest_along, grid_px, left_out, ClipBox};
use glam::{Vec2, Vec4};
use shaders::types::{
    Bounds, CullView, PyramidLevel, BLOCK_OBJECTS, DEPTH_SLACK_PER_PIXEL, FRONT_TEXELS, OBJECT_ALWAYS_KEPT,
    OBJECT_WIDE_RASTER, REDUCED_LEVELS, ROUNDING,
};

/// The farthest (smallest) of the source's texels under each texel of the next level.
fn reduce_once(source: &[f32], size: [u32; 2]) -> Vec<f32> {
    let [width, height] = size.map(|side| side.div_ceil(2));
    let farthest = |x: u32, y: u32| {
        let mut farthest = f32::INFINITY;
        for (source_x, source_y) in [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| (2 * x + dx, 2 * y + dy)) {
            if source_x < size[0] && source_y < size[1] {
                farthest = farthest.min(source[(source_y * size[0] + source_x) as usize]);
            }
        }
        farthest
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| farthest(x, y)).collect()
}

fn reduce_three(source: &[f32], mut size: [u32; 2]) -> Vec<f32> {
    let mut all = Vec::new();
    let mut level = source.to_vec();
    for _ in 0..REDUCED_LEVELS {
        level = reduce_once(&level, size);
        size = size.map(|side| side.div_ceil(2));
        all.extend_from_slice(&level);
    }
    all
}

/// The first three levels of the pyramid, one behind the other. Twin of `hzb/reduce_depth`.
pub fn reduce_depth(depth: &[f32], size: [u32; 2]) -> Vec<f32> {
    reduce_three(depth, size)
}

/// The three levels after `source_level`, one behind the other. Twin of `hzb/reduce_levels`.
pub fn reduce_levels(pyramid: &[f32], levels: &[PyramidLevel], source_level: u32) -> Vec<f32> {
    let PyramidLevel { first, width, height } = levels[source_level as usize];
    reduce_three(&pyramid[first as usize..(first + width * height) as usize], [width, height])
}

/// The whole pyramid of a depth buffer, by `levels` as the layout gives them.
pub fn pyramid(depth: &[f32], size: [u32; 2], levels: &[PyramidLevel]) -> Vec<f32> {
    let mut all = reduce_depth(depth, size);
    for source_level in (REDUCED_LEVELS..levels.len() as u32 - 1).step_by(REDUCED_LEVELS as usize) {
        all.extend(reduce_levels(&all, levels, source_level));
    }
    all
}

/// Where a box lies on the screen and how near it can be. Twin of `Footprint`.
#[derive(Clone, Copy, Debug)]
pub struct Footprint {
    /// It reaches in front of the near plane or behind the eye; nothing else is valid.
    pub crosses_near: bool,
    /// It covers no pixel centre.
    pub empty: bool,
    /// First pixel.
    pub first: [u32; 2],
    /// Last pixel.
    pub last: [u32; 2],
    /// Depth that nothing in the box exceeds.
    pub nearest: f32,
}

/// Twin of `footprint_of`; see `include/footprint.glsl` for the derivation.
pub fn footprint_of(clip: &ClipBox, view: &CullView, flags: u32) -> Footprint {
    let crosses_near = farthest_along(clip, Vec4::new(0.0, 0.0, 1.0, -1.0)) > 0.0
        || farthest_along(clip, Vec4::new(0.0, 0.0, 0.0, -1.0)) >= 0.0;
    let (mut low, mut high) = (Vec2::splat(3.0e38), Vec2::splat(-3.0e38));
    let (mut nearest, mut farthest) = (0.0f32, 1.0f32);
    let error = clip.error;
    for corner in 0..8 {
        let side = |axis: usize| if corner >> axis & 1 == 1 { clip.axes[axis] } else { -clip.axes[axis] };
        let position = clip.centre + side(0) + side(1) + side(2);
        let w_low = position.w - error.w;
        let projected = Vec2::new(position.x, position.y) / position.w;
        let slack = (Vec2::new(error.x, error.y) + projected.abs() * error.w) / w_low + ROUNDING * projected.abs();
        low = low.min(projected - slack);
        high = high.max(projected + slack);
        nearest = nearest.max((position.z + error.z) / w_low * (1.0 + ROUNDING));
        farthest = farthest.min(position.z / position.w);
    }
    let size = Vec2::new(view.width_px as f32, view.height_px as f32);
    let wide = if flags & OBJECT_WIDE_RASTER != 0 { 1.0 } else { 0.0 };
    let grow = view.snap_px + wide;
    let pad = Vec2::splat(grow) + ROUNDING * size;
    let first = ((low * 0.5 + 0.5) * size - pad - 0.5).ceil();
    let last = ((high * 0.5 + 0.5) * size + pad - 0.5).floor();
    let inside = |pixel: Vec2| pixel.clamp(Vec2::ZERO, size - 1.0).as_uvec2().to_array();
    Footprint {
        crosses_near,
        empty: first.cmpgt(last).any() || last.cmplt(Vec2::ZERO).any() || first.cmpge(size).any(),
        first: inside(first),
        last: inside(last),
        nearest: (nearest + (nearest - farthest.min(nearest)) * DEPTH_SLACK_PER_PIXEL * (grid_px(view) + wide))
            .min(1.0),
    }
}

/// The pyramid and how it is tested.
#[derive(Clone, Copy, Debug)]
pub struct PyramidTest<'a> {
    /// Where each level lies.
    pub levels: &'a [PyramidLevel],
    /// All texels.
    pub texels: &'a [f32],
    /// The level that has a single texel.
    pub coarsest_level: u32,
    /// Texels that a footprint may touch in each direction.
    pub footprint_texels: u32,
    /// The level that tests begin at.
    pub finest_level: u32,
}

impl PyramidTest<'_> {
    /// Twin of `hidden_by_pyramid`.
    pub fn hides(&self, footprint: &Footprint) -> bool {
        let mut level = self.finest_level;
        let wide = |level: u32| {
            (0..2)
                .any(|axis| (footprint.last[axis] >> level) - (footprint.first[axis] >> level) >= self.footprint_texels)
        };
        while level < self.coarsest_level && wide(level) {
            level += 1;
        }
        let PyramidLevel { first, width, .. } = self.levels[level as usize];
        let span = |axis: usize| footprint.first[axis] >> level..=footprint.last[axis] >> level;
        span(1).all(|y| span(0).all(|x| footprint.nearest < self.texels[(first + y * width + x) as usize]))
    }

    /// Twin of `hidden_by_fronts`.
    pub fn hides_by_fronts(&self, bounds: &Bounds, view: &CullView) -> bool {
        let clip = clip_from_bounds(bounds, view);
        let footprint = footprint_of(&clip, view, bounds.flags);
        if footprint.crosses_near {
            return false;
        }
        let Footprint { first, last, .. } = footprint;
        let span = |axis: usize, level: u32| (first[axis] >> level)..=(last[axis] >> level);
        let texels = |level: u32| span(0, level).count() * span(1, level).count();
        let mut level = self.finest_level;
        while level < self.coarsest_level && texels(level) > FRONT_TEXELS as usize {
            level += 1;
        }
        let fronts = Fronts::of(&clip, [first, last], footprint.nearest, view, bounds.flags);
        let PyramidLevel { first: base, width, .. } = self.levels[level as usize];
        span(1, level).all(|y| {
            span(0, level).all(|x| {
                let from = [(x << level).max(first[0]), (y << level).max(first[1])];
                let to = [(((x + 1) << level) - 1).min(last[0]), (((y + 1) << level) - 1).min(last[1])];
                fronts.nearest_between(from, to) < self.texels[(base + y * width + x) as usize]
            })
        })
    }
}

/// True if a box may show. Twin of `is_visible`.
pub fn is_visible(bounds: &Bounds, view: &CullView, pyramid: &PyramidTest<'_>) -> bool {
    if bounds.flags & OBJECT_ALWAYS_KEPT != 0 {
        return true;
    }
    let clip = clip_from_bounds(bounds, view);
    if left_out(&clip, bounds.flags, view) {
        return false;
    }
    let footprint = footprint_of(&clip, view, bounds.flags);
    footprint.crosses_near || (!footprint.empty && !pyramid.hides(&footprint))
}

/// Updates `seen` and returns which objects are newly visible. `blocks`: those that are in view. Twin of
/// `hzb/test_bounds`.
pub fn test_bounds(
    (bounds, blocks): (&[Bounds], &[u32]),
    view: &CullView,
    pyramid: &PyramidTest<'_>,
    seen: &mut [u32],
) -> Vec<u32> {
    let mut newly = Vec::with_capacity(bounds.len());
    for (object, (bound, seen)) in bounds.iter().zip(seen).enumerate() {
        let visible = blocks.contains(&(object as u32 / BLOCK_OBJECTS)) && is_visible(bound, view, pyramid);
        newly.push(u32::from(visible && *seen == 0));
        *seen = u32::from(visible);
    }
    newly
}
