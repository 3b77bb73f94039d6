//! The harness can fail: each law is broken on purpose by a method with one defect, and the law must say so.

use culling::frustum::OPTIONS;
use culling::hzb::Pyramid;
use culling::{DrawList, Method, Options, Setup, View, World};
use engine::{Buffer, Error, Faces, Frame, Gpu, IndexedIndirect, Placement, Primitives, Surface, Target};
use harness::footprints::covered;
use harness::{assert_caught, assert_none, gpu, laws, worlds, Lab, Subject};
use shaders::types::{Bounds, DrawCommand, PyramidLevel, BLOCK_OBJECTS};
use std::cell::Cell;

/// What is wrong with a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    Nothing,
    WrongSign,
    ShrunkBounds,
    DroppedDraw,
    StaleFlags,
    ReversedEachSecondFrame,
    ReversedEachSecondInstance,
    LooksAtTheTarget,
    NearPyramid,
    OffByOneLevel,
    ForgottenLatePhase,
    NeverForgets,
    FirstOfEachBlock,
}

thread_local! {
    /// Made so far by this test: others run beside it.
    static INSTANCES: Cell<u32> = const { Cell::new(0) };
}

struct Broken {
    defect: Defect,
    gpu: Gpu,
    skip: bool,
    frames: u32,
    instance: u32,
    commands: Buffer<DrawCommand>,
    reversed: Buffer<DrawCommand>,
    shrunk: Buffer<Bounds>,
    firsts: Buffer<Bounds>,
    no_blocks: Buffer<u32>,
    seen_before: Buffer<u32>,
    seen: Buffer<u32>,
    newly: Buffer<u32>,
    lists: [DrawList; 2],
    pyramid: Option<Pyramid>,
}

fn make(setup: &Setup<'_>, defect: Defect) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let mut commands = world.commands();
    let reversed: Vec<DrawCommand> = commands.iter().rev().copied().collect();
    if defect == Defect::DroppedDraw {
        // The wall of `worlds::walled`.
        commands[0].instance_count = 0;
    }
    let mut shrunk = world.read_bounds()?;
    let firsts: Vec<Bounds> = shrunk.iter().step_by(BLOCK_OBJECTS as usize).copied().collect();
    shrunk.iter_mut().for_each(|bounds| bounds.half_extent = bounds.half_extent.map(|half| 0.3 * half));
    let words = |name| Buffer::new(gpu, name, world.len(), Placement::Storage);
    Ok(Box::new(Broken {
        defect,
        gpu: gpu.clone(),
        skip: setup.options.flag("skip"),
        frames: 0,
        instance: INSTANCES.replace(INSTANCES.get() + 1),
        commands: Buffer::with_data(gpu, "broken.commands", &commands, Placement::Storage)?,
        reversed: Buffer::with_data(gpu, "broken.reversed", &reversed, Placement::Storage)?,
        shrunk: Buffer::with_data(gpu, "broken.shrunk", &shrunk, Placement::Storage)?,
        firsts: Buffer::with_data(gpu, "broken.firsts", &firsts, Placement::Storage)?,
        no_blocks: Buffer::with_data(gpu, "broken.no_blocks", &[0, 1, 1, 0], Placement::Storage)?,
        seen_before: words("broken.seen_before")?,
        seen: words("broken.seen")?,
        newly: words("broken.newly")?,
        lists: [DrawList::new(gpu, "broken.early", world)?, DrawList::new(gpu, "broken.late", world)?],
        pyramid: None,
    }))
}

impl Method for Broken {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        self.frames += 1;
        world.update(f);
        f.clear(target);
        match self.defect {
            Defect::DroppedDraw => world.draw_commands(f, self.commands.all(), view, target),
            Defect::ReversedEachSecondFrame if self.frames.is_multiple_of(2) => {
                world.draw_commands(f, self.reversed.all(), view, target)
            }
            Defect::ReversedEachSecondInstance if self.instance.is_multiple_of(2) => {
                world.draw_commands(f, self.reversed.all(), view, target)
            }
            Defect::ReversedEachSecondFrame | Defect::ReversedEachSecondInstance => world.draw_all(f, view, target),
            Defect::LooksAtTheTarget if target.item.is_some() => world.draw_all(f, view, target),
            Defect::Nothing
            | Defect::NeverForgets
            | Defect::NearPyramid
            | Defect::OffByOneLevel
            | Defect::ForgottenLatePhase => {
                self.two_phases(f, world, view, target)?;
            }
            _ => self.frustum(f, world, view, target),
        }
        Ok(())
    }

    fn forget(&mut self) -> culling::Result<()> {
        if self.defect != Defect::NeverForgets {
            self.frames = 0;
            self.seen.write(&vec![0; self.seen.len()])?;
        }
        Ok(())
    }
}

impl Broken {
    fn frustum(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        let mut cull = view.cull();
        if self.defect == Defect::WrongSign {
            cull.clip_from_relative.iter_mut().for_each(|column| column[3] = -column[3]);
        }
        let bounds = if self.defect == Defect::ShrunkBounds { self.shrunk.all() } else { world.bounds() };
        if self.defect != Defect::StaleFlags || self.frames == 1 || !self.skip {
            let object_count = world.len() as u32;
            let blocks = world.blocks_in_view(f, view);
            if self.defect == Defect::FirstOfEachBlock {
                let (bounds, block_count) = (self.firsts.all(), self.firsts.len() as u32);
                f.copy("broken/clear_blocks", self.no_blocks.all(), blocks);
                let test = shaders::frustum::TestBlocks { bounds, blocks, view: cull, block_count };
                f.dispatch(test, block_count);
            }
            f.fill("frustum/clear_kept", &self.seen, 0);
            f.dispatch_indirect(
                shaders::frustum::TestBounds { bounds, blocks, kept: self.seen.all(), view: cull, object_count },
                blocks,
            );
            self.lists[0].pack(f, world, self.seen.all());
        } else {
            f.skip("frustum/test_bounds", culling::world::Still::REASON);
        }
        world.draw(f, &self.lists[0], view, target);
    }

    /// `hzb` as it is, but for the defect.
    fn two_phases(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        let pyramid = Pyramid::sized(&mut self.pyramid, &self.gpu, target.size, 1, 1)?;
        let (layout, coarsest_level) = culling::hzb::layout(target.size);
        // Each level but the finest stands for its finer neighbour.
        let off_by_one = |level: usize| layout[if level < 2 { level } else { level - 1 }];
        let off_by_one: Vec<PyramidLevel> = (0..layout.len()).map(off_by_one).collect();
        let off_by_one = Buffer::with_data(&self.gpu, "broken.levels", &off_by_one, Placement::Storage)?;
        let texels = layout.iter().map(|level| level.width * level.height).sum::<u32>() as usize;
        let near = Buffer::with_data(&self.gpu, "broken.near", &vec![1.0f32; texels], Placement::Storage)?;
        self.lists[0].pack(f, world, self.seen.all());
        world.draw(f, &self.lists[0], view, target);
        pyramid.reduce(f, target);
        let blocks = world.blocks_in_view(f, view);
        f.copy("hzb/keep_seen", self.seen.all(), self.seen_before.all());
        f.fill("hzb/clear_seen", &self.seen, 0);
        f.fill("hzb/clear_newly", &self.newly, 0);
        let test = shaders::hzb::TestBounds {
            bounds: world.bounds(),
            levels: if self.defect == Defect::OffByOneLevel { off_by_one.all() } else { pyramid.levels() },
            pyramid: if self.defect == Defect::NearPyramid { near.all() } else { pyramid.texels() },
            seen_before: self.seen_before.all(),
            seen: self.seen.all(),
            newly: self.newly.all(),
            blocks,
            view: view.cull(),
            object_count: world.len() as u32,
            coarsest_level,
            constants: Default::default(),
        };
        f.dispatch_indirect(test, blocks);
        if self.defect != Defect::ForgottenLatePhase || self.frames == 1 {
            self.lists[1].pack(f, world, self.newly.all());
            world.draw(f, &self.lists[1], view, target);
        }
        Ok(())
    }
}

fn subject(make: Make) -> Subject {
    Subject { options: Options::new("broken", OPTIONS), make }
}

type Law = fn(&Gpu, &Subject, &worlds::Case) -> Vec<String>;
type Make = fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>;

/// The law holds for the method without a defect, and names the fault of the one with it.
fn caught(law: Law, broken: Make, case: &worlds::Case, expected: &str) {
    let gpu = gpu();
    assert_none(&law(&gpu, &subject(|setup| make(setup, Defect::Nothing)), case));
    assert_caught(&law(&gpu, &subject(broken), case), expected);
}

#[test]
fn a_wrong_sign_in_the_frustum_is_noticed() {
    caught(laws::no_visible_object_is_culled, |s| make(s, Defect::WrongSign), &worlds::walled(80), "false negatives");
}

#[test]
fn bounds_that_are_too_small_are_noticed() {
    caught(
        laws::no_visible_object_is_culled,
        |s| make(s, Defect::ShrunkBounds),
        &worlds::walled(300),
        "differing pixels",
    );
}

#[test]
fn blocks_that_do_not_hold_their_objects_are_noticed() {
    caught(
        laws::no_visible_object_is_culled,
        |s| make(s, Defect::FirstOfEachBlock),
        &worlds::walled(300),
        "false negatives",
    );
}

#[test]
fn a_dropped_draw_is_noticed() {
    caught(laws::no_visible_object_is_culled, |s| make(s, Defect::DroppedDraw), &worlds::walled(80), "false negatives");
}

#[test]
fn stale_flags_are_noticed() {
    // From turned away to the full view: the first frame's list lacks nearly everything.
    let case = worlds::walled(80);
    let case = case.filmed(vec![case.shots[3], case.shots[0]]);
    caught(laws::no_visible_object_is_culled, |s| make(s, Defect::StaleFlags), &case, "false negatives");
    caught(laws::a_camera_cut_hides_nothing, |s| make(s, Defect::StaleFlags), &worlds::walled(80), "false negatives");
}

#[test]
fn skipping_too_much_is_noticed() {
    let (gpu, case) = (gpu(), worlds::walled(80));
    let stale = laws::skipping_changes_no_pixel(&gpu, &subject(|s| make(s, Defect::StaleFlags)), &case);
    assert_caught(&stale, "drawn objects differ");
    assert_caught(&stale, "but a stage was left out");
    let never = laws::skipping_changes_no_pixel(&gpu, &subject(|s| make(s, Defect::Nothing)), &case);
    assert_caught(&never, "no stage was left out");
}

#[test]
fn memories_that_outlast_forgetting_are_noticed() {
    caught(
        laws::a_camera_cut_hides_nothing,
        |s| make(s, Defect::NeverForgets),
        &worlds::walled(80),
        "after forgetting",
    );
}

#[test]
fn unordered_lists_are_noticed() {
    let ties = worlds::special::ties();
    caught(laws::a_still_camera_shows_one_picture, |s| make(s, Defect::ReversedEachSecondFrame), &ties, "flickers");
    caught(
        laws::two_runs_give_the_same_bytes,
        |s| make(s, Defect::ReversedEachSecondInstance),
        &ties,
        "draw lists differ",
    );
}

#[test]
fn decisions_by_the_target_are_noticed() {
    caught(
        laws::decisions_do_not_depend_on_the_pass,
        |s| make(s, Defect::LooksAtTheTarget),
        &worlds::walled(80),
        "draw lists differ",
    );
}

#[test]
fn a_pyramid_of_near_depths_is_noticed() {
    caught(laws::no_visible_object_is_culled, |s| make(s, Defect::NearPyramid), &worlds::walled(80), "false negatives");
}

#[test]
fn a_level_that_is_off_by_one_is_noticed() {
    caught(
        laws::no_visible_object_is_culled,
        |s| make(s, Defect::OffByOneLevel),
        &worlds::walled(300),
        "false negatives",
    );
}

#[test]
fn a_missing_late_phase_is_noticed() {
    caught(
        laws::no_visible_object_is_culled,
        |s| make(s, Defect::ForgottenLatePhase),
        &worlds::walled(80),
        "false negatives",
    );
}

#[test]
fn footprints_that_are_too_small_are_noticed() {
    let gpu = gpu();
    let case = worlds::walled(200);
    let mut lab = Lab::new(&gpu, &case);
    let right = covered(&mut lab, &case, |_, _| ());
    assert!(right.outside.is_empty() && right.too_near.is_empty() && right.objects > 20, "{right:?}");
    let mut shrunk =
        |by: f32| covered(&mut lab, &case, |bounds, _| bounds.half_extent = bounds.half_extent.map(|half| by * half));
    assert_caught(&shrunk(0.8).outside, "outside its footprint");
    // A grid of 1/16 pixel lets depths come 3/4 of a box's depth range before the box: 0.8 is within that.
    assert!(!shrunk(0.3).too_near.is_empty());
}

#[test]
fn a_list_that_claims_more_than_it_holds_is_an_error() {
    let gpu = gpu();
    let case = worlds::walled(10);
    let world = World::new(&gpu, &case.scene).unwrap();
    let commands = Buffer::<DrawCommand>::new(&gpu, "test.commands", world.len(), Placement::Storage).unwrap();
    let count = Buffer::with_data(&gpu, "test.count", &[world.len() as u32 + 1], Placement::Storage).unwrap();
    let draw = IndexedIndirect {
        vertices: world.vertices().into(),
        instances: world.objects().into(),
        indices: world.indices().into(),
        commands: commands.all().into(),
        count: Some(count.all()),
        max_draws: world.len() as u32,
        primitives: Primitives::Triangles,
        faces: Faces::Both,
        surface: Surface::Opaque,
    };
    let report = engine::FrameReport { draws: vec![draw], ..Default::default() };
    match culling::drawn_objects(&gpu, &world, &report) {
        Err(culling::Error::Engine(Error::Overflow { count, capacity, .. })) => assert_eq!((count, capacity), (12, 11)),
        other => panic!("an overflow passed for culling: {other:?}"),
    }
}
