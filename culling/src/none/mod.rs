//! `none`: no culling. One multi-draw of every object: the baseline of every table, and the truth.

use crate::{Method, OptionInfo, Result, Setup, View, World};
use engine::{Frame, Target};

/// No options.
pub const OPTIONS: &[OptionInfo] = &[];

struct None;

/// Makes the method.
pub fn make(_setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    Ok(Box::new(None))
}

impl Method for None {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        world.draw_all(f, view, target);
        Ok(())
    }
}
