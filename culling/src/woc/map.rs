//! The occlusion map of warping-based culling: the last frame's depth, warped to this frame and eroded, as farthest depths of
//! regions.

use crate::farthest::{FarthestMap, MapKind};
use crate::warp::{Refinement, Settings, Warp};
use crate::{Result, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use shaders::{farthest, warp, BufferRef, Stage};

/// How the map is made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recipe {
    /// How the last frame's depth is warped.
    pub(super) settings: Settings,
    /// What the map consists of.
    pub(super) kind: MapKind,
    /// Each warped texel is given the farthest depth around it.
    pub(super) erode: bool,
    /// Narrow holes are given the farthest depth around them.
    pub(super) close: bool,
}

/// An occlusion map for pictures of one size.
pub(super) struct OcclusionMap {
    recipe: Recipe,
    size: [u32; 2],
    warp: Warp,
    warped: Option<Buffer<f32>>,
    farthest: FarthestMap,
}

/// Why nothing is predicted.
const NOTHING_SEEN: &str = "no last frame of this size";

impl OcclusionMap {
    fn new(gpu: &Gpu, world: &World, size: [u32; 2], recipe: Recipe) -> Result<Self> {
        let warp = Warp::new(gpu, world, size, recipe.settings)?;
        let texels = warp.texels().iter().product::<u32>() as usize;
        let warped = (recipe.erode || recipe.close)
            .then(|| Buffer::new(gpu, "woc.warped", texels, Placement::Storage))
            .transpose()?;
        let farthest = FarthestMap::new(gpu, size, recipe.kind)?;
        Ok(OcclusionMap { recipe, size, warp, warped, farthest })
    }

    /// The map in `slot` if it is of that size, otherwise a new one, which has seen nothing yet.
    pub(super) fn sized<'a>(
        slot: &'a mut Option<Self>,
        gpu: &Gpu,
        world: &World,
        size: [u32; 2],
        recipe: Recipe,
    ) -> Result<&'a mut Self> {
        let fitting = slot.take().filter(|map| map.size == size);
        Ok(slot.insert(match fitting {
            Some(map) => map,
            None => OcclusionMap::new(gpu, world, size, recipe)?,
        }))
    }

    /// True if there is a last frame to predict this one from.
    pub(super) fn has_seen(&self) -> bool {
        self.warp.has_last()
    }

    /// Makes the map of what the last frame saw, as it will be seen in this one, and of what this one has `drawn` already.
    pub(super) fn predict(
        &mut self,
        f: &mut Frame,
        world: &World,
        view: &View,
        drawn: Option<BufferRef<f32>>,
    ) -> Result<()> {
        let base = self.farthest.base();
        match &self.warped {
            Some(warped) => {
                self.warp.frame(f, world, view, warped.all())?;
                let Recipe { erode, close, .. } = self.recipe;
                self.warp.refine(f, warped.all(), base, Refinement { erode, close, drawn });
            }
            None => {
                self.warp.frame(f, world, view, base)?;
                f.skip(warp::ErodeDepth::INFO.name, "not asked for");
            }
        }
        self.farthest.build(f);
        Ok(())
    }

    /// Makes the map of what this frame has drawn.
    pub(super) fn observe(&self, f: &mut Frame, target: &Target) {
        self.farthest.fill_from_depth(f, target);
        self.farthest.build(f);
    }

    /// Flags the objects whose `kept` is not 0 and which the map does not hide, of the `blocks` in view.
    pub(super) fn test(
        &self,
        f: &mut Frame,
        world: &World,
        view: &View,
        (kept, blocks): (BufferRef<u32>, BufferRef<u32>),
        visible: BufferRef<u32>,
    ) {
        self.farthest.test(f, world, view, (kept, blocks), visible);
    }

    /// Keeps what the frame drew for the next one.
    pub(super) fn keep(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        self.warp.keep(f, world, view, target);
    }

    /// Forgets the last frame.
    pub(super) fn forget(&mut self) {
        self.warp.forget();
    }

    /// Notes that there is nothing to predict from, and so nothing to test against.
    pub(super) fn skip_first(&self, f: &mut Frame) {
        self.skip(f, NOTHING_SEEN);
    }

    /// Notes that map and test are not needed.
    pub(super) fn skip(&self, f: &mut Frame, reason: &'static str) {
        Warp::skip(f, reason);
        f.skip(warp::ErodeDepth::INFO.name, reason);
        FarthestMap::skip(f, self.recipe.kind, reason);
    }

    /// Notes that the map of what was drawn is not needed.
    pub(super) fn skip_observing(&self, f: &mut Frame, reason: &'static str) {
        f.skip(farthest::FillFromDepth::INFO.name, reason);
        FarthestMap::skip(f, self.recipe.kind, reason);
    }

    /// Notes that nothing new is kept.
    pub(super) fn skip_keeping(f: &mut Frame, reason: &'static str) {
        f.skip("warp/keep_depth", reason);
        f.skip("warp/keep_items", reason);
    }
}
