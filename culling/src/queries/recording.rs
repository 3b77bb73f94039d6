//! What a frame asks and draws, in the order in which the host decides it: runs of draws, runs of queries, and waits.

use crate::boxes::BoxShape;
use crate::world::Range;
use crate::{Error, Options, Result, Setup, View, Work, World};
use engine::{Buffer, Extra, Frame, IndexedIndirect, OcclusionQueries, Placement, Queried, Target};
use shaders::types::{Bounds, DrawCommand, TreeNode};
use shaders::{queries, BufferRef};

/// Queries that can be asked before answers must be waited for.
const MOST_QUERIES: u32 = 16_384;

/// Boxes that these can be asked about.
const MOST_BOXES: usize = 65_536;

/// Steps after which what was recorded is run: a submission times 4,095 stages.
const MOST_STEPS: usize = 3_000;

/// What the numbers of boxes mean.
pub(super) struct Numbered {
    /// First those of nodes, if there are any,
    pub(super) nodes: Option<BufferRef<TreeNode>>,
    /// then those of boxes of objects.
    pub(super) boxes: BufferRef<Bounds>,
}

/// What is being recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Run {
    Nothing,
    /// Objects that are drawn in the same way.
    Draws(Option<Range>),
    /// Such objects, each counted by a query.
    QueriedDraws(Option<Range>),
    /// Boxes, each counted by a query.
    Boxes,
}

/// A method's queries, box lists and draw commands. The host writes them, and the device reads them once it is told to run.
pub(super) struct Asking {
    shape: BoxShape,
    listed: Buffer<u32>,
    box_commands: Buffer<DrawCommand>,
    commands: Buffer<DrawCommand>,
    queries: OcclusionQueries,
    /// The number of objects of the world.
    objects: usize,
    least_samples: u64,
    /// Since the last wait: boxes, the command of each query about boxes, and how many queries there are of both kinds.
    boxes: Vec<u32>,
    asked: Vec<DrawCommand>,
    pending: u32,
    answers: Vec<bool>,
    /// Of the frame.
    drawn: Vec<DrawCommand>,
    tested: Vec<u32>,
    work: Work,
    run: Run,
    /// Where the run began, in `drawn` or `asked`, and its first query.
    run_from: usize,
    run_query: u32,
}

impl Asking {
    /// For the objects of a world.
    ///
    /// # Errors
    /// Samples are to be counted on a device that only says whether there were any.
    pub(super) fn new(setup: &Setup<'_>, name: &'static str) -> Result<Self> {
        let (gpu, upload) = (setup.gpu, Placement::Upload);
        Ok(Asking {
            shape: BoxShape::new(gpu, name, 1)?,
            listed: Buffer::new(gpu, &format!("{name}.listed"), MOST_BOXES, upload)?,
            box_commands: Buffer::new(gpu, &format!("{name}.box_commands"), MOST_QUERIES as usize, upload)?,
            commands: Buffer::new(gpu, &format!("{name}.commands"), setup.world.len(), upload)?,
            queries: OcclusionQueries::new(gpu, &format!("{name}.queries"), MOST_QUERIES)?,
            objects: setup.world.len(),
            least_samples: least_samples(setup.options, gpu.has(Extra::OcclusionQueryPrecise), name)?,
            boxes: Vec::new(),
            asked: Vec::new(),
            pending: 0,
            answers: Vec::new(),
            drawn: Vec::new(),
            tested: Vec::new(),
            work: Work::default(),
            run: Run::Nothing,
            run_from: 0,
            run_query: 0,
        })
    }

    /// Answers to what the last frame asked and did not wait for, in the order of asking; those that it had to wait for before its end, as
    /// there was no room, come first. That frame is done: no stall.
    pub(super) fn last_answers(&mut self) -> Result<Vec<bool>> {
        let samples = self.queries.read(0..std::mem::take(&mut self.pending))?;
        let mut answers = std::mem::take(&mut self.answers);
        answers.extend(samples.iter().map(|samples| *samples >= self.least_samples));
        Ok(answers)
    }

    /// Begins a frame. Boxes are numbered as those of `asked` are.
    pub(super) fn begin<'a>(
        &'a mut self,
        f: &'a mut Frame,
        (world, view): (&'a World, &'a View),
        target: &'a Target,
        asked: Numbered,
    ) -> Result<Recording<'a>> {
        assert_eq!(self.objects, world.len(), "this list was made for another world: make the method again");
        self.shape.look(view)?;
        self.drawn.clear();
        self.tested.clear();
        self.boxes.clear();
        self.asked.clear();
        self.pending = 0;
        self.answers.clear();
        self.work = Work::default();
        self.run = Run::Nothing;
        Ok(Recording { f, world, view, target, asked, on: self })
    }

    /// Draws what the last frame drew, in the same order.
    pub(super) fn draw_again(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        assert_eq!(self.objects, world.len(), "this list was made for another world: make the method again");
        self.tested.clear();
        self.work = Work::default();
        let mut first = 0;
        let kind = |command: &DrawCommand| kind_of(world, command.first_instance);
        for run in self.drawn.chunk_by(|one, next| kind(one) == kind(next)) {
            self.draw_part(f, (world, view, target), first..first + run.len(), None);
            first += run.len();
            if f.recorded().len() > MOST_STEPS {
                f.submit_and_wait()?;
            }
        }
        Ok(())
    }

    /// What the last frame did.
    pub(super) fn work(&self) -> Work {
        Work { boxes: self.tested.len() as u64, ..self.work }
    }

    /// The boxes that the last frame tested, by number.
    pub(super) fn tested(&self) -> &[u32] {
        &self.tested
    }

    /// Draws some of what was listed, all in the same way.
    fn draw_part(
        &self,
        f: &mut Frame,
        (world, view, target): (&World, &View, &Target),
        part: std::ops::Range<usize>,
        first_query: Option<u32>,
    ) {
        let Some(kind) = kind_of(world, self.drawn[part.start].first_instance) else { return };
        let range = Range { count: part.len() as u32, ..kind };
        let draw = world.multi_draw(&range, part_of(&self.commands, part.start, part.len()), None);
        match first_query {
            None => world.draw_indirect(f, draw, view, target),
            Some(first) => world.query_indirect(f, draw, Queried { queries: &self.queries, first }, view, target),
        }
    }
}

/// Samples that a query must count for its box to count as visible.
fn least_samples(options: &Options, counts: bool, name: &'static str) -> Result<u64> {
    let least = u64::from(options.number(super::MIN_PIXELS_OPTION.name)).max(1);
    if least > 1 && !counts {
        let needs = "'occlusionQueryPrecise' of the device to count samples; leave min-pixels at 1".to_owned();
        return Err(Error::Missing { method: name, needs });
    }
    Ok(least)
}

/// How an object is drawn, as a range of none.
fn kind_of(world: &World, object: u32) -> Option<Range> {
    let range = world.ranges().iter().find(|range| (range.first..range.first + range.count).contains(&object));
    range.map(|range| Range { first: 0, count: 0, ..*range })
}

fn part_of(commands: &Buffer<DrawCommand>, first: usize, count: usize) -> BufferRef<DrawCommand> {
    BufferRef { size: (count * size_of::<DrawCommand>()) as u64, ..commands.all().from(first) }
}

/// A frame in the making: what is drawn and asked is recorded in this order.
pub(super) struct Recording<'a> {
    f: &'a mut Frame,
    world: &'a World,
    view: &'a View,
    target: &'a Target,
    asked: Numbered,
    on: &'a mut Asking,
}

impl Recording<'_> {
    /// Draws an object.
    pub(super) fn draw(&mut self, object: u32) -> Result<()> {
        self.go_on(Run::Draws(kind_of(self.world, object)))?;
        self.on.drawn.push(self.world.command(object));
        Ok(())
    }

    /// Draws an object and asks how much of it passes the depth test.
    pub(super) fn draw_and_ask(&mut self, object: u32) -> Result<()> {
        self.make_room(0)?;
        self.go_on(Run::QueriedDraws(kind_of(self.world, object)))?;
        self.on.drawn.push(self.world.command(object));
        self.on.pending += 1;
        self.on.work.queries += 1;
        Ok(())
    }

    /// Asks whether any of some boxes shows.
    pub(super) fn ask(&mut self, boxes: impl ExactSizeIterator<Item = u32>) -> Result<()> {
        self.make_room(boxes.len())?;
        self.go_on(Run::Boxes)?;
        let command = BoxShape::no_boxes(self.on.boxes.len() as u32);
        self.on.asked.push(DrawCommand { instance_count: boxes.len() as u32, ..command });
        self.on.boxes.extend(boxes);
        self.on.pending += 1;
        self.on.work.queries += 1;
        Ok(())
    }

    /// Runs what was recorded and waits for the answers to all that was asked since the last wait, in the order of asking.
    pub(super) fn wait(&mut self) -> Result<Vec<bool>> {
        self.collect()?;
        Ok(std::mem::take(&mut self.on.answers))
    }

    /// Records the rest of the frame. What was asked and not waited for can be read in the next.
    pub(super) fn end(mut self) -> Result<()> {
        self.end_run();
        self.upload()
    }

    fn collect(&mut self) -> Result<()> {
        self.end_run();
        if self.on.pending == 0 {
            return Ok(());
        }
        self.upload()?;
        let samples = self.f.wait_for_queries(&self.on.queries, 0..self.on.pending)?;
        self.on.work.waits += 1;
        let least = self.on.least_samples;
        self.on.answers.extend(samples.iter().map(|samples| *samples >= least));
        self.on.pending = 0;
        self.on.boxes.clear();
        self.on.asked.clear();
        Ok(())
    }

    /// Answers are waited for if there is no room for one more query.
    fn make_room(&mut self, boxes: usize) -> Result<()> {
        if self.on.pending == MOST_QUERIES || self.on.boxes.len() + boxes > MOST_BOXES {
            self.collect()?;
        }
        Ok(())
    }

    fn go_on(&mut self, run: Run) -> Result<()> {
        if self.on.run == run {
            return Ok(());
        }
        self.end_run();
        if self.f.recorded().len() > MOST_STEPS {
            self.upload()?;
            self.f.submit_and_wait()?;
            self.on.work.waits += 1;
        }
        self.on.run = run;
        self.on.run_from = if run == Run::Boxes { self.on.asked.len() } else { self.on.drawn.len() };
        self.on.run_query = self.on.pending;
        Ok(())
    }

    fn end_run(&mut self) {
        let run = std::mem::replace(&mut self.on.run, Run::Nothing);
        let from = self.on.run_from;
        match run {
            Run::Nothing => return,
            Run::Draws(_) => self.draw_part(from, None),
            Run::QueriedDraws(_) => self.draw_part(from, Some(self.on.run_query)),
            Run::Boxes => self.test_boxes(from),
        }
        // Colour and depth are written or not, pipeline and attachments are others: from one run to the next.
        self.on.work.state_changes += 1;
    }

    fn draw_part(&mut self, from: usize, first_query: Option<u32>) {
        self.on.draw_part(self.f, (self.world, self.view, self.target), from..self.on.drawn.len(), first_query);
    }

    fn test_boxes(&mut self, from: usize) {
        let on = &mut *self.on;
        let asked = &on.asked[from..];
        let part = part_of(&on.box_commands, from, asked.len());
        let draw = IndexedIndirect { count: None, ..on.shape.draw(part, asked.len() as u32) };
        let queried = Queried { queries: &on.queries, first: on.run_query };
        let (listed, views) = (on.listed.all(), on.shape.view());
        on.tested.extend_from_slice(&on.boxes[asked[0].first_instance as usize..]);
        let (bounds, target) = (self.asked.boxes, self.target.test_only());
        match self.asked.nodes {
            Some(nodes) => {
                self.f.query_boxes(queries::TestNodes { nodes, listed, views, bounds }, draw, queried, &target);
            }
            None => self.f.query_boxes(queries::TestObjects { bounds, listed, views }, draw, queried, &target),
        }
    }

    /// The host's lists to where the device reads them; nothing runs meanwhile.
    fn upload(&mut self) -> Result<()> {
        self.on.listed.write(&self.on.boxes)?;
        self.on.box_commands.write(&self.on.asked)?;
        Ok(self.on.commands.write(&self.on.drawn)?)
    }
}
