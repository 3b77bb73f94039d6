//! Translucent objects, drawn after a method's frame: they hide nothing, so no method sees them, and no map, pyramid or flag of any
//! method holds them (GPU Gems 29.4.1).
//!
//! They are tested as what they belong to tests all others: not at all after `none`, against the view volume after `frustum`, by the
//! true visible set after `ref`; after any method that tests occlusion by their boxes, rasterised against the finished depth. What shows is
//! blended back to front, by the middles of bounds along the view; ties stay in the world's order. One frame's depth decides, so this is
//! exact whatever the method left out: less depth hides less.

pub mod twin;

use crate::boxes::BoxList;
use crate::roc::depth_plane;
use crate::world::{Range, Still};
use crate::{Method, Result, Setup, TestedBoxes, View, VisibleSets, Work, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use glam::DVec3;
use shaders::types::DrawCommand;
use shaders::{roc, translucent, BufferRef, Stage};
use std::sync::Arc;

const PART: &str = "translucent";

/// What translucent objects must pass to be drawn.
#[derive(Clone)]
enum Tests {
    /// Nothing.
    None,
    /// They are in the view volume.
    Frustum,
    /// They are in the view volume, and so is a part of their box that nothing hides.
    Boxes,
    /// They are in the true visible set.
    Known(Arc<VisibleSets>),
}

impl Tests {
    fn of(setup: &Setup<'_>) -> Self {
        match (setup.options.method(), &setup.visible) {
            ("ref", Some(visible)) => Tests::Known(visible.clone()),
            ("none", _) => Tests::None,
            ("frustum" | "frustum-bvh", _) => Tests::Frustum,
            _ => Tests::Boxes,
        }
    }
}

/// The method, and after each of its frames the world's translucent objects; the method as it is if there are none.
///
/// # Errors
/// A device without room for their lists.
pub fn after(method: Box<dyn Method>, setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    if setup.world.total() == setup.world.len() {
        return Ok(method);
    }
    let (tests, still) = (Tests::of(setup), Still::new(setup.options));
    Ok(Box::new(After { method, pass: Pass::new(setup.gpu, setup.world, tests, still)? }))
}

struct After {
    method: Box<dyn Method>,
    pass: Pass,
}

impl Method for After {
    fn prepare(&mut self, world: &World, view: &View) -> Result<()> {
        self.pass.prepare(view)?;
        self.method.prepare(world, view)
    }

    fn needs_items(&self, world: &World, view: &View) -> bool {
        self.method.needs_items(world, view)
    }

    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        self.method.frame(f, world, view, target)?;
        self.pass.frame(f, world, view, target, None)
    }

    fn count_work(&mut self, on: bool) {
        self.method.count_work(on);
    }

    fn work(&self) -> Result<Work> {
        let work = self.method.work()?;
        Ok(Work { boxes: work.boxes + u64::from(self.pass.boxes.read_len()?), ..work })
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        let (tested, translucent) = (self.method.tested_boxes(world)?, self.pass.boxes.read_listed()?);
        if tested.is_none() && translucent.is_empty() {
            return Ok(None);
        }
        let boxes = world.all_host_bounds();
        let mut tested = tested.unwrap_or_default();
        tested.singles.extend(translucent.into_iter().map(|object| boxes[object as usize]));
        Ok(Some(tested))
    }

    fn measured(&mut self, frame_ms: f64) {
        self.method.measured(frame_ms);
    }

    fn repeat(&mut self) {
        self.method.repeat();
    }

    fn choices(&self) -> Vec<String> {
        self.method.choices()
    }

    fn forget(&mut self) -> Result<()> {
        self.pass.still.forget();
        self.method.forget()
    }
}

/// Which translucent objects leave a fragment in front of what has been drawn: the truth.
pub struct Seen {
    pass: Pass,
    flags: Buffer<u32>,
}

impl Seen {
    /// For a world; none if it has no translucent objects.
    ///
    /// # Errors
    /// A device without room for it.
    pub fn new(gpu: &Gpu, world: &World) -> Result<Option<Self>> {
        if world.total() == world.len() {
            return Ok(None);
        }
        let always = Still::never();
        let flags = Buffer::new(gpu, "translucent.seen", world.total(), Placement::Storage)?;
        Ok(Some(Seen { pass: Pass::new(gpu, world, Tests::None, always)?, flags }))
    }

    /// Draws all of them, once everything else is drawn.
    ///
    /// # Errors
    /// As buffers are written.
    pub fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        f.fill("translucent/clear_seen", &self.flags, 0);
        self.pass.frame(f, world, view, target, Some(self.flags.all()))
    }

    /// The objects that left a fragment; the device must be idle.
    ///
    /// # Errors
    /// As buffers are read.
    pub fn objects(&self) -> Result<Vec<u32>> {
        let flags = self.flags.read()?;
        Ok((0..flags.len() as u32).filter(|object| flags[*object as usize] != 0).collect())
    }
}

/// Draws that follow each other in the order and are drawn in the same way.
struct Run {
    objects: Range,
    count: u32,
}

struct Pass {
    tests: Tests,
    /// Objects, back to front.
    order: Buffer<u32>,
    /// By run: how many commands it has. They never lie: draws with and without a count must not be mixed.
    counts: Buffer<u32>,
    runs: Vec<Run>,
    shown: Buffer<u32>,
    known: Option<Buffer<u32>>,
    commands: Buffer<DrawCommand>,
    boxes: BoxList,
    no_boxes: Buffer<DrawCommand>,
    still: Still,
}

impl Pass {
    fn new(gpu: &Gpu, world: &World, tests: Tests, still: Still) -> Result<Self> {
        let (total, count) = (world.total(), world.total() - world.len());
        let known = matches!(tests, Tests::Known(_))
            .then(|| Buffer::new(gpu, "translucent.known", total, Placement::Upload))
            .transpose()?;
        Ok(Pass {
            tests,
            order: Buffer::new(gpu, "translucent.order", count, Placement::Upload)?,
            counts: Buffer::new(gpu, "translucent.counts", count, Placement::Upload)?,
            runs: Vec::new(),
            shown: Buffer::new(gpu, "translucent.shown", total, Placement::Storage)?,
            known,
            commands: Buffer::new(gpu, "translucent.commands", count, Placement::Storage)?,
            boxes: BoxList::new(gpu, "translucent.boxes", count)?,
            no_boxes: BoxList::empty_command(gpu)?,
            still,
        })
    }

    fn prepare(&mut self, view: &View) -> Result<()> {
        let (Tests::Known(sets), Some(known)) = (&self.tests, &mut self.known) else { return Ok(()) };
        // A frame that is not in the sets is the method's to refuse.
        let Some(visible) = sets.frame(view.frame) else { return Ok(()) };
        let flags: Vec<u32> = (0..known.len()).map(|object| u32::from(visible.contains(object))).collect();
        Ok(known.write(&flags)?)
    }

    fn frame(
        &mut self,
        f: &mut Frame,
        world: &World,
        view: &View,
        target: &Target,
        seen: Option<BufferRef<u32>>,
    ) -> Result<()> {
        f.part(PART);
        if self.still.holds(world, view) {
            let tests = [translucent::SelectBoxes::INFO, roc::TestBoxes::INFO];
            let tests = tests.iter().filter(|_| matches!(self.tests, Tests::Frustum | Tests::Boxes));
            tests.for_each(|stage| f.skip(stage.name, Still::REASON));
            f.skip(translucent::WriteCommands::INFO.name, Still::REASON);
        } else {
            self.sort(world, view)?; // 1. back to front
            let shown = self.test(f, world, view, target)?; // 2. who may show
            let write = translucent::WriteCommands {
                shown,
                order: self.order.all(),
                object_meshes: world.object_meshes(),
                meshes: world.meshes(),
                commands: self.commands.all(),
                object_count: self.order.len() as u32,
            };
            f.dispatch(write, self.order.len() as u32); // 3. they, in that order
        }
        let mut first = 0;
        for (index, run) in self.runs.iter().enumerate() {
            let range = Range { count: run.count, ..run.objects };
            let count = self.counts.all().from(index);
            let draw = world.multi_draw(&range, self.commands.all().from(first), Some(count));
            match seen {
                Some(seen) => world.draw_indirect_flagged(f, draw, seen, view, target),
                None => world.draw_indirect(f, draw, view, target), // 4. blended over what there is
            }
            first += run.count as usize;
        }
        f.part("");
        Ok(())
    }

    fn sort(&mut self, world: &World, view: &View) -> Result<()> {
        let order = back_to_front(world, view);
        self.runs.clear();
        for object in &order {
            let kind = world.translucent_kind(*object);
            match self.runs.last_mut() {
                Some(run) if run.objects == kind => run.count += 1,
                _ => self.runs.push(Run { objects: kind, count: 1 }),
            }
        }
        let mut counts = vec![0; self.counts.len()];
        counts.iter_mut().zip(&self.runs).for_each(|(count, run)| *count = run.count);
        self.counts.write(&counts)?;
        Ok(self.order.write(&order)?)
    }

    fn test(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<BufferRef<u32>> {
        match (&self.tests, &self.known) {
            (Tests::Known(_), Some(known)) => return Ok(known.all()),
            (Tests::None | Tests::Known(_), _) => {
                f.fill("translucent/keep_all", &self.shown, 1);
                return Ok(self.shown.all());
            }
            (Tests::Frustum | Tests::Boxes, _) => {}
        }
        let test_boxes = matches!(self.tests, Tests::Boxes);
        self.boxes.look(view)?;
        self.boxes.clear(f, "translucent/clear_boxes", &self.no_boxes);
        let object_count = self.order.len() as u32;
        let select = translucent::SelectBoxes {
            bounds: world.all_bounds(),
            shown: self.shown.all(),
            listed: self.boxes.listed(),
            boxes: self.boxes.command(),
            view: view.cull(),
            first_object: world.len() as u32,
            object_count,
            constants: translucent::SelectBoxesConstants { test_boxes },
        };
        f.dispatch(select, object_count);
        if test_boxes {
            let test = roc::TestBoxes {
                bounds: world.all_bounds(),
                listed: self.boxes.listed(),
                views: self.boxes.view(),
                newly: self.shown.all(),
            };
            f.test_boxes(test, self.boxes.draw(), &target.test_only());
        }
        Ok(self.shown.all())
    }
}

/// Translucent objects by how far the middles of their bounds lie along the view, the farthest first.
fn back_to_front(world: &World, view: &View) -> Vec<u32> {
    let [x, y, z, _] = depth_plane(view).map(f64::from);
    let along = DVec3::new(x, y, z);
    let depth = |object: u32| {
        let depth = (world.all_host_bounds()[object as usize].centre() - view.pose.position).dot(along);
        if depth.is_nan() {
            f64::INFINITY
        } else {
            depth
        }
    };
    let mut order: Vec<(f64, u32)> =
        (world.len() as u32..world.total() as u32).map(|object| (depth(object), object)).collect();
    order.sort_by(|one, other| other.0.total_cmp(&one.0));
    order.into_iter().map(|(_, object)| object).collect()
}
