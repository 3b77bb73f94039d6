//! Drawing what a list holds.

use super::DrawList;
use crate::world::{LastToFirst, View, World};
use engine::{Frame, Surface, Target};
use shaders::{draw, BufferRef};

impl World {
    /// Draws what a list holds.
    pub fn draw(&self, f: &mut Frame, list: &DrawList, view: &View, target: &Target) {
        for draw in list.draws(self) {
            self.draw_indirect(f, draw, view, target);
        }
    }

    /// Draws the depth of what a list holds and nothing else, ahead of the draws that show it. Not of masked objects: that two
    /// pipelines discard the same fragments is promised by nobody, and depth where nothing is drawn would hide what shows there.
    pub fn draw_depth(&self, f: &mut Frame, list: &DrawList, view: &View, target: &Target) {
        for indirect in list.draws(self).filter(|draw| draw.surface == Surface::Opaque) {
            let stage = draw::Depth { view: view.gpu() };
            f.draw_unshown(stage, indirect, &target.depth_only());
        }
    }

    /// Draws what a list holds, and sets the flag of each object of which a fragment passes the early tests: colour, depth
    /// and visibility in one pass (EOVC thesis III.2).
    pub fn draw_flagged(&self, f: &mut Frame, list: &DrawList, visible: BufferRef<u32>, view: &View, target: &Target) {
        for draw in list.draws(self) {
            self.draw_indirect_flagged(f, draw, visible, view, target);
        }
    }

    /// Draws what a list holds where it is nearer than what is there, and sets the flag of each object that is, if there are
    /// flags to set.
    pub fn draw_behind(
        &self,
        f: &mut Frame,
        list: &DrawList,
        order: &LastToFirst,
        visible: Option<BufferRef<u32>>,
        view: &View,
        target: &Target,
    ) {
        let target = target.keeping_ties();
        for draw in list.draws(self) {
            let draw = order.turned(draw);
            match visible {
                Some(visible) => self.draw_indirect_flagged(f, draw, visible, view, &target),
                None => self.draw_indirect(f, draw, view, &target),
            }
        }
    }
}
