//! `roc`: raster occlusion culling (EOVC thesis II.2; Kubisch & Tavenrath 2014). The last frame's visible objects are drawn
//! first; the boxes of all others in the view volume are rasterised against their depth; what shows is drawn. [`iterative`] does
//! so by depth ranges.

pub mod iterative;
mod ranges;
pub mod twin;

pub use ranges::{depth_plane, Cuts, RangeLists};

use crate::boxes::BoxList;
use crate::pack::DrawList;
use crate::world::Still;
use crate::{Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Buffer, Frame, Placement, Target};
use shaders::{roc, Stage};

/// `skip`: leave out what cannot change the result.
pub const OPTIONS: &[OptionInfo] = &[crate::world::SKIP_OPTION, crate::world::DETAIL_OPTION];

/// Frames of an unchanged view after which the lists hold: what is hidden leaves the early list one frame after it is drawn,
/// and what it had let through may leave in the next two.
const SETTLED_AFTER: u32 = 4;

struct Roc {
    visible: [Buffer<u32>; 2],
    newly: Buffer<u32>,
    boxes: Buffer<u32>,
    box_list: BoxList,
    early: DrawList,
    late: DrawList,
    now: usize,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let flags = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Storage);
    Ok(Box::new(Roc {
        visible: [flags("roc.visible_even")?, flags("roc.visible_odd")?],
        newly: flags("roc.newly")?,
        boxes: flags("roc.boxes")?,
        box_list: BoxList::new(gpu, "roc.box_list", world.len())?,
        early: DrawList::new(gpu, "roc.early", world)?,
        late: DrawList::new(gpu, "roc.late", world)?,
        now: 0,
        still: Still::new(setup.options).settled_after(SETTLED_AFTER),
    }))
}

impl Method for Roc {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.still.holds(world, view) {
            return self.same_again(f, world, view, target);
        }
        self.now = 1 - self.now;
        let (before, now) = (&self.visible[1 - self.now], &self.visible[self.now]);
        self.box_list.look(view)?;

        f.part("early");
        f.fill("roc/clear_flags", now, 0);
        self.early.pack(f, world, before.all()); // 1. what the last frame saw
        world.draw_flagged(f, &self.early, now.all(), view, target); // 2. draw it; what still shows is flagged

        f.part("boxes");
        let select = roc::SelectBoxes {
            bounds: world.bounds(),
            drawn: before.all(),
            boxes: self.boxes.all(),
            newly: self.newly.all(),
            view: view.cull(),
            object_count: world.len() as u32,
        };
        f.dispatch(select, world.len() as u32); // 3. the others in the view volume
        self.box_list.pack(f, world, self.boxes.all());
        let test = roc::TestBoxes {
            bounds: world.bounds(),
            listed: self.box_list.listed(),
            views: self.box_list.view(),
            newly: self.newly.all(),
        };
        f.test_boxes(test, self.box_list.draw(), &target.test_only()); // 4. whose boxes show

        f.part("late");
        self.late.pack(f, world, self.newly.all());
        world.draw_flagged(f, &self.late, now.all(), view, target); // 5. draw them
        f.part("");
        Ok(())
    }

    fn work(&self) -> Result<Work> {
        Ok(Work { boxes: u64::from(self.box_list.read_len()?), ..Work::default() })
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        let boxes = world.host_bounds();
        let singles = self.box_list.read_listed()?.into_iter().map(|object| boxes[object as usize]).collect();
        Ok(Some(TestedBoxes { groups: Vec::new(), singles }))
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        self.visible.iter_mut().try_for_each(|flags| Ok(flags.write(&vec![0; flags.len()])?))
    }
}

impl Roc {
    /// Camera and objects unchanged: the last frame's lists hold.
    fn same_again(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        for (part, list) in [("early", &self.early), ("late", &self.late)] {
            f.part(part);
            list.skip_packing(f, Still::REASON);
            world.draw(f, list, view, target);
        }
        f.part("boxes");
        f.skip(roc::SelectBoxes::INFO.name, Still::REASON);
        BoxList::skip_packing(f, Still::REASON);
        f.skip(roc::TestBoxes::INFO.name, Still::REASON);
        f.part("");
        Ok(())
    }
}
