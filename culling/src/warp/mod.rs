//! Iterative depth warping: the depth buffer that this frame will have, as far as the last one shows it, before anything is
//! drawn (Lee, Kim & Eisemann, "Iterative Depth Warping", ACM TOG 2018, section 3; Kim 2015, thesis, III). One layer: what
//! the last frame did not see is a hole, and holes are far, which hides nothing.
//!
//! Not a method, but the part that `woc` and its kin share.

mod reprojection;
mod settings;
pub mod twin;

pub use reprojection::{reprojections, LastFrame, Reprojections};
pub use settings::{Settings, OPTIONS};

use crate::{Result, View, World};
use engine::{Buffer, Format, Frame, Gpu, Image, Placement};
use shaders::types::{MotionBound, PyramidLevel, Reprojection, TexelMotion, REDUCED_LEVELS};
use shaders::{warp, BufferRef, ImageRef, Stage};

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
    no_items: Image,
    levels: Buffer<PyramidLevel>,
    motions: Buffer<TexelMotion>,
    pyramid: Buffer<MotionBound>,
    bounds: Buffer<MotionBound>,
    warped: Buffer<f32>,
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
        let bounds = |name: &str, len: usize| Buffer::new(gpu, name, len, Placement::Storage);
        Ok(Warp {
            slots: Buffer::with_data(gpu, "warp.slots", &slots(world), Placement::Storage)?,
            reprojections: Buffer::new(gpu, "warp.reprojections", world.moving().len(), Placement::Upload)?,
            no_items: Image::new(gpu, "warp.no_items", Format::Item, [1, 1])?,
            levels: Buffer::with_data(gpu, "warp.levels", &layout, Placement::Storage)?,
            motions: Buffer::new(gpu, "warp.motions", area(texels), Placement::Storage)?,
            pyramid: bounds("warp.pyramid", pyramid_texels)?,
            bounds: bounds("warp.bounds", area(tiles))?,
            warped: Buffer::new(gpu, "warp.warped", area(texels), Placement::Storage)?,
            settings,
            size,
            texels,
            tiles,
            layout,
            coarsest,
        })
    }

    /// Warps the depth of `last` to `view`. `depth` and `items` hold what `last` drew; items may be left out if nothing in
    /// the world moves. Gives the depth of each texel, row by row from the top, of a picture of [`Warp::texels`].
    ///
    /// # Errors
    /// The device.
    ///
    /// # Panics
    /// If a view has another size, or if something moves and there are no items.
    pub fn frame(
        &mut self,
        f: &mut Frame,
        world: &World,
        last: &LastFrame,
        view: &View,
        depth: ImageRef,
        items: Option<ImageRef>,
    ) -> Result<BufferRef<f32>> {
        assert_eq!([last.view().size, view.size], [self.size; 2], "a warp keeps the size of its pictures");
        let Reprojections { camera, moving } = reprojections(last, world, view);
        self.reprojections.write(&moving)?;
        self.measure_motion(f, camera, !moving.is_empty(), depth, items); // 1. where each pixel of the last frame goes
        self.bound_motion(f); // 2. the least and greatest motion of each region
        self.tighten_bounds(f); // 3. where each tile's source can be
        self.search_depth(f); // 4. what moves here, and the nearest of it
        Ok(self.warped.all())
    }

    fn measure_motion(
        &self,
        f: &mut Frame,
        camera: Reprojection,
        dynamic: bool,
        depth: ImageRef,
        items: Option<ImageRef>,
    ) {
        assert!(items.is_some() || !dynamic, "pixels of moving objects are warped by the item buffer");
        let stage = warp::MeasureMotion {
            depth,
            items: items.unwrap_or(self.no_items.view()),
            slots: self.slots.all(),
            reprojections: self.reprojections.all(),
            motions: self.motions.all(),
            camera,
            size_px: self.size,
            texels: self.texels,
            constants: warp::MeasureMotionConstants { dynamic, reduction: self.settings.reduction },
        };
        f.dispatch(stage, self.texels[0] * self.texels[1]);
    }

    fn bound_motion(&self, f: &mut Frame) {
        let tiles_at = |level: u32| {
            let PyramidLevel { width, height, .. } = self.layout[level as usize];
            [width, height]
        };
        let (levels, pyramid) = (self.levels.all(), self.pyramid.all());
        let tiles = tiles_at(REDUCED_LEVELS);
        let first = warp::BoundMotion { motions: self.motions.all(), levels, pyramid, texels: self.texels, tiles };
        f.dispatch(first, tiles[0] * tiles[1]);
        for source_level in (REDUCED_LEVELS..self.coarsest).step_by(REDUCED_LEVELS as usize) {
            let tiles = tiles_at(source_level + REDUCED_LEVELS);
            f.dispatch(warp::BoundLevels { levels, pyramid, source_level, tiles }, tiles[0] * tiles[1]);
        }
    }

    fn tighten_bounds(&self, f: &mut Frame) {
        let Settings { steps, tile, fill, .. } = self.settings;
        let stage = warp::TightenBounds {
            levels: self.levels.all(),
            pyramid: self.pyramid.all(),
            bounds: self.bounds.all(),
            texels: self.texels,
            tiles: self.tiles,
            coarsest_level: self.coarsest,
            constants: warp::TightenBoundsConstants { steps, tile, keep_last: fill },
        };
        f.dispatch(stage, self.tiles[0] * self.tiles[1]);
    }

    fn search_depth(&self, f: &mut Frame) {
        let Settings { seeds, iterations, threshold, tile, narrow, fill, .. } = self.settings;
        let stage = warp::SearchDepth {
            motions: self.motions.all(),
            bounds: self.bounds.all(),
            warped: self.warped.all(),
            texels: self.texels,
            tiles: self.tiles,
            constants: warp::SearchDepthConstants { seeds, iterations, threshold, tile, narrow, fill },
        };
        f.dispatch(stage, self.texels[0] * self.texels[1]);
    }

    /// Notes that a frame needs no warp.
    pub fn skip(f: &mut Frame, reason: &'static str) {
        for stage in [
            warp::MeasureMotion::INFO,
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

    /// Where each texel goes, read back; for pictures and tests.
    pub fn read_motions(&self) -> Result<Vec<TexelMotion>> {
        Ok(self.motions.read()?)
    }

    /// The motion pyramid with where its levels lie, read back; for tests.
    pub fn read_pyramid(&self) -> Result<(Vec<PyramidLevel>, Vec<MotionBound>)> {
        Ok((self.layout.clone(), self.pyramid.read()?))
    }

    /// The search bound of each tile, read back; for tests.
    pub fn read_bounds(&self) -> Result<Vec<MotionBound>> {
        Ok(self.bounds.read()?)
    }

    /// The warped depth, read back; for pictures and tests.
    pub fn read_depth(&self) -> Result<Vec<f32>> {
        Ok(self.warped.read()?)
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
