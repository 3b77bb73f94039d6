//! The search of warped depth, plainly.

use super::{has_motion, Grid, LastDepth};
use crate::warp::axes::turned_back;
use glam::{IVec2, Mat4, UVec2, Vec2};
use shaders::types::{MotionBound, TexelMotion, DEPTH_FAR, DEPTH_HOLE, WARP_CRACK};

/// The motions and how they are searched.
#[derive(Clone, Copy, Debug)]
pub struct Search<'a> {
    /// By texel.
    pub motions: Grid<'a, TexelMotion>,
    /// By tile.
    pub bounds: &'a [MotionBound],
    /// Seeds a texel.
    pub seeds: u32,
    /// Iterations a seed.
    pub iterations: u32,
    /// How close a source must come, in texels.
    pub threshold: f32,
    /// Texels of a tile's side.
    pub tile: u32,
    /// A bound no wider than this, in texels, is sampled once.
    pub narrow: f32,
    /// Holes get the nearest depth at the extremes of the bound.
    pub fill: bool,
    /// Along what the bounds lie.
    pub axis: [f32; 2],
}

impl Search<'_> {
    fn inside(&self, place: Vec2) -> Vec2 {
        place.clamp(Vec2::splat(0.5), UVec2::from(self.motions.size).as_vec2() - 0.5)
    }

    fn motion_at(&self, place: Vec2) -> TexelMotion {
        self.motions.at(place.x as u32, place.y as u32)
    }

    fn fixed_point_search(&self, p: Vec2, seed: Vec2, last: Option<&LastDepth<'_>>) -> f32 {
        let mut place = self.inside(p - seed);
        let mut motion = self.motion_at(place);
        let mut iteration = 1;
        while motion.depth > DEPTH_FAR {
            let source = p - Vec2::from(motion.offset);
            let miss = place - source;
            let distance_squared = miss.x * miss.x + miss.y * miss.y;
            let spent = iteration >= self.iterations;
            if distance_squared < self.threshold * self.threshold
                || (spent && distance_squared < WARP_CRACK * WARP_CRACK)
            {
                return last.map_or(motion.depth, |last| farthest_around(last, source, motion.depth));
            }
            if spent {
                return DEPTH_HOLE;
            }
            place = self.inside(source);
            motion = self.motion_at(place);
            iteration += 1;
        }
        DEPTH_FAR
    }

    fn fill_hole(&self, p: Vec2, bound: &MotionBound) -> f32 {
        let [low, high] = [bound.low, bound.high];
        let extremes = [low, [low[0], high[1]], high, [high[0], low[1]]];
        let depth = |parts: [f32; 2]| self.motion_at(self.inside(p - Vec2::from(turned_back(parts, self.axis)))).depth;
        extremes.map(depth).into_iter().fold(0.0, f32::max)
    }

    fn warped_depth(&self, texel: UVec2, last: Option<&LastDepth<'_>>) -> f32 {
        let across = self.motions.size[0].div_ceil(self.tile);
        let bound = &self.bounds[(texel.y / self.tile * across + texel.x / self.tile) as usize];
        if !has_motion(bound) {
            return DEPTH_FAR;
        }
        let p = texel.as_vec2() + 0.5;
        let extent = Vec2::from(bound.high) - Vec2::from(bound.low);
        let seeds = if extent.cmple(Vec2::splat(self.narrow)).all() { 1 } else { self.seeds };
        let nearest = (0..seeds)
            .map(|index| Vec2::from(bound.low) + extent * stratified(index, seeds))
            .map(|parts| self.fixed_point_search(p, turned_back(parts.to_array(), self.axis).into(), last))
            .fold(DEPTH_HOLE, f32::max);
        if self.fill && nearest == DEPTH_HOLE {
            self.fill_hole(p, bound)
        } else {
            nearest
        }
    }
}

/// The new depth of the farthest pixel that a texel's square around `source` touches, or `found`. Twin of `farthest_around`.
fn farthest_around(last: &LastDepth<'_>, source: Vec2, found: f32) -> f32 {
    let (side, margin) = (last.reduction as f32, last.margin as f32);
    let most = UVec2::from(last.depth.size) - 1;
    let low = ((source - 0.5) * side - margin).floor().as_ivec2().max(IVec2::ZERO).as_uvec2().min(most);
    let high = (((source + 0.5) * side + margin).ceil().as_ivec2() - 1).max(IVec2::ZERO).as_uvec2().min(most);
    let pixels = (low.y..=high.y).flat_map(|y| (low.x..=high.x).map(move |x| UVec2::new(x, y)));
    let depth_at = |pixel: &UVec2| last.depth.at(pixel.x, pixel.y);
    let farthest = pixels.reduce(|a, b| if depth_at(&b) < depth_at(&a) { b } else { a }).unwrap_or(low);
    match depth_at(&farthest) {
        DEPTH_FAR => DEPTH_FAR,
        here => new_depth(last, farthest, here).min(found),
    }
}

fn new_depth(last: &LastDepth<'_>, pixel: UVec2, here: f32) -> f32 {
    let m = Mat4::from_cols_array_2d(&last.reprojection_at(pixel.x, pixel.y).clip_from_last);
    let place = (pixel.as_vec2() + 0.5) * (2.0 / UVec2::from(last.depth.size).as_vec2()) - 1.0;
    let clip = m.x_axis * place.x + m.y_axis * place.y + m.z_axis * here + m.w_axis;
    let depth = clip.z / clip.w;
    if clip.w > 0.0 && depth > DEPTH_FAR && depth <= 1.0 {
        depth
    } else {
        DEPTH_FAR
    }
}

/// Point `index` of `count` in the unit square. Twin of `stratified`.
fn stratified(index: u32, count: u32) -> Vec2 {
    let down = index.reverse_bits() as f32 / 4_294_967_296.0;
    Vec2::new((index as f32 + 0.5) / count as f32, down + 0.5 / count as f32).min(Vec2::ONE)
}

/// The depth that the new view will have at each texel; with the last depth, the farthest of what it covers there counts.
/// Twin of `warp/search_depth`.
pub fn search_depth(how: &Search<'_>, last: Option<&LastDepth<'_>>) -> Vec<f32> {
    let [width, height] = how.motions.size;
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| UVec2::new(x, y)));
    texels.map(|texel| how.warped_depth(texel, last)).collect()
}
