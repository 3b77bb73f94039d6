//! `query-lag`: answers are read one frame later (GPU Gems 29.4). What was visible is drawn, and queries itself; of what was not, the
//! box is queried. The host never waits, and what comes into view is missing for a frame.

use super::place::Place;
use super::recording::Asking;
use super::several::BOXES_OPTION;
use super::wait::{HostBounds, InView};
use super::MIN_PIXELS_OPTION;
use crate::{Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Frame, Target};

/// Why the method is not exact.
pub const LAGS: &str = "what comes into view is known, and drawn, one frame later";

/// How often what is visible is asked about.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::DETAIL_OPTION,
    MIN_PIXELS_OPTION,
    BOXES_OPTION,
    OptionInfo {
        name: "every",
        default: "1",
        values: "1..=64",
        help: "frames from one query of a visible object to the next; hidden ones are asked about in each",
    },
];

struct QueryLag {
    on: Asking,
    bounds: HostBounds,
    /// By object. Of what was out of view nothing is known: it counts as visible.
    visible: Vec<bool>,
    in_view: Vec<bool>,
    /// What the last frame asked about, in order.
    asked: Vec<u32>,
    every: u64,
    frame: u64,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let objects = setup.world.len();
    Ok(Box::new(QueryLag {
        on: Asking::new(setup, "query-lag")?,
        bounds: HostBounds::new(setup)?,
        visible: vec![true; objects],
        in_view: vec![false; objects],
        asked: Vec::new(),
        every: u64::from(setup.options.number("every")).max(1),
        frame: 0,
    }))
}

impl Method for QueryLag {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        self.check_last_answers()?; // 1. the query results of the last frame
        let mut sorted = self.bounds.near_to_far(world, view)?; // 2. opaque objects, near to far
        sorted.retain(|found| found.place != Place::Outside);
        self.forget_what_left(&sorted);
        let mut frame = self.on.begin(f, (world, view), target, self.bounds.numbered(world))?;
        for InView { object, place, boxes } in sorted {
            let due = (self.frame + u64::from(object)).is_multiple_of(self.every);
            match (place, self.visible[object as usize]) {
                // "Skip occlusion testing for models that are too near the viewer" (29.6.2): the eye may be inside the box.
                (Place::Near, _) => frame.draw(object)?,
                (_, true) if !due => frame.draw(object)?,
                (_, true) => {
                    frame.draw_and_ask(object)?; // 3. what was visible is drawn, and asks for itself
                    self.asked.push(object);
                }
                (_, false) => {
                    frame.ask(boxes)?; // 4. of what was not, the box, or boxes, are asked about
                    self.asked.push(object);
                }
            }
        }
        self.frame += 1;
        frame.end()
    }

    fn work(&self) -> Result<Work> {
        Ok(self.on.work())
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        Ok(Some(self.bounds.shown(world, self.on.tested())))
    }

    fn forget(&mut self) -> Result<()> {
        self.on.last_answers()?;
        self.asked.clear();
        self.visible.fill(true);
        self.in_view.fill(false);
        self.frame = 0;
        Ok(())
    }
}

impl QueryLag {
    fn check_last_answers(&mut self) -> Result<()> {
        let answers = self.on.last_answers()?;
        for (object, visible) in self.asked.drain(..).zip(answers) {
            self.visible[object as usize] = visible;
        }
        Ok(())
    }

    fn forget_what_left(&mut self, sorted: &[InView]) {
        let mut now = vec![false; self.visible.len()];
        for InView { object, .. } in sorted {
            now[*object as usize] = true;
            self.visible[*object as usize] |= !self.in_view[*object as usize];
        }
        self.in_view = now;
    }
}
