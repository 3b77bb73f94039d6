//! The truth: what is seen when everything is drawn. Never timed.

use crate::measures::metrics::{FrameImages, Truth};
use crate::run::session::Session;
use crate::run::targets::Targets;
use anyhow::{Context, Result};
use culling::translucent::Seen;
use culling::{View, VisibleSets, World};
use engine::Gpu;
use std::path::Path;
use std::sync::Arc;

/// Bytes of truth images that are kept in memory; past that they are drawn again when needed.
const KEPT_BYTES: usize = 1 << 30;

/// The truth of a run.
pub struct RunTruth {
    /// The visible set of each frame.
    pub sets: Arc<VisibleSets>,
    images: Vec<FrameImages>,
}

/// Draws everything, with the item buffer, and reads the pictures back.
pub fn draw_everything(session: &mut Session, frame: usize) -> Result<FrameImages> {
    let view = session.look(frame)?;
    draw_all_of(session, &view).with_context(|| format!("drawing the truth of frame {frame}"))
}

/// The same through a view, of objects where they are now.
pub fn draw_all_of(session: &Session, view: &View) -> Result<FrameImages> {
    draw_truth(&session.gpu, &session.world, &session.targets, view)
}

/// The same of a world that belongs to no session. Translucent objects are drawn last; of them it is noted who leaves a fragment.
pub fn draw_truth(gpu: &Gpu, world: &World, targets: &Targets, view: &View) -> Result<FrameImages> {
    let target = targets.with_items();
    let mut seen = Seen::new(gpu, world)?;
    let mut f = gpu.frame();
    world.update(&mut f);
    f.clear(&target);
    world.draw_all(&mut f, view, &target);
    if let Some(seen) = &mut seen {
        seen.frame(&mut f, world, view, &target)?;
    }
    let report = f.finish()?;
    let seen_through = seen.map_or(Ok(Vec::new()), |seen| seen.objects())?;
    Ok(FrameImages { seen_through, ..targets.read_frame(world, view, &report)? })
}

impl RunTruth {
    /// Draws the truth of every frame. `step` is called after each.
    pub fn draw(session: &mut Session, mut step: impl FnMut()) -> Result<Self> {
        let mut sets = VisibleSets::new(session.world.total());
        let mut images = Vec::new();
        let [width, height] = session.options().size;
        let samples = session.targets.samples() as usize;
        let keep = session.frames() * width as usize * height as usize * samples * 12 <= KEPT_BYTES;
        for frame in 0..session.frames() {
            let drawn = draw_everything(session, frame)?;
            sets.push_items(&drawn.visible_items());
            if keep {
                images.push(drawn);
            }
            step();
        }
        Ok(RunTruth { sets: Arc::new(sets), images })
    }

    /// The visible sets of a run from the cache, or drawn and then cached. A cache that cannot be written is no error.
    pub fn visible_sets(session: &mut Session, cache: Option<&Path>, step: impl FnMut()) -> Result<Arc<VisibleSets>> {
        let key = session.key();
        let (objects, frames) = (session.world.total(), session.frames());
        if let Some(sets) = cache.and_then(|folder| culling::reference::load(folder, &key, objects, frames)) {
            return Ok(Arc::new(sets));
        }
        let truth = Self::draw(session, step)?;
        truth.store(session, cache);
        Ok(truth.sets)
    }

    /// Puts the visible sets in the cache.
    pub fn store(&self, session: &Session, cache: Option<&Path>) {
        if let Some(folder) = cache {
            if let Err(error) = culling::reference::save(folder, &session.key(), &self.sets) {
                tracing::warn!(%error, folder = %folder.display(), "the visible sets were not cached");
            }
        }
    }

    /// The truth of one frame, with its visible set.
    pub fn frame(&self, session: &mut Session, frame: usize) -> Result<Truth> {
        let images = match self.images.get(frame) {
            Some(images) => images.clone(),
            None => draw_everything(session, frame)?,
        };
        Ok(Truth::new(images, session.world.total())?)
    }
}
