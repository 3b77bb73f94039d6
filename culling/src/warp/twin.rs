//! The stages of depth warping in plain Rust: their definition. The axes of bounds are in [`axes`](super::axes).

mod search;

pub use search::{search_depth, Search};

pub use super::grid::{Grid, NO_MOTION};

use super::axes::{turned_back, turned_to};
use super::grid::union_of;
use glam::{Mat4, UVec2, Vec2, Vec4};
use shaders::types::{
    MotionBound, PyramidLevel, Reprojection, TexelMotion, DEPTH_FAR, DEPTH_HOLE, REDUCED_LEVELS, WARP_REACH,
};

const NOWHERE: TexelMotion = TexelMotion { offset: [0.0; 2], depth: DEPTH_FAR };

/// The last frame's depth by pixel, and where each pixel went.
pub struct LastDepth<'a> {
    /// By pixel.
    pub depth: Grid<'a, f32>,
    /// That of a pixel's object.
    pub reprojection: &'a dyn Fn(usize) -> &'a Reprojection,
    /// Pixels of a texel's side.
    pub reduction: u32,
    /// Pixels around a footprint that count too.
    pub margin: u32,
}

impl LastDepth<'_> {
    fn reprojection_at(&self, x: u32, y: u32) -> &Reprojection {
        (self.reprojection)((y * self.depth.size[0] + x) as usize)
    }
}

/// Where each texel goes: its farthest pixel, or its `middle` one. Twin of `warp/measure_motion`.
pub fn measure_motion(last: &LastDepth<'_>, fastest: f32, middle: bool) -> Vec<TexelMotion> {
    let LastDepth { depth, reduction, .. } = *last;
    let [width, height] = depth.size.map(|side| side.div_ceil(reduction));
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let middle_of = |first: u32, axis: usize| (first * reduction + reduction / 2).min(depth.size[axis] - 1);
    texels
        .map(|(x, y)| {
            let (px, py) =
                if middle { (middle_of(x, 0), middle_of(y, 1)) } else { farthest_pixel(&depth, reduction, x, y) };
            let here = depth.at(px, py);
            if here > DEPTH_FAR {
                moved(last.reprojection_at(px, py), [px, py], depth.size, here, reduction, fastest)
            } else {
                NOWHERE
            }
        })
        .collect()
}

fn farthest_pixel(depth: &Grid<'_, f32>, reduction: u32, x: u32, y: u32) -> (u32, u32) {
    let (first_x, first_y) = (x * reduction, y * reduction);
    let mut farthest = (first_x, first_y);
    for y in first_y..(first_y + reduction).min(depth.size[1]) {
        for x in first_x..(first_x + reduction).min(depth.size[0]) {
            if depth.at(x, y) < depth.at(farthest.0, farthest.1) {
                farthest = (x, y);
            }
        }
    }
    farthest
}

fn moved(
    reprojection: &Reprojection,
    pixel: [u32; 2],
    size: [u32; 2],
    here: f32,
    reduction: u32,
    fastest: f32,
) -> TexelMotion {
    let m = Mat4::from_cols_array_2d(&reprojection.clip_from_last);
    let size = UVec2::from(size).as_vec2();
    let place = (UVec2::from(pixel).as_vec2() + 0.5) * (2.0 / size) - 1.0;
    let clip: Vec4 = m.x_axis * place.x + m.y_axis * place.y + m.z_axis * here + m.w_axis;
    let over_w = 1.0 / clip.w;
    let way = Vec2::new(clip.x, clip.y) * over_w - place;
    let offset = way * (0.5 * size / reduction as f32);
    let depth = clip.z * over_w;
    let far_squared = way.x * way.x + way.y * way.y + (depth - here) * (depth - here);
    let shows = clip.w > 0.0 && depth > DEPTH_FAR && depth <= 1.0 && offset.abs().cmplt(Vec2::splat(3.0e38)).all();
    if shows && (fastest == 0.0 || far_squared <= fastest * fastest) {
        TexelMotion { offset: offset.to_array(), depth }
    } else {
        NOWHERE
    }
}

/// True unless the bound is empty.
pub fn has_motion(bound: &MotionBound) -> bool {
    (0..2).all(|axis| bound.low[axis] <= bound.high[axis])
}

fn common_to(a: MotionBound, b: MotionBound) -> MotionBound {
    MotionBound {
        low: std::array::from_fn(|axis| a.low[axis].max(b.low[axis])),
        high: std::array::from_fn(|axis| a.high[axis].min(b.high[axis])),
    }
}

/// A texel's own motion as a bound; empty if nothing is there or if it leaves the picture. Twin of `bound_of`.
pub fn bound_of(motion: &TexelMotion, texel: [u32; 2], texels: [u32; 2], axis: [f32; 2]) -> MotionBound {
    let end = |axis: usize| texel[axis] as f32 + 0.5 + motion.offset[axis];
    let inside = |axis: usize| end(axis) >= -WARP_REACH && end(axis) <= texels[axis] as f32 + WARP_REACH;
    if motion.depth > DEPTH_FAR && inside(0) && inside(1) {
        let parts = turned_to(motion.offset, axis);
        MotionBound { low: parts, high: parts }
    } else {
        NO_MOTION
    }
}

fn bound_once(source: Grid<'_, MotionBound>) -> Vec<MotionBound> {
    let [width, height] = source.size.map(|side| side.div_ceil(2));
    let bound = |x: u32, y: u32| {
        let cells = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| (2 * x + dx, 2 * y + dy));
        let inside = cells.into_iter().filter(|(x, y)| *x < source.size[0] && *y < source.size[1]);
        inside.map(|(x, y)| source.at(x, y)).fold(NO_MOTION, union_of)
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| bound(x, y)).collect()
}

fn bound_three(source: &[MotionBound], mut size: [u32; 2]) -> Vec<MotionBound> {
    let (mut all, mut level) = (Vec::new(), source.to_vec());
    for _ in 0..REDUCED_LEVELS {
        level = bound_once(Grid { size, values: &level });
        size = size.map(|side| side.div_ceil(2));
        all.extend_from_slice(&level);
    }
    all
}

/// The first three levels of the motion pyramid, one behind the other. Twin of `warp/bound_motion`.
pub fn bound_motion(motions: Grid<'_, TexelMotion>, axis: [f32; 2]) -> Vec<MotionBound> {
    let width = motions.size[0];
    let texel = |index: usize| [index as u32 % width, index as u32 / width];
    let own = |(index, motion): (usize, &TexelMotion)| bound_of(motion, texel(index), motions.size, axis);
    let bounds: Vec<MotionBound> = motions.values.iter().enumerate().map(own).collect();
    bound_three(&bounds, motions.size)
}

/// The three levels after `source_level`, one behind the other. Twin of `warp/bound_levels`.
pub fn bound_levels(pyramid: &[MotionBound], levels: &[PyramidLevel], source_level: u32) -> Vec<MotionBound> {
    let PyramidLevel { first, width, height } = levels[source_level as usize];
    bound_three(&pyramid[first as usize..(first + width * height) as usize], [width, height])
}

/// The whole motion pyramid, by `levels` as the layout gives them.
pub fn pyramid(motions: Grid<'_, TexelMotion>, levels: &[PyramidLevel], axis: [f32; 2]) -> Vec<MotionBound> {
    let mut all = bound_motion(motions, axis);
    for source_level in (REDUCED_LEVELS..levels.len() as u32 - 1).step_by(REDUCED_LEVELS as usize) {
        all.extend(bound_levels(&all, levels, source_level));
    }
    all
}

/// The motion pyramid and how it is asked.
#[derive(Clone, Copy, Debug)]
pub struct Tightening<'a> {
    /// Where each level lies.
    pub levels: &'a [PyramidLevel],
    /// All bounds.
    pub pyramid: &'a [MotionBound],
    /// The level that has a single texel.
    pub coarsest_level: u32,
    /// Width and height in texels.
    pub texels: [u32; 2],
    /// Steps.
    pub steps: u32,
    /// Texels of a tile's side.
    pub tile: u32,
    /// Keep the last bound where nothing moves to the tile.
    pub keep_last: bool,
    /// Along what the bounds lie.
    pub axis: [f32; 2],
    /// Texels that a bound may touch in each direction, > 1.
    pub lookups: u32,
}

impl Tightening<'_> {
    /// The bound of all motions that start between two places, in texels. Twin of `local_bound`.
    pub fn local_bound(&self, low: Vec2, high: Vec2) -> MotionBound {
        let size = UVec2::from(self.texels).as_vec2();
        if high.cmplt(Vec2::ZERO).any() || low.cmpge(size).any() {
            return NO_MOTION;
        }
        let first = low.floor().clamp(Vec2::ZERO, size - 1.0).as_uvec2();
        let last = high.floor().clamp(Vec2::ZERO, size - 1.0).as_uvec2();
        let level = self.level_for((last - first).max_element());
        let PyramidLevel { first: start, width, .. } = self.levels[level as usize];
        let (first, last) = (first >> level, last >> level);
        let bound = |x: u32, y: u32| self.pyramid[(start + y * width + x) as usize];
        let texels = (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| (x, y)));
        texels.map(|(x, y)| bound(x, y)).fold(NO_MOTION, union_of)
    }

    /// The finest level at which texels `widest` apart are no more than `lookups` - 1 apart.
    fn level_for(&self, widest: u32) -> u32 {
        let reaches = |level: &u32| (self.lookups - 1) << level >= widest;
        (1..self.coarsest_level).find(reaches).unwrap_or(self.coarsest_level)
    }

    /// The bound along x and y of what lies in a bound along the axis and across it. Twin of `upright`.
    pub fn upright(&self, bound: &MotionBound) -> MotionBound {
        const WIDER: f32 = 8.0 / 16_777_216.0;
        if self.axis == [1.0, 0.0] {
            return *bound;
        }
        let both = |of: &dyn Fn(usize) -> f32| [of(0), of(1)];
        let middle = turned_back(both(&|side| 0.5 * (bound.low[side] + bound.high[side])), self.axis);
        let arm = both(&|side| 0.5 * (bound.high[side] - bound.low[side]));
        let [along, across] = self.axis.map(f32::abs);
        let reach = [along * arm[0] + across * arm[1], across * arm[0] + along * arm[1]];
        let wider = both(&|side| {
            let other = 1 - side;
            reach[side] + WIDER * (middle[side].abs() + reach[side] + middle[other].abs().max(reach[other]))
        });
        MotionBound { low: both(&|side| middle[side] - wider[side]), high: both(&|side| middle[side] + wider[side]) }
    }
}

/// Which motions can bring a texel to each tile. Twin of `warp/tighten_bounds`.
pub fn tighten_bounds(how: &Tightening<'_>) -> Vec<MotionBound> {
    let [across, down] = how.texels.map(|side| side.div_ceil(how.tile));
    let tiles = (0..down).flat_map(|y| (0..across).map(move |x| UVec2::new(x, y)));
    tiles
        .map(|tile| {
            let first = tile * how.tile;
            let last = (first + how.tile).min(UVec2::from(how.texels)) - 1;
            let mut bound = how.pyramid[how.levels[how.coarsest_level as usize].first as usize];
            for _ in 0..how.steps {
                if !has_motion(&bound) {
                    break;
                }
                let moved = how.upright(&bound);
                let low = first.as_vec2() + 0.5 - Vec2::from(moved.high) - WARP_REACH;
                let high = last.as_vec2() + 0.5 - Vec2::from(moved.low) + WARP_REACH;
                let tighter = common_to(bound, how.local_bound(low, high));
                if how.keep_last && !has_motion(&tighter) {
                    break;
                }
                bound = tighter;
            }
            bound
        })
        .collect()
}

/// What a warped depth is given by its neighbours: eroded, its holes closed, or both. Then `drawn`, by texel, counts where it
/// is nearer. Twin of `warp/erode_depth`.
pub fn erode_depth(warped: Grid<'_, f32>, erode: bool, close: bool, drawn: Option<&[f32]>) -> Vec<f32> {
    let [width, height] = warped.size;
    let counts = |depth: &f32| !close || *depth != DEPTH_HOLE;
    let refined = |x: u32, y: u32| {
        let own = warped.at(x, y);
        if !erode && counts(&own) {
            return own;
        }
        let rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
        let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
        let around = rows.flat_map(|y| columns.clone().map(move |x| warped.at(x, y)));
        around.filter(counts).reduce(f32::min).unwrap_or(DEPTH_HOLE)
    };
    let merged = |x: u32, y: u32| {
        let drawn = drawn.map_or(DEPTH_HOLE, |drawn| drawn[(y * width + x) as usize]);
        refined(x, y).max(drawn)
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| merged(x, y)).collect()
}
