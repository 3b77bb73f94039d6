//! `hzb-iterative`: hierarchical-Z culling by depth ranges, near to far, with as many ranges as the frame needs. `hzb` (Haar & Aaltonen
//! 2015) lives on what the last frame saw; this method tests that too once something is in front of it, and lets what has just come into
//! view hide what lies farther away in the same frame, as iterative raster occlusion culling does (EOVC thesis II.2, its reference 23).
//!
//! The view is cut into r depth ranges. In step k what the last frame saw of range k is tested together with what it did not see of range
//! k - 1, against the farthest-depth pyramid of all that was drawn in the steps before: what was seen runs one range ahead, so that r
//! ranges take r pyramids. With one range this is `hzb` with tested blocks.
//!
//! - How far the view has changed since the last frame is known before the frame (see [`hurry`]). Where it is far, rays find what stands in
//!   front (see [`crate::seeds`]); that counts as seen. What they miss lies in gaps between it, so that one range will do.
//! - Without rays r follows from the same change.
//! - Blocks of objects are tested before their objects, and a block once hidden is hidden for the rest of the frame.
//! - What its footprint does not hide, block or object, is asked again by how near its faces are at each texel (see [`super::fronts`]).
//! - In a single range what is drawn first need not be what was seen, if only the rest is tested: the list of one frame serves until owners are
//!   looked at again. What comes into view meanwhile is tested, and drawn, again.
//! - Who counts as seen is found out every few frames from the item buffer, as the EOVC thesis filters occluders (III.6.2): exactly who owns
//!   a pixel, in any order of drawing. In between, what is newly drawn is added: it passed the tests, so that it would be drawn again.
//!   (Flags by fragment in every frame kept what was drawn before its occluder, and make a draw a third slower.)

pub mod hurry;
mod steps;
pub mod twin;

use super::Pyramid;
use crate::eovc::filter_occluders;
use crate::roc::depth_plane;
use crate::seeds::{Seeds, RAYS_OPTION};
use crate::world::Still;
use crate::{Error, Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use hurry::Hurry;
use shaders::types::MOST_STEP_RANGES;
use shaders::{eovc, hzb, Stage};
use steps::{Step, Steps};

/// How many ranges, how they are cut, and how finely boxes are tested.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    RAYS_OPTION,
    OptionInfo {
        name: "ranges",
        default: "auto",
        values: "auto|1|2|3|4|5",
        help: "depth ranges: as many as the change of view asks for, or always so many; 1 draws in two phases, as hzb",
    },
    OptionInfo {
        name: "factor",
        default: "4",
        values: "2..=16",
        help: "how many times farther than the range before it each range reaches",
    },
    OptionInfo {
        name: "boxes",
        default: "true",
        values: "true|false",
        help: "what the last frame did not see must show by its rasterised box too, not by the pyramid alone",
    },
    OptionInfo {
        name: "fronts",
        default: "all",
        values: "none|objects|all",
        help: "what its footprint does not hide is tested by the depths of its faces at up to 256 texels: objects, or blocks of them too",
    },
    OptionInfo {
        name: "small",
        default: "6",
        values: "0..=1000000",
        help: "objects of no more triangles (6: as many as a box shows) are drawn without a test of their box",
    },
    OptionInfo {
        name: "finest",
        default: "2",
        values: "1..=3",
        help: "finest level of the pyramid: a texel is 2, 4 or 8 pixels a side",
    },
    OptionInfo {
        name: "every",
        default: "8",
        values: "1..=64",
        help: "how many frames from one that finds out by the item buffer what is still seen to the next; what comes into view is added",
    },
    OptionInfo {
        name: "texels",
        default: "8",
        values: "2..=16",
        help: "pyramid texels a footprint may touch in each direction: more is tighter and slower",
    },
];

/// Frames of an unchanged view after which the lists hold: what is hidden leaves the list of what was seen one frame after it is drawn,
/// and what it had let through may leave in the next two.
const SETTLED_AFTER: u32 = 4;

/// Rays tell more than the last frame where more of the picture than this is new.
const STALE_SHARE: f64 = 0.5;

/// Parts of the frame by step.
const PARTS: [&str; MOST_STEP_RANGES as usize + 1] = ["step 0", "step 1", "step 2", "step 3", "step 4", "step 5"];

struct Iterative {
    gpu: Gpu,
    /// Who was seen, by object. What is drawn is added at once: a step that looked at it looks at no object of its ranges again.
    seen: Buffer<u32>,
    /// What is in the list of step 0, by object, where there is a single range.
    ahead: Buffer<u32>,
    /// That list serves the next frame too.
    ahead_holds: bool,
    /// The world's winding revision when that list was written.
    ahead_winding: u64,
    steps: Steps,
    seeds: Option<Seeds>,
    pyramid: Option<Pyramid>,
    hurry: Hurry,
    finest: u32,
    every: u32,
    /// Frames until what was seen is looked at again.
    until_filtering: u32,
    /// Ranges of the last frame that ran.
    ranges: u32,
    /// The first step of that frame.
    first_step: u32,
    /// Nothing was seen before this frame.
    afresh: bool,
    /// Nor before the last one.
    was_afresh: bool,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world, options) = (setup.gpu, setup.world, setup.options);
    Ok(Box::new(Iterative {
        gpu: gpu.clone(),
        seen: Buffer::new(gpu, "hzb.seen", world.len(), Placement::Storage)?,
        ahead: Buffer::new(gpu, "hzb.ahead", world.len(), Placement::Storage)?,
        ahead_holds: false,
        ahead_winding: 0,
        steps: Steps::new(gpu, world, options)?,
        seeds: Seeds::new(gpu, world, options)?,
        pyramid: None,
        hurry: Hurry::new(options.text("ranges").parse().ok(), world),
        finest: options.number("finest"),
        every: options.number("every"),
        until_filtering: 0,
        ranges: 1,
        first_step: 0,
        afresh: true,
        was_afresh: false,
        still: Still::new(options).settled_after(SETTLED_AFTER),
    }))
}

impl Method for Iterative {
    fn needs_items(&self, world: &World, view: &View) -> bool {
        self.is_filtering_due(world, view) && !self.still.would_hold(world, view)
    }

    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        let filters = self.is_filtering_due(world, view);
        if self.still.holds(world, view) {
            return self.same_again(f, world, view, target);
        }
        self.afresh = self.starts_afresh(view);
        let pyramid = Pyramid::sized(&mut self.pyramid, &self.gpu, target.size, self.finest, self.steps.texels())?;
        self.ranges = self.hurry.ranges(view);
        // Where the last frame tells little, rays tell of what stands in front, and then one range will do.
        let casts = self.seeds.is_some() && (self.afresh || self.ranges > 1);
        if casts {
            self.ranges = self.hurry.fixed().unwrap_or(1);
        }
        self.first_step = if self.afresh && !casts { 1 } else { 0 };
        self.until_filtering = match (filters, self.afresh) {
            (true, _) => self.every - 1,
            (false, true) => 0,
            (false, false) => self.until_filtering - 1,
        };
        self.steps.look(world, view, depth_plane(view), self.ranges, pyramid)?;

        if self.afresh {
            f.fill("hzb/forget_seen", &self.seen, 0);
        }
        match &mut self.seeds {
            Some(seeds) if casts => seeds.cast(f, world, view, self.seen.all())?, // 1. what stands in front counts as seen
            Some(seeds) => seeds.skip(f, "the last frame tells"),
            None => {}
        }
        self.steps.measure(f, world, self.ranges); // 2. where each block of objects lies along the view
        let in_one = self.ranges == 1 && self.first_step == 0;
        // Commands of the list draw the wrong side of an object that has turned inside out since.
        let same_winding =
            std::mem::replace(&mut self.ahead_winding, world.winding_revision()) == world.winding_revision();
        let same_list = in_one && self.ahead_holds && same_winding && !casts;
        let ahead = in_one.then(|| self.ahead.all());
        if in_one && !same_list {
            f.fill("hzb/clear_ahead", &self.ahead, 0);
        }
        for number in self.first_step..=self.ranges {
            f.part(PARTS[number as usize]);
            let step = Step::new(number, number > self.first_step, self.seen.all(), ahead);
            if step.behind {
                match number - self.first_step {
                    1 => pyramid.reduce(f, target), // 3. farthest depth of all drawn so far
                    _ => pyramid.reduce_if(f, target, self.steps.reductions()), // if the last step drew anything
                }
            }
            if number == 0 && same_list {
                Steps::skip_finding(f, "an earlier frame's list serves");
            } else {
                self.steps.find(f, world, pyramid, &step); // 4. what is due and not hidden: seen of this range, unseen of the one before
                self.steps.test_boxes(f, world, &step, target); // 5. of what was not seen, only what shows by its box
            }
            self.steps.draw(f, world, &step, view, target); // 6. draw it, and go on to the next range
        }
        self.ahead_holds = in_one && !filters;
        f.part("");
        self.filter(f, filters, target)?; // 7. every few frames: who owns a pixel
        self.was_afresh = std::mem::take(&mut self.afresh);
        Ok(())
    }

    fn work(&self) -> Result<Work> {
        let boxes = self.steps.read_tested()?.len() as u64;
        let refits = self.seeds.as_ref().map_or(0, Seeds::refitted);
        Ok(Work { boxes, refits, ..Work::default() })
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        let bounds = world.host_bounds();
        let singles = self.steps.read_tested()?.into_iter().map(|object| bounds[object]).collect();
        Ok(Some(TestedBoxes { groups: Vec::new(), singles }))
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        self.ahead_holds = false;
        self.hurry.forget();
        self.afresh = true;
        self.was_afresh = false;
        self.until_filtering = 0;
        if let Some(seeds) = &mut self.seeds {
            seeds.forget();
        }
        Ok(self.seen.write(&vec![0; self.seen.len()])?)
    }
}

impl Iterative {
    /// What was seen before a cut is no better than the rest.
    fn starts_afresh(&self, view: &View) -> bool {
        self.afresh || self.hurry.is_cut(view) || (self.seeds.is_some() && self.hurry.new_share(view) > STALE_SHARE)
    }

    /// Every few frames, at a cut, and while nothing changes: then how long that lasts does not show in what follows. Where cut follows cut it
    /// would be in vain: it waits for the first frame that is none.
    fn is_filtering_due(&self, world: &World, view: &View) -> bool {
        if self.starts_afresh(view) {
            return !self.was_afresh;
        }
        self.until_filtering == 0 || self.still.same(world, view)
    }

    /// What is seen is whoever owns a pixel of the item buffer (EOVC thesis III.6.2).
    fn filter(&self, f: &mut Frame, filters: bool, target: &Target) -> Result<()> {
        if !filters {
            f.skip(eovc::FilterOccluders::INFO.name, "filtered a few frames ago");
            return Ok(());
        }
        let needs = || Error::Missing {
            method: "hzb-iterative",
            needs: "the item buffer to find out what is seen; bind it".into(),
        };
        let owners = target.item.ok_or_else(needs)?;
        f.fill("hzb/clear_seen", &self.seen, 0);
        filter_occluders(f, owners, target.size, self.seen.all());
        Ok(())
    }

    /// Camera and objects unchanged: the last frame's lists hold. In a single range the first is who owned a pixel in the frame before it,
    /// so that what the others hold shows nowhere.
    fn same_again(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        let stages = [
            hzb::MeasureBlocks::INFO,
            hzb::TestBlocks::INFO,
            hzb::ListBlocks::INFO,
            hzb::TestObjects::INFO,
            hzb::ScanBlocks::INFO,
            hzb::WriteBlocks::INFO,
            hzb::TestBoxes::INFO,
            eovc::FilterOccluders::INFO,
        ];
        stages.iter().for_each(|stage| f.skip(stage.name, Still::REASON));
        Pyramid::skip(f, Still::REASON);
        self.steps.test_none();
        if let Some(seeds) = &mut self.seeds {
            seeds.skip(f, Still::REASON);
        }
        let last_step = if self.ranges == 1 && self.first_step == 0 { 0 } else { self.ranges };
        for number in self.first_step..=last_step {
            f.part(PARTS[number as usize]);
            let step = Step::new(number, number > self.first_step, self.seen.all(), None);
            self.steps.draw(f, world, &step, view, target);
        }
        f.part("");
        Ok(())
    }
}
