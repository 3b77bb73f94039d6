//! `roc-iterative`: raster occlusion culling by depth ranges (EOVC thesis II.2, "iterative occlusion culling in manual depth
//! range", its reference 23). From the nearest range to the farthest, what the last frame saw in the range is drawn, the boxes
//! of its other objects are rasterised against the depth of all that was drawn, and what shows is drawn. So what has just
//! come into view hides what lies farther away, in the same frame: after a camera cut `roc` draws all that was not seen before.

use super::{Cuts, RangeLists, SETTLED_AFTER};
use crate::world::Still;
use crate::{Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Buffer, Frame, Placement, Target};
use shaders::types::MOST_RANGES;
use shaders::{roc, Stage};

/// How many ranges there are, how they are cut, and what lies past them.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    OptionInfo {
        name: "ranges",
        default: "6",
        values: "1..=8",
        help: "depth ranges; 1 draws what roc draws",
    },
    OptionInfo {
        name: "factor",
        default: "2",
        values: "2..=16",
        help: "how many times farther than the range before it each range reaches",
    },
    OptionInfo {
        name: "first",
        default: "0",
        values: "0..=1000000",
        help: "where the first range ends, in metres from the eye (the thesis: by hand); 0: the last ends with the farthest object in view",
    },
    OptionInfo {
        name: "beyond",
        default: "tested",
        values: "tested|visible",
        help: "objects past the last range belong to it, or are visible without a test (the thesis); none are past it if first=0",
    },
];

/// Parts of the frame, by range: what the last frame saw, and what shows besides.
const PARTS: [[&str; 2]; MOST_RANGES as usize] = [
    ["seen 1", "new 1"],
    ["seen 2", "new 2"],
    ["seen 3", "new 3"],
    ["seen 4", "new 4"],
    ["seen 5", "new 5"],
    ["seen 6", "new 6"],
    ["seen 7", "new 7"],
    ["seen 8", "new 8"],
];

struct Iterative {
    visible: [Buffer<u32>; 2],
    lists: RangeLists,
    now: usize,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let flags = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Storage);
    Ok(Box::new(Iterative {
        visible: [flags("roc.visible_even")?, flags("roc.visible_odd")?],
        lists: RangeLists::new(gpu, "roc.ranges", world, Cuts::new(setup.options))?,
        now: 0,
        still: Still::new(setup.options).settled_after(SETTLED_AFTER),
    }))
}

impl Method for Iterative {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.still.holds(world, view) {
            return self.same_again(f, world, view, target);
        }
        self.now = 1 - self.now;
        let (before, now) = (&self.visible[1 - self.now], &self.visible[self.now]);
        self.lists.look(view)?;

        f.fill("roc/clear_flags", now, 0);
        self.lists.sort(f, world, view, before.all()); // 1. each object to its depth range
        for range in self.lists.ranges() {
            let [seen, new] = PARTS[range];
            f.part(seen);
            for draw in self.lists.early(world, range) {
                world.draw_indirect_flagged(f, draw, now.all(), view, target); // 2. draw what the last frame saw in it
            }
            f.part(new);
            let test = roc::TestRange {
                bounds: world.bounds(),
                commands: self.lists.tested(),
                places: self.lists.places(),
                views: self.lists.box_view(),
                late: self.lists.tested(),
            };
            f.test_boxes(test, self.lists.boxes(range), &target.test_only()); // 3. whose boxes show past all drawn so far
            for draw in self.lists.late(world, range) {
                world.draw_indirect_flagged(f, draw, now.all(), view, target); // 4. draw them, and go on to the next range
            }
        }
        f.part("");
        Ok(())
    }

    fn work(&self) -> Result<Work> {
        Ok(Work { boxes: self.lists.read_tested()?.len() as u64, ..Work::default() })
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        let boxes = world.host_bounds();
        let singles = self.lists.read_tested()?.into_iter().map(|object| boxes[object]).collect();
        Ok(Some(TestedBoxes { groups: Vec::new(), singles }))
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        self.visible.iter_mut().try_for_each(|flags| Ok(flags.write(&vec![0; flags.len()])?))
    }
}

impl Iterative {
    /// Camera and objects unchanged: the last frame's lists hold.
    fn same_again(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        RangeLists::skip_sorting(f, Still::REASON);
        for range in self.lists.ranges() {
            let [seen, new] = PARTS[range];
            f.part(seen);
            for draw in self.lists.early(world, range) {
                world.draw_indirect(f, draw, view, target);
            }
            f.part(new);
            f.skip(roc::TestRange::INFO.name, Still::REASON);
            for draw in self.lists.late(world, range) {
                world.draw_indirect(f, draw, view, target);
            }
        }
        f.part("");
        Ok(())
    }
}
