//! What the stages of `hzb-iterative` are given when they are compared with their twins.

use culling::hzb::twin::{pyramid, PyramidTest};
use culling::roc::depth_plane;
use culling::View;
use glam::DVec3;
use harness::occludees::Occludees;
use harness::worlds::special_projections;
use harness::Random;
use scenes::{Pose, Projection, Shot};
use shaders::types::*;

const SIZE: [u32; 2] = [161, 97];
pub(super) const BOXES: usize = 4_000;
/// The name of the input in which fronts decide.
pub(super) const WALL: &str = "along a wall";

/// Vertex grids, in pixels: that of most devices, and the coarsest that Vulkan allows. Nothing is rasterised here, so the device's own does not matter;
/// where its grid was the coarse one, fronts hid a thousandth of the objects along the wall, and comparing them proved nothing.
const GRIDS_PX: [f32; 2] = [1.0 / 256.0, 1.0 / 16.0];

/// Boxes, what a frame looks through, and the pyramid of a depth that hides some of them.
pub(super) struct Input {
    pub bounds: Vec<Bounds>,
    pub all: StepView,
    pub levels: Vec<PyramidLevel>,
    pub texels: Vec<f32>,
    pub finest: u32,
}

impl Input {
    pub fn by_chance(random: &mut Random, grid_px: f32, projection: Projection) -> Self {
        let pose = Pose { position: random.vector() * 1e3, rotation: random.turn() };
        let shot = Shot { pose, projection, seconds: 0.0 };
        let occludees = Occludees::by_chance(random, &shot, SIZE, grid_px, BOXES);
        let (levels, coarsest_level) = culling::hzb::layout(SIZE);
        let all = StepView {
            view: occludees.view,
            depth_plane: depth_plane(&View::new(&shot, SIZE, 0, grid_px)),
            object_count: BOXES as u32,
            block_count: BOXES as u32,
            coarsest_level,
            range_count: 3,
            share: 0.5,
            later_kinds: [2_000, 3_001, u32::MAX, u32::MAX, u32::MAX, u32::MAX, u32::MAX],
        };
        Input {
            texels: pyramid(&occludees.depth, SIZE, &levels),
            bounds: occludees.bounds,
            all,
            levels,
            finest: 1 + random.below(3) as u32,
        }
    }

    /// Boxes behind a wall that recedes to the right of the camera, along it: most of them begin nearer than the wall ends, so that footprints hide
    /// few of them, and their fronts tell.
    fn along_a_wall(random: &mut Random, grid_px: f32) -> Self {
        const NEAR: f64 = 0.1;
        let projection = Projection::Perspective { fov_y: 1.0, near: NEAR, far: None };
        let shot = Shot { pose: Pose::looking_at(DVec3::ZERO, DVec3::NEG_Z), projection, seconds: 0.0 };
        let view = View::new(&shot, SIZE, 0, grid_px);
        let half_width = 0.5f64.tan() * f64::from(SIZE[0]) / f64::from(SIZE[1]);
        // The wall is at x = 2; left of the middle all is right before the eye.
        let depth = |column: u32| {
            let across = (f64::from(column) + 0.5) / f64::from(SIZE[0]) * 2.0 - 1.0;
            (NEAR / 2.0 * across * half_width) as f32
        };
        let columns = (0..SIZE[0]).map(|column| if 2 * column < SIZE[0] { 1.0 } else { depth(column) });
        let row: Vec<f32> = columns.collect();
        let mut input = Input::by_chance(random, grid_px, projection);
        input.texels = pyramid(&row.repeat(SIZE[1] as usize), SIZE, &input.levels);
        for bounds in &mut input.bounds {
            let half = DVec3::new(random.range(0.05, 0.5), random.range(0.05, 0.5), random.range(0.5, 8.0));
            let [begin, behind] = [random.range(2.0, 6.0), random.range(0.02, 1.0)];
            let centre = DVec3::new(2.0 + behind + half.x, random.range(-1.5, 1.5), -begin - half.z);
            let half_extent = half.as_vec3().to_array();
            *bounds = Bounds { centre_high: centre.as_vec3().to_array(), centre_low: [0.0; 3], half_extent, ..*bounds };
        }
        let all = StepView { view: view.cull(), depth_plane: depth_plane(&view), range_count: 1, ..input.all };
        Input { all, finest: 1, ..input }
    }

    /// Every kind of camera, on fine and coarse grids in turn, and the wall.
    pub fn all(random: &mut Random) -> Vec<(&'static str, Self)> {
        let kinds = special_projections().into_iter().zip(GRIDS_PX.into_iter().cycle());
        let mut all: Vec<_> =
            kinds.map(|((name, projection), grid_px)| (name, Input::by_chance(random, grid_px, projection))).collect();
        all.push((WALL, Input::along_a_wall(random, GRIDS_PX[0])));
        all
    }

    pub fn test(&self) -> PyramidTest<'_> {
        let coarsest_level = self.all.coarsest_level;
        PyramidTest {
            levels: &self.levels,
            texels: &self.texels,
            coarsest_level,
            footprint_texels: 4,
            finest_level: self.finest,
        }
    }
}
