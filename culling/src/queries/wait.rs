//! `query-wait`: the naive draw-and-wait approach (GPU Gems 29.3.1; Zachmann 2008). Objects near to far, in batches: the boxes of one
//! are queried, the host waits for the answers, and what shows is drawn and hides what comes next.

use super::hierarchy::distance;
use super::place::Place;
use super::recording::{Asking, Numbered};
use super::several::{SeveralBoxes, BOXES_OPTION};
use super::MIN_PIXELS_OPTION;
use crate::world::Still;
use crate::{Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Frame, Target};
use shaders::types::{Bounds, OBJECT_ALWAYS_KEPT};
use std::ops::Range;

/// How many boxes are queried before the host waits: the abscissa of Zachmann's plot.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    MIN_PIXELS_OPTION,
    BOXES_OPTION,
    OptionInfo {
        name: "batch",
        default: "64",
        values: "1..=16384",
        help: "boxes queried before the host waits for the answers",
    },
];

struct QueryWait {
    on: Asking,
    bounds: HostBounds,
    batch: usize,
    still: Still,
}

/// Bounds as the device has them, kept on the host.
pub(super) struct HostBounds {
    bounds: Vec<Bounds>,
    several: Option<SeveralBoxes>,
    revision: u64,
}

/// An object whose one box is in view.
pub(super) struct InView {
    pub(super) object: u32,
    /// Where its boxes are: of several, none may be in view.
    pub(super) place: Place,
    /// Their numbers.
    pub(super) boxes: Range<u32>,
}

impl HostBounds {
    pub(super) fn new(setup: &Setup<'_>) -> Result<Self> {
        let (bounds, revision) = (setup.world.read_bounds()?, setup.world.bounds_revision());
        Ok(HostBounds { bounds, several: SeveralBoxes::new(setup)?, revision })
    }

    /// Objects in view, near to far, each with its place; those that are always kept come first. Their order does not depend on how many
    /// boxes they have.
    pub(super) fn near_to_far(&mut self, world: &World, view: &View) -> Result<Vec<InView>> {
        self.follow(world)?;
        let (cull, eye) = (view.cull(), view.pose.position);
        let key = |object: usize, bound: &Bounds| match bound.flags & OBJECT_ALWAYS_KEPT {
            0 => distance(&world.host_bounds()[object], eye),
            _ => 0.0,
        };
        let mut found: Vec<_> = self
            .bounds
            .iter()
            .enumerate()
            .map(|(object, bound)| (object, bound, Place::of(bound, &cull)))
            .filter(|(_, _, place)| *place != Place::Outside)
            .map(|(object, bound, place)| (key(object, bound), object as u32, place))
            .collect();
        found.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        let in_view = |(_, object, place)| match &self.several {
            None => InView { object, place, boxes: object..object + 1 },
            Some(several) => InView { object, place: several.place(object, &cull), boxes: several.of(object) },
        };
        Ok(found.into_iter().map(in_view).collect())
    }

    fn follow(&mut self, world: &World) -> Result<()> {
        if self.revision != world.bounds_revision() {
            self.revision = world.bounds_revision();
            world.moving_bounds().for_each(|(object, bounds)| self.bounds[object as usize] = bounds);
        }
        self.several.as_mut().map_or(Ok(()), |several| several.follow(world))
    }

    /// What the boxes' numbers mean.
    pub(super) fn numbered(&self, world: &World) -> Numbered {
        let boxes = self.several.as_ref().map_or_else(|| world.bounds(), SeveralBoxes::on_device);
        Numbered { nodes: None, boxes }
    }

    /// Boxes by number, for pictures.
    pub(super) fn shown(&self, world: &World, boxes: &[u32]) -> TestedBoxes {
        let one = |number: &u32| match &self.several {
            None => world.host_bounds()[*number as usize],
            Some(several) => several.aabb(*number),
        };
        TestedBoxes { groups: Vec::new(), singles: boxes.iter().map(one).collect() }
    }
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    Ok(Box::new(QueryWait {
        on: Asking::new(setup, "query-wait")?,
        bounds: HostBounds::new(setup)?,
        batch: setup.options.number("batch") as usize,
        still: Still::new(setup.options),
    }))
}

impl Method for QueryWait {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.still.holds(world, view) {
            f.skip("queries/test_objects", Still::REASON);
            return self.on.draw_again(f, world, view, target);
        }
        let sorted = self.bounds.near_to_far(world, view)?; // 1. objects in view, near to far
        let mut frame = self.on.begin(f, (world, view), target, self.bounds.numbered(world))?;
        for batch in sorted.chunks(self.batch) {
            let mut asked = batch.iter().filter(|found| found.place == Place::Testable);
            asked.try_for_each(|found| frame.ask(found.boxes.clone()))?; // 2. query the boxes of a batch
            let mut answers = frame.wait()?.into_iter(); // 3. wait for the answers
            for found in batch {
                let shows = match found.place {
                    Place::Outside => false,
                    Place::Near => true,
                    Place::Testable => answers.next().unwrap_or(true),
                };
                if shows {
                    frame.draw(found.object)?; // 4. draw what shows
                }
            }
        }
        frame.end()
    }

    fn work(&self) -> Result<Work> {
        Ok(self.on.work())
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        Ok(Some(self.bounds.shown(world, self.on.tested())))
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        Ok(())
    }
}
