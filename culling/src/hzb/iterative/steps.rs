//! What a step looks at and draws: blocks due, objects found, their commands. Work follows what is due, not the number of objects.

use crate::boxes::BoxShape;
use crate::hzb::Pyramid;
use crate::world::{LastToFirst, View, World};
use crate::{Options, Result};
use engine::{Buffer, Frame, Gpu, IndexedIndirect, Placement, Target};
use shaders::types::{BlockSpan, DrawCommand, StepView, LISTED_GRID, LISTED_HEADER, MOST_STEP_RANGES, STEP_TESTED};
use shaders::{hzb, BufferRef, ResourceId, Stage};

/// Reductions of the largest picture: three levels each.
const MOST_REDUCTIONS: usize = 6;

/// What is tested against the depths of its faces.
#[derive(Clone, Copy)]
struct FrontTests {
    blocks: bool,
    objects: bool,
}

/// A step of a frame.
pub(super) struct Step {
    pub number: u32,
    /// Something was drawn before it.
    pub behind: bool,
    /// What was seen before, by object: it is due a step earlier.
    pub seen: BufferRef<u32>,
    /// What is drawn in this step is noted here, by object.
    pub drawn: BufferRef<u32>,
}

impl Step {
    /// `seen`: what was seen before, by object; what is drawn is added. `ahead`, where all is in one range: what is in the list of step 0; all
    /// else is tested in step 1, seen or not.
    pub fn new(number: u32, behind: bool, seen: BufferRef<u32>, ahead: Option<BufferRef<u32>>) -> Self {
        let [seen, drawn] = match (ahead, number) {
            (Some(ahead), 0) => [seen, ahead],
            (Some(ahead), _) => [ahead, seen],
            (None, _) => [seen, seen],
        };
        Step { number, behind, seen, drawn }
    }
}

/// Lists and what they are made with. A step's commands have room for every object, so that they cannot overflow.
pub(super) struct Steps {
    gpu: Gpu,
    view: Buffer<StepView>,
    spans: Buffer<BlockSpan>,
    /// Where the farthest block in view begins, and the nearest (its bits inverted).
    reach: Buffer<u32>,
    measured: bool,
    due: Buffer<u32>,
    blocks: Buffer<u32>,
    /// What a step makes of objects, by object of the blocks it lists: by step, but that the first two share theirs, as nothing lies behind the
    /// first.
    shown: Vec<Buffer<u32>>,
    /// Steps of the last frame that tested boxes.
    tested_in: Vec<u32>,
    counts: Buffer<u32>,
    starts: Buffer<u32>,
    commands: Vec<Buffer<DrawCommand>>,
    totals: Vec<Buffer<u32>>,
    boxes: Buffer<DrawCommand>,
    shape: BoxShape,
    /// What is drawn behind others leaves them what is as near: owners of pixels would take turns otherwise.
    order: LastToFirst,
    /// Grids of the pyramid's reductions, and the same where something was drawn.
    reductions: [Buffer<u32>; 2],
    small_indices: u32,
    tests_boxes: bool,
    fronts: FrontTests,
    share: f32,
    texels: u32,
    subgroup_size: u32,
    kinds: u32,
    /// The first command of each kind.
    firsts: Vec<u32>,
    world: ResourceId,
}

impl Steps {
    pub fn new(gpu: &Gpu, world: &World, options: &Options) -> Result<Self> {
        let (blocks, kinds) = (world.block_count() as usize, world.ranges().len());
        let words = |what: &str, len: usize| Buffer::new(gpu, &format!("hzb.{what}"), len, Placement::Storage);
        let most_steps = options.text("ranges").parse().unwrap_or(MOST_STEP_RANGES) + 1;
        let no_boxes: Vec<_> = world.ranges().iter().map(|range| BoxShape::no_boxes(range.first)).collect();
        let commands = |step| Buffer::new(gpu, &format!("hzb.commands{step}"), world.len(), Placement::Storage);
        Ok(Steps {
            gpu: gpu.clone(),
            view: Buffer::new(gpu, "hzb.step_view", 1, Placement::Upload)?,
            spans: Buffer::new(gpu, "hzb.spans", blocks, Placement::Storage)?,
            reach: words("reach", 2)?,
            measured: false,
            due: words("due", blocks)?,
            blocks: words("due_blocks", LISTED_HEADER as usize + blocks)?,
            shown: Vec::new(),
            tested_in: Vec::new(),
            counts: words("counts", kinds * blocks)?,
            starts: words("starts", kinds * blocks)?,
            commands: (0..most_steps).map(commands).collect::<std::result::Result<_, _>>()?,
            totals: (0..most_steps)
                .map(|step| words(&format!("totals{step}"), kinds))
                .collect::<std::result::Result<_, _>>()?,
            boxes: Buffer::with_data(gpu, "hzb.boxes", &no_boxes, Placement::Storage)?,
            shape: BoxShape::new(gpu, "hzb.boxes", kinds as u32)?,
            order: LastToFirst::new(gpu, world)?,
            reductions: [
                Buffer::new(gpu, "hzb.full_grids", 3 * MOST_REDUCTIONS, Placement::Upload)?,
                words("grids", 3 * MOST_REDUCTIONS)?,
            ],
            small_indices: 3 * options.number("small"),
            tests_boxes: options.flag("boxes"),
            fronts: FrontTests { blocks: options.text("fronts") == "all", objects: options.text("fronts") != "none" },
            share: 1.0 / options.number("factor").max(2) as f32,
            texels: options.number("texels"),
            subgroup_size: gpu.subgroup_size(),
            kinds: kinds as u32,
            firsts: world.ranges().iter().map(|range| range.first).collect(),
            world: world.id(),
        })
    }

    /// Pyramid texels a footprint may touch in each direction.
    pub fn texels(&self) -> u32 {
        self.texels
    }

    /// Gives the stages the frame's view.
    ///
    /// # Panics
    /// If the lists were made for another world: they would not have the room.
    pub fn look(
        &mut self,
        world: &World,
        view: &View,
        depth_plane: [f32; 4],
        range_count: u32,
        pyramid: &Pyramid,
    ) -> Result<()> {
        self.assert_made_for(world);
        let first_of = |kind: usize| world.ranges().get(kind).map_or(u32::MAX, |range| range.first);
        let all = StepView {
            view: view.cull(),
            depth_plane,
            object_count: world.len() as u32,
            block_count: world.block_count(),
            coarsest_level: pyramid.coarsest_level(),
            range_count,
            share: self.share,
            later_kinds: std::array::from_fn(|later| first_of(later + 1)),
        };
        while self.shown.len() < range_count as usize {
            self.shown.push(Buffer::new(&self.gpu, "hzb.shown", world.len(), Placement::Storage)?);
        }
        self.tested_in.clear();
        self.shape.look(view)?;
        self.reductions[0].write(&pyramid.grids())?;
        Ok(self.view.write(&[all])?)
    }

    /// Where blocks lie along the view, and between where they begin; in a single range nothing asks.
    pub fn measure(&mut self, f: &mut Frame, world: &World, range_count: u32) {
        self.measured = range_count > 1;
        if !self.measured {
            f.skip(hzb::MeasureBlocks::INFO.name, "a single range");
            return;
        }
        f.fill("hzb/clear_reach", &self.reach, 0);
        let measure = hzb::MeasureBlocks {
            bounds: world.block_bounds(),
            spans: self.spans.all(),
            reach: self.reach.all(),
            views: self.view.all(),
        };
        f.dispatch(measure, if world.is_empty() { 0 } else { world.block_count() });
    }

    /// Notes that a step's list holds.
    pub fn skip_finding(f: &mut Frame, reason: &'static str) {
        let stages = [
            hzb::TestBlocks::INFO,
            hzb::ListBlocks::INFO,
            hzb::TestObjects::INFO,
            hzb::ScanBlocks::INFO,
            hzb::WriteBlocks::INFO,
        ];
        stages.iter().for_each(|stage| f.skip(stage.name, reason));
    }

    /// Finds what is due in a step and not hidden, and writes its commands.
    pub fn find(&self, f: &mut Frame, world: &World, pyramid: &Pyramid, step: &Step) {
        if world.is_empty() {
            return;
        }
        let (reach, views, blocks) = (self.reach.all(), self.view.all(), self.blocks.all());
        let (levels, texels, block_count) = (pyramid.levels(), pyramid.texels(), world.block_count());
        let finest_level = pyramid.finest_level();
        let (footprint_texels, behind, number) = (self.texels, step.behind, step.number);
        let test = hzb::TestBlocks {
            bounds: world.block_bounds(),
            spans: self.spans.all(),
            reach,
            views,
            levels,
            pyramid: texels,
            due: self.due.all(),
            seen: step.seen,
            step: number,
            constants: hzb::TestBlocksConstants {
                footprint_texels,
                behind,
                measured: self.measured,
                fronts: self.fronts.blocks,
                finest_level,
            },
        };
        f.dispatch(test, block_count);
        let subgroup_size = self.subgroup_size;
        let (counts, kind_count) = (self.counts.all(), self.kinds);
        let constants = hzb::ListBlocksConstants { subgroup_size };
        f.dispatch_groups(
            hzb::ListBlocks { due: self.due.all(), blocks, counts, block_count, kind_count, constants },
            1,
        );
        let test = hzb::TestObjects {
            bounds: world.bounds(),
            seen: step.seen,
            reach,
            views,
            levels,
            pyramid: texels,
            blocks,
            shown: self.shown_in(step.number),
            counts,
            known: step.drawn,
            step: number,
            constants: hzb::TestObjectsConstants {
                footprint_texels,
                behind,
                boxes: self.tests_boxes,
                fronts: self.fronts.objects,
                kind_count,
                finest_level,
            },
        };
        f.dispatch_indirect(test, blocks);
        let (starts, totals) = (self.starts.all(), self.totals[number as usize].all());
        let constants = hzb::ScanBlocksConstants { subgroup_size };
        let [full_grids, grids] = [0, 1].map(|which: usize| self.reductions[which].all());
        let (boxes, reductions) = (self.boxes.all(), pyramid.grids().len() as u32 / 3);
        let scan = hzb::ScanBlocks {
            blocks,
            counts,
            starts,
            totals,
            boxes,
            full_grids,
            grids,
            block_count,
            kind_count,
            reductions,
            constants,
        };
        f.dispatch_groups(scan, 1);
        let write = hzb::WriteBlocks {
            blocks,
            shown: self.shown_in(step.number),
            counts,
            starts,
            views,
            object_meshes: world.object_meshes(),
            meshes: world.meshes(),
            commands: self.commands[number as usize].all(),
            visible: step.drawn,
            small_indices: self.small_indices,
            constants: hzb::WriteBlocksConstants { kind_count },
        };
        f.dispatch_indirect(write, blocks.from(LISTED_GRID as usize));
    }

    /// Rasterises the boxes of what a step found and the last frame did not see: whose show are drawn.
    pub fn test_boxes(&mut self, f: &mut Frame, world: &World, step: &Step, target: &Target) {
        if !self.tests_boxes || !step.behind {
            f.skip(hzb::TestBoxes::INFO.name, if self.tests_boxes { "nothing drawn before" } else { "turned off" });
            return;
        }
        self.tested_in.push(step.number);
        let commands = self.commands[step.number as usize].all();
        let test = hzb::TestBoxes {
            bounds: world.bounds(),
            commands,
            shown: self.shown_in(step.number),
            views: self.shape.view(),
            drawn: commands,
            visible: step.drawn,
        };
        if self.kinds > 0 {
            f.test_boxes(test, self.shape.draw(self.boxes.all(), self.kinds), &target.test_only());
        }
    }

    /// The objects whose boxes the last frame tested, step by step. The device must be idle.
    pub fn read_tested(&self) -> Result<Vec<usize>> {
        let mut tested = Vec::new();
        for &step in &self.tested_in {
            let (commands, totals) = (self.commands[step as usize].read()?, self.totals[step as usize].read()?);
            let shown = self.shown[step.saturating_sub(1) as usize].read()?;
            for (first, total) in self.firsts.iter().zip(totals) {
                let listed = commands[*first as usize..][..total as usize].iter();
                let objects = listed.map(|command| command.first_instance as usize);
                tested.extend(objects.filter(|object| shown[*object] == STEP_TESTED));
            }
        }
        Ok(tested)
    }

    /// Notes that a frame tests no boxes: nothing changed since the last one.
    pub fn test_none(&mut self) {
        self.tested_in.clear();
    }

    fn shown_in(&self, step: u32) -> BufferRef<u32> {
        self.shown[step.saturating_sub(1) as usize].all()
    }

    /// Grids of reductions, empty if the last step drew nothing.
    pub fn reductions(&self) -> BufferRef<u32> {
        self.reductions[1].all()
    }

    /// Draws what a step found.
    pub fn draw(&self, f: &mut Frame, world: &World, step: &Step, view: &View, target: &Target) {
        let target = if step.behind { target.keeping_ties() } else { *target };
        for draw in self.draws(world, step.number) {
            let draw = if step.behind { self.order.turned(draw) } else { draw };
            world.draw_indirect(f, draw, view, &target);
        }
    }

    /// The draws of what a step found, one a kind of primitive.
    fn draws<'a>(&'a self, world: &'a World, step: u32) -> impl Iterator<Item = IndexedIndirect> + 'a {
        self.assert_made_for(world);
        let (commands, totals) = (&self.commands[step as usize], &self.totals[step as usize]);
        world.ranges().iter().enumerate().map(move |(kind, range)| {
            world.multi_draw(range, commands.all().from(range.first as usize), Some(totals.all().from(kind)))
        })
    }

    fn assert_made_for(&self, world: &World) {
        assert_eq!(self.world, world.id(), "these lists were made for another world: make the method again");
    }
}
