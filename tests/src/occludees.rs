//! Boxes by chance that a depth by chance hides or just does not: what occlusion tests are compared with their twins on.

use crate::Random;
use culling::View;
use scenes::Shot;
use shaders::types::{Bounds, CullView};

/// One rounding of f32.
const U: f32 = 1.0 / 16_777_216.0;

/// Boxes before and behind a depth buffer.
#[derive(Clone, Debug)]
pub struct Occludees {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// The boxes.
    pub bounds: Vec<Bounds>,
    /// A slope with holes, row by row.
    pub depth: Vec<f32>,
    /// The view.
    pub view: CullView,
}

impl Occludees {
    /// `count` boxes that the camera sees, of a hundredth of a pixel to half the picture, some about as near as what hides
    /// them.
    pub fn by_chance(random: &mut Random, shot: &Shot, size: [u32; 2], snap_px: f32, count: usize) -> Self {
        let view = View::new(shot, size, 0, snap_px);
        let relative_from_clip = view.clip_from_relative().inverse();
        let (surface, slope) = (random.decade(1e-4, 0.9), random.range(0.0, 0.5));
        let depth_at = |x: f64| surface * (1.0 + slope * x) / (1.0 + slope);
        let holes = random.below(30) + 2;
        let pixels = size[0] as usize * size[1] as usize;
        let depth = |pixel: usize| {
            if pixel % 1009 < holes {
                0.0
            } else {
                depth_at((pixel % size[0] as usize) as f64 / f64::from(size[0])) as f32
            }
        };
        let bound = |random: &mut Random| {
            let (x, y) = (random.range(-1.1, 1.1), random.range(-1.1, 1.1));
            let depth = depth_at(0.5 * x + 0.5) * (1.0 + random.range(-1.0, 1.0) * random.decade(1e-6, 0.8));
            let point = |x: f64, y: f64| {
                let point = relative_from_clip * glam::DVec4::new(x, y, depth, 1.0);
                point.truncate() / point.w
            };
            let at = point(x, y);
            let pixel = (point(x + 2.0 / f64::from(size[0]), y) - at).length();
            let half = random.vector().abs() * pixel * random.decade(0.005, 60.0);
            let (centre_high, centre_low) = culling::world::split(at + shot.pose.position);
            let flags = [0, 0, 0, 0, 1, 4][random.below(6)];
            Bounds { centre_high, centre_low, half_extent: half.as_vec3().to_array(), flags }
        };
        let bounds = (0..count).map(|_| bound(random)).collect();
        Occludees { size, bounds, depth: (0..pixels).map(depth).collect(), view: view.cull() }
    }

    /// The same with every quantity shifted by `step` times a bound of its rounding: 16u of the picture's size on the screen,
    /// 16u of a depth, 16u of what a box's place consists of. At +1 nothing can be more visible, at -1 less.
    pub fn shifted(&self, step: f32) -> Self {
        let view = CullView { snap_px: self.view.snap_px + 16.0 * U * self.size[0] as f32 * step, ..self.view };
        let grown = |bound: &Bounds| {
            let reach =
                |axis: usize| (bound.centre_high[axis] - view.camera_high[axis]).abs() + bound.half_extent[axis];
            let half = |axis: usize| (bound.half_extent[axis] + 16.0 * U * step * reach(axis)).max(0.0);
            Bounds { half_extent: std::array::from_fn(half), ..*bound }
        };
        Occludees {
            size: self.size,
            bounds: self.bounds.iter().map(grown).collect(),
            depth: self.depth.iter().map(|depth| depth * (1.0 - 16.0 * U * step)).collect(),
            view,
        }
    }
}
