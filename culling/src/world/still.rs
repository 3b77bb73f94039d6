//! Camera and objects unchanged since the last frame: its lists still hold.

use crate::world::{View, World};
use crate::{OptionInfo, Options};

/// The option of every method that can leave stages out.
pub const SKIP_OPTION: OptionInfo = OptionInfo {
    name: "skip",
    default: "true",
    values: "true|false",
    help: "leave out stages that cannot change the result",
};

/// The option of every method that tests bounds: who makes the frame's [`View`](crate::View) reads it.
pub const DETAIL_OPTION: OptionInfo = OptionInfo {
    name: "detail",
    default: "0",
    values: "0..=1000",
    help: "leave out what is smaller on the screen than so many pixels, hidden or not: errors for time; 0 leaves out nothing",
};

/// Remembers what the last frames looked at.
pub struct Still {
    enabled: bool,
    settled_after: u32,
    unchanged: u32,
    last: Option<(View, u64)>,
}

impl Still {
    /// Why stages are left out while it holds.
    pub const REASON: &'static str = "camera and objects unchanged";

    /// Follows the method's `skip` option, for lists that depend on this frame alone.
    pub fn new(options: &Options) -> Self {
        Still { enabled: options.flag("skip"), settled_after: 1, unchanged: 0, last: None }
    }

    /// Never holds.
    pub fn never() -> Self {
        Still { enabled: false, settled_after: 1, unchanged: 0, last: None }
    }

    /// For lists that also depend on earlier frames: they no longer change from the `frames`th frame on that sees what the
    /// frame before it saw.
    pub fn settled_after(self, frames: u32) -> Self {
        Still { settled_after: frames, ..self }
    }

    /// True if a frame would see exactly what the last one saw, whether or not stages may be left out.
    pub fn same(&self, world: &World, view: &View) -> bool {
        self.last.as_ref().is_some_and(|last| last.0.same(view) && last.1 == world.revision())
    }

    /// What [`Still::holds`] will say of the next frame.
    pub fn would_hold(&self, world: &World, view: &View) -> bool {
        self.enabled && self.same(world, view) && self.unchanged.saturating_add(1) >= self.settled_after
    }

    /// True if this frame sees exactly what the last ones saw, and their lists have settled. Call once a frame.
    pub fn holds(&mut self, world: &World, view: &View) -> bool {
        let (same, holds) = (self.same(world, view), self.would_hold(world, view));
        self.last = Some((*view, world.revision()));
        self.unchanged = if same { self.unchanged.saturating_add(1) } else { 0 };
        holds
    }

    /// The next frame is the first.
    pub fn forget(&mut self) {
        self.last = None;
        self.unchanged = 0;
    }
}
