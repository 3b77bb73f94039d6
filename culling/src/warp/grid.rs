//! What the twins of warping share: pictures as rows of values, and bounds of motion.

use shaders::types::MotionBound;

/// A picture of `size`, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a, T> {
    /// Width and height.
    pub size: [u32; 2],
    /// `width * height` values.
    pub values: &'a [T],
}

impl<T: Copy> Grid<'_, T> {
    pub(super) fn at(&self, x: u32, y: u32) -> T {
        self.values[(y * self.size[0] + x) as usize]
    }
}

/// Bound of nothing.
pub const NO_MOTION: MotionBound = MotionBound { low: [3.0e38; 2], high: [-3.0e38; 2] };

pub(super) fn union_of(a: MotionBound, b: MotionBound) -> MotionBound {
    MotionBound {
        low: std::array::from_fn(|axis| a.low[axis].min(b.low[axis])),
        high: std::array::from_fn(|axis| a.high[axis].max(b.high[axis])),
    }
}
