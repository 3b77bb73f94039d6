//! What a culling method is.

use crate::{Options, Result, View, VisibleSets, World};
use engine::{Frame, Gpu, Target};
use scenes::Aabb;
use std::sync::Arc;

/// What a method promises. Tests hold it to that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guarantee {
    /// Every object that owns a pixel is drawn, in every frame, whatever the scene, up to the documented raster conditions.
    Exact,
    /// Objects may be missed, for this reason.
    Approximate(&'static str),
}

impl std::fmt::Display for Guarantee {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Guarantee::Exact => out.write_str("exact"),
            Guarantee::Approximate(why) => write!(out, "approximate: {why}"),
        }
    }
}

/// What a frame knew of its light, in samples of the light's block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flare {
    /// What the brightness came from.
    pub used: u64,
    /// What the frame's own query counted; none if there was nothing to ask.
    pub asked: Option<u64>,
    /// What its depth buffer leaves visible; none where work is not counted.
    pub visible: Option<u64>,
    /// What a whole block holds.
    pub of: u64,
}

impl Flare {
    /// A number of samples as a part of the block, 0 to 1.
    pub fn fraction(&self, samples: u64) -> f64 {
        samples as f64 / self.of.max(1) as f64
    }
}

/// What a frame did to find out what is visible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Occlusion queries issued.
    pub queries: u64,
    /// Tests of a box or sphere against a plane of the view volume, where that is all a method does.
    pub plane_tests: u64,
    /// Changes between drawing and testing: runs of one kind.
    pub state_changes: u64,
    /// Times that the host waited for answers.
    pub waits: u64,
    /// Boxes rasterised.
    pub boxes: u64,
    /// Rays cast.
    pub rays: u64,
    /// Nodes that rays looked at.
    pub node_visits: u64,
    /// Rays not cast because all that they could meet had been met.
    pub early_stops: u64,
    /// Nodes of a hierarchy that were fitted to bounds that had changed.
    pub refits: u64,
    /// What is known of the light of a lens flare; none where there is none.
    pub flare: Option<Flare>,
}

/// The boxes that a frame rasterised to find out what is visible: world bounds in metres, before they are grown to cover all
/// pixels that their contents can. As many as [`Work::boxes`] counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TestedBoxes {
    /// Boxes of several objects.
    pub groups: Vec<Aabb>,
    /// Boxes of one object.
    pub singles: Vec<Aabb>,
}

/// What a method is made from.
pub struct Setup<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// The scene on it.
    pub world: &'a World,
    /// The method's options.
    pub options: &'a Options,
    /// The true visible set of each frame, where the run has it.
    pub visible: Option<Arc<VisibleSets>>,
}

/// A culling method: it records frames.
pub trait Method {
    /// Readies what belongs to the run and not to the method (`ref`'s visible set). Never timed.
    fn prepare(&mut self, _world: &World, _view: &View) -> Result<()> {
        Ok(())
    }

    /// True if the method's next frame needs the item buffer, even if it is timed.
    fn needs_items(&self, _world: &World, _view: &View) -> bool {
        false
    }

    /// Records one frame that clears the target and draws what may be visible. Every decision comes from the world, the view
    /// and earlier frames, never from what the target has bound.
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()>;

    /// Turns the counting of [`Work`] on or off. Counting changes no decision; it is off in timed frames.
    fn count_work(&mut self, _on: bool) {}

    /// What the last frame did beyond drawing, if counting was on; the device must be idle.
    fn work(&self) -> Result<Work> {
        Ok(Work::default())
    }

    /// The boxes that the last frame tested, read back; none if the method tests no boxes. The device must be idle. For
    /// pictures and tests, never timed.
    fn tested_boxes(&self, _world: &World) -> Result<Option<TestedBoxes>> {
        Ok(None)
    }

    /// Told what the last frame took, in milliseconds, if that was measured without anything that slows it down: for methods that decide by
    /// time.
    fn measured(&mut self, _frame_ms: f64) {}

    /// The run starts again from its first frame to measure something else: decisions that came from measured times are to be taken as
    /// they were.
    fn repeat(&mut self) {}

    /// What was decided in each frame and why, a line each; empty for methods that decide nothing.
    fn choices(&self) -> Vec<String> {
        Vec::new()
    }

    /// Forgets earlier frames: after a camera cut, or when a run starts again from its first frame.
    fn forget(&mut self) -> Result<()> {
        Ok(())
    }
}
