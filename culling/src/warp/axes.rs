//! The axes of motion bounds in plain Rust: the definition of `warp/orient_axes` and of turning to them.

use super::grid::{union_of, Grid, NO_MOTION};
use shaders::types::{MotionBound, TexelMotion, DEPTH_FAR};

/// A motion by its parts along an axis and across it. Twin of `turned_to`.
pub fn turned_to([x, y]: [f32; 2], axis: [f32; 2]) -> [f32; 2] {
    [axis[0] * x + axis[1] * y, axis[0] * y - axis[1] * x]
}

/// The motion from its parts. Twin of `turned_back`.
pub fn turned_back([along, across]: [f32; 2], axis: [f32; 2]) -> [f32; 2] {
    [axis[0] * along - axis[1] * across, axis[0] * across + axis[1] * along]
}

/// Samples of motion a side of the picture.
const SAMPLED_SIDE: u32 = 8;

/// The axis along which some motions, and what is across, are bounded best. Twin of `warp/orient_axes`.
pub fn orient_axes(motions: Grid<'_, TexelMotion>) -> [f32; 2] {
    let place = |part: u32, side: usize| (2 * part + 1) * motions.size[side] / (2 * SAMPLED_SIDE);
    let parts = (0..SAMPLED_SIDE).flat_map(|y| (0..SAMPLED_SIDE).map(move |x| (x, y)));
    let sampled = parts.map(|(x, y)| motions.at(place(x, 0), place(y, 1)));
    let offsets: Vec<[f32; 2]> =
        sampled.filter(|motion| motion.depth > DEPTH_FAR).map(|motion| motion.offset).collect();
    let axis = principal_axis(&offsets);
    if bounded_area(&offsets, axis) < bounded_area(&offsets, [1.0, 0.0]) {
        axis
    } else {
        [1.0, 0.0]
    }
}

fn bounded_area(offsets: &[[f32; 2]], axis: [f32; 2]) -> f32 {
    let own = |offset: &[f32; 2]| MotionBound { low: turned_to(*offset, axis), high: turned_to(*offset, axis) };
    let bound = offsets.iter().map(own).fold(NO_MOTION, union_of);
    (bound.high[0] - bound.low[0]) * (bound.high[1] - bound.low[1])
}

fn principal_axis(offsets: &[[f32; 2]]) -> [f32; 2] {
    let count = offsets.len() as f32;
    let sum = |of: &dyn Fn(&[f32; 2]) -> f32| offsets.iter().map(of).fold(0.0f32, |sum, part| sum + part);
    let mean = [0, 1].map(|side| sum(&|offset| offset[side]) / count.max(1.0));
    let covariance = |a: usize, b: usize| sum(&|offset| offset[a] * offset[b]) - count * (mean[a] * mean[b]);
    let (difference, mixed) = (0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
    let radius = (difference * difference + mixed * mixed).sqrt();
    let axis = if difference >= 0.0 { [difference + radius, mixed] } else { [mixed, radius - difference] };
    let length_squared = axis[0] * axis[0] + axis[1] * axis[1];
    if length_squared > 0.0 && length_squared < 3.0e38 {
        axis.map(|part| part / length_squared.sqrt())
    } else {
        [1.0, 0.0]
    }
}
