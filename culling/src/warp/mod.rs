//! Iterative depth warping: the depth buffer that this frame will have, as far as the last one shows it, before anything is
//! drawn (Lee, Kim & Eisemann, "Iterative Depth Warping", ACM TOG 2018, section 3; Kim 2015, thesis, III). One layer: what
//! the last frame did not see is a hole, and holes are far, which hides nothing.
//!
//! Not a method, but the part that `woc` and its kin share.

pub mod axes;
mod grid;
mod reprojection;
mod settings;
pub mod twin;

pub use reprojection::{reprojections, LastFrame, Reprojections};
pub use settings::{
    Settings, ITERATIONS, LOOKUPS, MARGIN, MOTION, NARROW, OPTIONS, ORIENTED, SEEDS, STEPS, THRESHOLD, TILE,
};

use crate::{Result, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use shaders::types::{MotionBound, PyramidLevel, Reprojection, TexelMotion, ERODE_SIDE, REDUCED_LEVELS};
use shaders::{warp, BufferRef, Stage};

/// The axis of bounds along x and y.
const ALONG_X: [f32; 2] = [1.0, 0.0];

/// The last frame's depth, brought to this frame's view.
pub struct Warp {
    settings: Settings,
    size: [u32; 2],
    texels: [u32; 2],
    tiles: [u32; 2],
    layout: Vec<PyramidLevel>,
    coarsest: u32,
    slots: Buffer<u32>,
    reprojections: Buffer<Reprojection>,
    depth: Buffer<f32>,
    items: Buffer<u32>,
    last: Option<LastFrame>,
    stored: bool,
    levels: Buffer<PyramidLevel>,
    motions: Buffer<TexelMotion>,
    axes: Buffer<[f32; 2]>,
    pyramid: Buffer<MotionBound>,
    bounds: Buffer<MotionBound>,
}

/// What is done to a warped depth.
#[derive(Clone, Copy, Debug)]
pub struct Refinement {
    /// Each texel gets the farthest depth of itself and its eight neighbours (Kim 2015, IV.1).
    pub erode: bool,
    /// Holes of a texel or two get the farthest depth around them (TOG 2018, 3.4).
    pub close: bool,
    /// The depth of each pixel that was drawn ahead: it counts where it is nearer (Kim 2015, IV.1).
    pub drawn: Option<BufferRef<f32>>,
}

impl Warp {
    /// Warps pictures of `size` pixels of one world.
    ///
    /// # Errors
    /// A device without room for it.
    pub fn new(gpu: &Gpu, world: &World, size: [u32; 2], settings: Settings) -> Result<Self> {
        let texels = size.map(|side| side.div_ceil(settings.reduction));
        let tiles = texels.map(|side| side.div_ceil(settings.tile));
        let (layout, coarsest) = crate::hzb::layout(texels);
        let area = |[width, height]: [u32; 2]| (width * height) as usize;
        let pyramid_texels = layout.iter().map(|level| area([level.width, level.height])).sum();
        let dynamic = world.moving().len() > 0;
        let bounds = |name: &str, len: usize| Buffer::new(gpu, name, len, Placement::Storage);
        Ok(Warp {
            slots: Buffer::with_data(gpu, "warp.slots", &slots(world), Placement::Storage)?,
            reprojections: Buffer::new(gpu, "warp.reprojections", world.moving().len(), Placement::Upload)?,
            depth: Buffer::new(gpu, "warp.depth", area(size), Placement::Storage)?,
            items: Buffer::new(gpu, "warp.items", if dynamic { area(size) } else { 1 }, Placement::Storage)?,
            last: None,
            stored: false,
            levels: Buffer::with_data(gpu, "warp.levels", &layout, Placement::Storage)?,
            motions: Buffer::new(gpu, "warp.motions", area(texels), Placement::Storage)?,
            axes: Buffer::with_data(gpu, "warp.axes", &[ALONG_X], Placement::Storage)?,
            pyramid: bounds("warp.pyramid", pyramid_texels)?,
            bounds: bounds("warp.bounds", area(tiles))?,
            settings,
            size,
            texels,
            tiles,
            layout,
            coarsest,
        })
    }

    /// Keeps what a frame drew, for the next one to be warped from: the last step of a frame. The depth is copied, because
    /// targets belong to the program, which may draw something else before the next frame.
    ///
    /// # Panics
    /// If the target has another size than the warp, or if something moves and it has no item buffer.
    pub fn keep(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        assert_eq!(target.size, self.size, "a warp keeps the size of its pictures");
        f.copy_depth("warp/keep_depth", target, &self.depth);
        if world.moving().len() > 0 {
            assert!(target.item.is_some(), "pixels of moving objects are warped by the item buffer");
            f.copy_items("warp/keep_items", target, &self.items);
        } else {
            f.skip("warp/keep_items", "no dynamic objects");
        }
        self.last = Some(LastFrame::of(world, view));
    }

    /// True if there is a frame to warp from.
    pub fn has_last(&self) -> bool {
        self.last.is_some()
    }

    /// Forgets the last frame.
    pub fn forget(&mut self) {
        self.last = None;
    }

    /// Warps the last frame's depth to `view`. Writes the depth of each texel, row by row from the top, of a picture of
    /// [`Warp::texels`]; `DEPTH_HOLE`, farther than far, of which the last frame knows nothing.
    ///
    /// # Errors
    /// The device.
    ///
    /// # Panics
    /// If the view has another size than the warp, or if there is no last frame.
    pub fn frame(&mut self, f: &mut Frame, world: &World, view: &View, warped: BufferRef<f32>) -> Result<()> {
        assert_eq!(view.size, self.size, "a warp keeps the size of its pictures");
        let last = self.last.as_ref().expect("a frame was kept before the first is warped");
        let Reprojections { camera, moving } = reprojections(last, world, view);
        self.reprojections.write(&moving)?;
        let dynamic = !moving.is_empty();
        self.stored = dynamic || self.settings.stores_motion();
        self.measure_motion(f, camera, dynamic); // 1. where each pixel of the last frame goes
        self.orient_axes(f); // 2. along which axes motion is bounded best
        self.bound_motion(f, camera); // 3. the least and greatest motion of each region
        self.tighten_bounds(f); // 4. where each tile's source can be
        self.search_depth(f, warped, camera, dynamic); // 5. what moves here, and the nearest of it
        Ok(())
    }

    fn measure_motion(&self, f: &mut Frame, camera: Reprojection, dynamic: bool) {
        if !self.stored {
            f.skip(warp::MeasureMotion::INFO.name, "computed where it is looked up: the camera alone moves");
            return;
        }
        let Settings { reduction, footprint, .. } = self.settings;
        let stage = warp::MeasureMotion {
            depth: self.depth.all(),
            items: self.items.all(),
            slots: self.slots.all(),
            reprojections: self.reprojections.all(),
            motions: self.motions.all(),
            camera,
            size_px: self.size,
            texels: self.texels,
            fastest: self.settings.fastest,
            constants: warp::MeasureMotionConstants { dynamic, reduction, middle: footprint },
        };
        f.dispatch_over(stage, self.texels);
    }

    fn orient_axes(&self, f: &mut Frame) {
        if self.settings.oriented {
            let stage = warp::OrientAxes { motions: self.motions.all(), axes: self.axes.all(), texels: self.texels };
            f.dispatch(stage, 1);
        } else {
            f.skip(warp::OrientAxes::INFO.name, "bounds lie along x and y");
        }
    }

    fn bound_motion(&self, f: &mut Frame, camera: Reprojection) {
        let Settings { reduction, oriented, fastest, .. } = self.settings;
        let tiles_at = |level: u32| {
            let PyramidLevel { width, height, .. } = self.layout[level as usize];
            [width, height]
        };
        let (levels, pyramid) = (self.levels.all(), self.pyramid.all());
        let tiles = tiles_at(REDUCED_LEVELS);
        let first = warp::BoundMotion {
            motions: self.motions.all(),
            levels,
            pyramid,
            axes: self.axes.all(),
            depth: self.depth.all(),
            camera,
            texels: self.texels,
            tiles,
            size_px: self.size,
            fastest,
            constants: warp::BoundMotionConstants { oriented, stored: self.stored, reduction },
        };
        f.dispatch(first, tiles[0] * tiles[1]);
        for source_level in (REDUCED_LEVELS..self.coarsest).step_by(REDUCED_LEVELS as usize) {
            let tiles = tiles_at(source_level + REDUCED_LEVELS);
            f.dispatch(warp::BoundLevels { levels, pyramid, source_level, tiles }, tiles[0] * tiles[1]);
        }
    }

    fn tighten_bounds(&self, f: &mut Frame) {
        let Settings { steps, tile, fill, oriented, lookups, .. } = self.settings;
        let stage = warp::TightenBounds {
            levels: self.levels.all(),
            pyramid: self.pyramid.all(),
            bounds: self.bounds.all(),
            axes: self.axes.all(),
            texels: self.texels,
            tiles: self.tiles,
            coarsest_level: self.coarsest,
            constants: warp::TightenBoundsConstants { steps, tile, keep_last: fill, oriented, lookups },
        };
        f.dispatch_over(stage, self.tiles);
    }

    fn search_depth(&self, f: &mut Frame, warped: BufferRef<f32>, camera: Reprojection, dynamic: bool) {
        let Settings {
            seeds,
            iterations,
            threshold,
            tile,
            narrow,
            fill,
            oriented,
            footprint,
            reduction,
            margin,
            fastest,
            ..
        } = self.settings;
        let stage = warp::SearchDepth {
            motions: self.motions.all(),
            bounds: self.bounds.all(),
            axes: self.axes.all(),
            warped,
            last_depth: self.depth.all(),
            items: self.items.all(),
            slots: self.slots.all(),
            reprojections: self.reprojections.all(),
            camera,
            texels: self.texels,
            tiles: self.tiles,
            size_px: self.size,
            fastest,
            constants: warp::SearchDepthConstants {
                seeds,
                iterations,
                threshold,
                tile,
                narrow,
                fill,
                oriented,
                footprint,
                dynamic,
                reduction,
                margin,
                stored: self.stored,
            },
        };
        f.dispatch_over(stage, self.texels);
    }

    /// Refines a warped depth by what is around each texel.
    pub fn refine(&self, f: &mut Frame, warped: BufferRef<f32>, refined: BufferRef<f32>, how: Refinement) {
        let stage = warp::ErodeDepth {
            warped,
            eroded: refined,
            drawn: how.drawn.unwrap_or(self.depth.all()),
            texels: self.texels,
            size_px: self.size,
            constants: warp::ErodeDepthConstants {
                erode: how.erode,
                close: how.close,
                merge: how.drawn.is_some(),
                reduction: self.settings.reduction,
            },
        };
        f.dispatch_over(stage, self.texels.map(|side| side.div_ceil(ERODE_SIDE)));
    }

    /// Notes that a frame needs no warp.
    pub fn skip(f: &mut Frame, reason: &'static str) {
        for stage in [
            warp::MeasureMotion::INFO,
            warp::OrientAxes::INFO,
            warp::BoundMotion::INFO,
            warp::BoundLevels::INFO,
            warp::TightenBounds::INFO,
            warp::SearchDepth::INFO,
        ] {
            f.skip(stage.name, reason);
        }
    }

    /// Width and height of the warped picture: the size over the reduction, rounded up.
    pub fn texels(&self) -> [u32; 2] {
        self.texels
    }

    /// True if the last frame's motions were stored, and not computed where they were looked up.
    pub fn has_motions(&self) -> bool {
        self.stored
    }

    /// Where each texel goes, read back; for pictures and tests.
    ///
    /// # Panics
    /// Without [`Warp::has_motions`].
    pub fn read_motions(&self) -> Result<Vec<TexelMotion>> {
        assert!(self.stored, "motions are read back where they are stored");
        Ok(self.motions.read()?)
    }

    /// The axis along which motion is bounded, read back; for tests and measures.
    pub fn read_axis(&self) -> Result<[f32; 2]> {
        Ok(self.axes.read()?.first().copied().unwrap_or(ALONG_X))
    }

    /// The motion pyramid with where its levels lie, read back; for tests.
    pub fn read_pyramid(&self) -> Result<(Vec<PyramidLevel>, Vec<MotionBound>)> {
        Ok((self.layout.clone(), self.pyramid.read()?))
    }

    /// The search bound of each tile, read back; for tests.
    pub fn read_bounds(&self) -> Result<Vec<MotionBound>> {
        Ok(self.bounds.read()?)
    }
}

/// By object: 1 + the place of its reprojection; 0 for what cannot move.
fn slots(world: &World) -> Vec<u32> {
    let mut slots = vec![0; world.len()];
    for (slot, (object, _)) in (1..).zip(world.moving()) {
        slots[object as usize] = slot;
    }
    slots
}
