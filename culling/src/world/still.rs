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

/// Remembers what the last frame looked at.
pub struct Still {
    enabled: bool,
    last: Option<(View, u64)>,
}

impl Still {
    /// Why stages are left out while it holds.
    pub const REASON: &'static str = "camera and objects unchanged";

    /// Follows the method's `skip` option.
    pub fn new(options: &Options) -> Self {
        Still { enabled: options.flag("skip"), last: None }
    }

    /// True if this frame sees exactly what the last one saw. Call once a frame.
    pub fn holds(&mut self, world: &World, view: &View) -> bool {
        let now = Some((*view, world.revision()));
        let same = self.last.as_ref().zip(now.as_ref()).is_some_and(|(last, now)| last.0.same(&now.0) && last.1 == now.1);
        self.last = now;
        same && self.enabled
    }

    /// The next frame is the first.
    pub fn forget(&mut self) {
        self.last = None;
    }
}
