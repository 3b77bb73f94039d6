//! Queries with one defect: the harness must say so.

use super::{gpu, laws, worlds};
use culling::boxes::BoxShape;
use culling::roc::twin::selection;
use culling::{DrawList, Method, Setup, View, World};
use engine::{Buffer, Frame, IndexedIndirect, OcclusionQueries, Placement, Queried, Target};
use harness::laws::Make;
use harness::Case;
use shaders::queries;
use shaders::types::{Bounds, DrawCommand, SELECT_SHOWN, SELECT_TESTED};

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    Nothing,
    /// Each object gets its neighbour's answer.
    AnswersShifted,
    /// Answers are those of the frame before.
    StaleAnswers,
    ShrunkBoxes,
    /// Boxes that reach the near plane are asked about.
    NearCrossingAsked,
    /// The query of the last box is not asked.
    LastNotAsked,
}

/// Draws the first half of what is in view, asks about the boxes of the rest, and draws what shows.
struct Broken {
    defect: Defect,
    shape: BoxShape,
    bounds: Vec<Bounds>,
    tested: Buffer<Bounds>,
    listed: Buffer<u32>,
    commands: Buffer<DrawCommand>,
    queries: OcclusionQueries,
    flags: [Buffer<u32>; 2],
    lists: [DrawList; 2],
    /// By object: the last answer.
    last: Vec<u64>,
}

fn broken(setup: &Setup<'_>, defect: Defect) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let bounds = world.read_bounds()?;
    let mut tested = bounds.clone();
    if defect == Defect::ShrunkBoxes {
        tested.iter_mut().for_each(|bound| bound.half_extent = bound.half_extent.map(|half| 0.3 * half));
    }
    let flags = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Upload);
    Ok(Box::new(Broken {
        defect,
        shape: BoxShape::new(gpu, "broken", 1)?,
        tested: Buffer::with_data(gpu, "broken.bounds", &tested, Placement::Storage)?,
        bounds,
        listed: flags("broken.listed")?,
        commands: Buffer::new(gpu, "broken.commands", world.len(), Placement::Upload)?,
        queries: OcclusionQueries::new(gpu, "broken.queries", world.len() as u32)?,
        flags: [flags("broken.first")?, flags("broken.rest")?],
        lists: [DrawList::new(gpu, "broken.early", world)?, DrawList::new(gpu, "broken.late", world)?],
        last: vec![1; world.len()],
    }))
}

impl Broken {
    fn ask(&mut self, f: &mut Frame, asked: &[u32], target: &Target) -> culling::Result<Vec<u64>> {
        self.listed.write(asked)?;
        let command = |index: usize| DrawCommand { instance_count: 1, ..BoxShape::no_boxes(index as u32) };
        self.commands.write(&(0..asked.len()).map(command).collect::<Vec<_>>())?;
        let count = asked.len() as u32 - u32::from(self.defect == Defect::LastNotAsked && !asked.is_empty());
        let draw = IndexedIndirect { count: None, ..self.shape.draw(self.commands.all(), count) };
        let stage =
            queries::TestObjects { bounds: self.tested.all(), listed: self.listed.all(), views: self.shape.view() };
        f.query_boxes(stage, draw, Queried { queries: &self.queries, first: 0 }, &target.test_only());
        let mut samples = f.wait_for_queries(&self.queries, 0..count)?;
        samples.resize(asked.len(), 0);
        Ok(samples)
    }
}

impl Method for Broken {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        self.shape.look(view)?;
        let first: Vec<u32> = (0..world.len()).map(|object| u32::from(object < world.len() / 2)).collect();
        self.flags[0].write(&first)?;
        self.lists[0].pack(f, world, self.flags[0].all());
        world.draw(f, &self.lists[0], view, target);
        f.submit_and_wait()?;
        let placed = self.bounds.iter().map(|bound| selection(bound, 0, &view.cull()));
        let placed: Vec<u32> =
            placed
                .map(|place| {
                    if self.defect == Defect::NearCrossingAsked && place == SELECT_SHOWN {
                        SELECT_TESTED
                    } else {
                        place
                    }
                })
                .collect();
        let rest = (0..world.len() as u32).filter(|object| first[*object as usize] == 0);
        let asked: Vec<u32> = rest.filter(|object| placed[*object as usize] == SELECT_TESTED).collect();
        let mut samples = self.ask(f, &asked, target)?;
        if self.defect == Defect::AnswersShifted && !samples.is_empty() {
            samples.rotate_right(1);
        }
        for (object, samples) in asked.iter().zip(&mut samples) {
            let before = std::mem::replace(&mut self.last[*object as usize], *samples);
            *samples = if self.defect == Defect::StaleAnswers { before } else { *samples };
        }
        let mut late: Vec<u32> =
            first.iter().zip(&placed).map(|(first, place)| u32::from(*first == 0 && *place == SELECT_SHOWN)).collect();
        asked.iter().zip(&samples).for_each(|(object, samples)| late[*object as usize] = u32::from(*samples > 0));
        self.flags[1].write(&late)?;
        self.lists[1].pack(f, world, self.flags[1].all());
        world.draw(f, &self.lists[1], view, target);
        Ok(())
    }
}

fn caught(wrong: Make, case: &Case) {
    laws::a_defect_alone_loses_objects(&gpu(), |setup| broken(setup, Defect::Nothing), wrong, case);
}

#[test]
fn shifted_answers_are_caught() {
    caught(|setup| broken(setup, Defect::AnswersShifted), &worlds::walled(100));
}

#[test]
fn stale_answers_are_caught() {
    caught(|setup| broken(setup, Defect::StaleAnswers), &worlds::walled(150));
}

#[test]
fn shrunk_boxes_are_caught() {
    caught(|setup| broken(setup, Defect::ShrunkBoxes), &worlds::walled(100));
}

#[test]
fn boxes_asked_at_the_near_plane_are_caught() {
    caught(|setup| broken(setup, Defect::NearCrossingAsked), &worlds::special::stepping_into_boxes());
}

#[test]
fn a_query_that_is_not_asked_is_caught() {
    caught(|setup| broken(setup, Defect::LastNotAsked), &worlds::walled(101));
}
