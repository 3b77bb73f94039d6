//! `query-wait`: the naive draw-and-wait approach (GPU Gems 29.3.1; Zachmann 2008). Objects near to far, in batches: the boxes of one
//! are queried, the host waits for the answers, and what shows is drawn and hides what comes next.

use super::hierarchy::{distance, Place};
use super::recording::Asking;
use super::MIN_PIXELS_OPTION;
use crate::world::Still;
use crate::{Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Frame, Target};
use shaders::types::{Bounds, OBJECT_ALWAYS_KEPT};

/// How many boxes are queried before the host waits: the abscissa of Zachmann's plot.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    MIN_PIXELS_OPTION,
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
    revision: u64,
}

impl HostBounds {
    pub(super) fn new(world: &World) -> Result<Self> {
        Ok(HostBounds { bounds: world.read_bounds()?, revision: world.bounds_revision() })
    }

    /// Objects in view, near to far, each with its place; those that are always kept come first.
    pub(super) fn near_to_far(&mut self, world: &World, view: &View) -> Vec<(u32, Place)> {
        self.follow(world);
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
        found.into_iter().map(|(_, object, place)| (object, place)).collect()
    }

    fn follow(&mut self, world: &World) {
        if self.revision == world.bounds_revision() {
            return;
        }
        self.revision = world.bounds_revision();
        world.moving_bounds().for_each(|(object, bounds)| self.bounds[object as usize] = bounds);
    }
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    Ok(Box::new(QueryWait {
        on: Asking::new(setup, "query-wait")?,
        bounds: HostBounds::new(setup.world)?,
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
        let sorted = self.bounds.near_to_far(world, view); // 1. objects in view, near to far
        let mut frame = self.on.begin(f, (world, view), target, None)?;
        for batch in sorted.chunks(self.batch) {
            let mut asked = batch.iter().filter(|(_, place)| *place == Place::Testable);
            asked.try_for_each(|(object, _)| frame.ask(&[*object]))?; // 2. query the boxes of a batch
            let mut answers = frame.wait()?.into_iter(); // 3. wait for the answers
            for (object, place) in batch {
                if *place == Place::Near || answers.next().unwrap_or(true) {
                    frame.draw(*object)?; // 4. draw what shows
                }
            }
        }
        frame.end()
    }

    fn work(&self) -> Result<Work> {
        Ok(self.on.work())
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        let singles = self.on.tested().iter().map(|object| world.host_bounds()[*object as usize]).collect();
        Ok(Some(TestedBoxes { groups: Vec::new(), singles }))
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        Ok(())
    }
}
