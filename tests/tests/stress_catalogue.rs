//! `sightline stress` at its default size: the catalogue through every exact method, and planted bugs that it must catch.

use culling::{DrawList, Guarantee, Method, Options, Setup, View, World, METHODS};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use harness::{assert_none, gpu, Subject};
use shaders::types::{Bounds, DrawCommand, PyramidLevel};
use sightline::cli::commands::all_drills;
use sightline::stress::refusals::refusal_faults;
use sightline::stress::{run, Outcome, Plan};
use std::cell::Cell;

#[path = "stress_catalogue/judge.rs"]
mod judge;

/// What `sightline stress` runs without arguments.
fn default_plan(subjects: Vec<Subject>, as_given: bool) -> Plan {
    Plan { subjects, drills: all_drills(0, 2, 25), bodies: 100, size: None, as_given }
}

fn told(outcome: &Outcome) -> Vec<String> {
    let failures = outcome.failures.iter();
    failures.map(|f| format!("{} in {}: {}", f.subject.options.label(), f.drill, f.faults.join("; "))).collect()
}

/// Half of the exact methods, every other one: halves run side by side.
fn faults_of_half(half: usize) {
    let gpu = gpu();
    let exact = METHODS.iter().filter(|entry| entry.guarantee == Guarantee::Exact).skip(half).step_by(2);
    let plan = default_plan(exact.map(|entry| Subject::named(entry.id)).collect(), false);
    let outcome = run(&gpu, &plan, &mut |_, _| Ok(())).unwrap();
    assert_none(&told(&outcome));
    assert_none(&outcome.broken_bounds);
    for (family, row) in sightline::stress::catalogue::FAMILIES.iter().zip(&outcome.families) {
        assert!(row.tally.object_frames > 0, "{} ran nothing", family.name);
        assert!(row.margin.spare_px >= 0.0, "{}: {} pixels to spare", family.name, row.margin.spare_px);
        assert!(
            row.margin.spare_depths.is_none_or(|spare| spare >= 0),
            "{}: {:?}",
            family.name,
            row.margin.spare_depths
        );
    }
    for (subject, tally) in plan.subjects.iter().zip(&outcome.methods) {
        assert!(tally.object_frames > 50_000, "{}: only {}", subject.options.label(), tally.object_frames);
    }
}

#[test]
fn no_exact_method_fails_in_the_catalogue() {
    faults_of_half(0);
}

#[test]
fn no_exact_method_of_the_other_half_fails_in_the_catalogue() {
    faults_of_half(1);
}

#[test]
fn what_is_no_scene_is_refused() {
    assert_none(&refusal_faults().1);
}

/// Bugs that the catalogue is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bug {
    None,
    /// Footprints lie one pixel to the right of where they belong.
    FootprintOffByOne,
    /// Boxes are a few parts in a million too small, and the vertex grid is not allowed for.
    NoOutwardRounding,
    /// Draws come in another order in another run.
    UnsortedPacking,
    /// A list holds 512 draws; what does not fit is left out.
    DroppedOverflow,
    /// What was known of an object's place is kept when the object moves.
    StaleFlags,
    /// It does not forget. What it remembers costs no pixel.
    ForgetsNothing,
}

/// The longest list of [`Bug::DroppedOverflow`].
const CAPACITY: usize = 512;

thread_local! {
    /// Made so far by this test: others run beside it.
    static INSTANCES: Cell<u32> = const { Cell::new(0) };
}

/// Where the camera is and what it sees: matrix, and place in two parts.
type Camera = ([[f32; 4]; 4], [f32; 3], [f32; 3]);

/// Two-phase culling by a pyramid, as `hzb`, with a bug.
struct Buggy {
    bug: Bug,
    gpu: Gpu,
    last: Option<Camera>,
    commands: Buffer<DrawCommand>,
    bounds: Buffer<Bounds>,
    seen_before: Buffer<u32>,
    seen: Buffer<u32>,
    newly: Buffer<u32>,
    lists: [DrawList; 2],
    pyramid: Option<culling::hzb::Pyramid>,
}

fn make(setup: &Setup<'_>, bug: Bug) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let instance = INSTANCES.replace(INSTANCES.get() + 1);
    let mut commands = world.commands();
    if bug == Bug::UnsortedPacking && instance % 2 == 1 {
        commands.reverse();
    }
    if bug == Bug::DroppedOverflow {
        commands.iter_mut().skip(CAPACITY).for_each(|command| command.instance_count = 0);
    }
    let mut bounds = world.read_bounds()?;
    if bug == Bug::NoOutwardRounding {
        bounds.iter_mut().for_each(|bounds| bounds.half_extent = bounds.half_extent.map(|half| half * (1.0 - 4e-6)));
    }
    let words = |name| Buffer::new(gpu, name, world.len(), Placement::Storage);
    Ok(Box::new(Buggy {
        bug,
        gpu: gpu.clone(),
        last: None,
        commands: Buffer::with_data(gpu, "buggy.commands", &commands, Placement::Storage)?,
        bounds: Buffer::with_data(gpu, "buggy.bounds", &bounds, Placement::Storage)?,
        seen_before: words("buggy.seen_before")?,
        seen: words("buggy.seen")?,
        newly: words("buggy.newly")?,
        lists: [DrawList::new(gpu, "buggy.early", world)?, DrawList::new(gpu, "buggy.late", world)?],
        pyramid: None,
    }))
}

impl Method for Buggy {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        let whole = matches!(self.bug, Bug::UnsortedPacking | Bug::DroppedOverflow);
        if whole {
            world.draw_commands(f, self.commands.all(), view, target);
            return Ok(());
        }
        let mut cull = view.cull();
        let moved = (cull.clip_from_relative, cull.camera_high, cull.camera_low);
        let stale = self.bug == Bug::StaleFlags && self.last.replace(moved) == Some(moved);
        match self.bug {
            Bug::FootprintOffByOne => {
                let step = 2.0 / cull.width_px as f32;
                cull.clip_from_relative.iter_mut().for_each(|column| column[0] += step * column[3]);
            }
            Bug::NoOutwardRounding => cull.snap_px = 0.0,
            _ => {}
        }
        let pyramid = culling::hzb::Pyramid::sized(&mut self.pyramid, &self.gpu, target.size, 1, 1)?;
        let (_, coarsest_level): (Vec<PyramidLevel>, u32) = culling::hzb::layout(target.size);
        self.lists[0].pack(f, world, self.seen.all());
        world.draw(f, &self.lists[0], view, target);
        if stale {
            return Ok(());
        }
        pyramid.reduce(f, target);
        let blocks = world.blocks_in_view(f, view);
        f.copy("hzb/keep_seen", self.seen.all(), self.seen_before.all());
        f.fill("hzb/clear_seen", &self.seen, 0);
        f.fill("hzb/clear_newly", &self.newly, 0);
        let test = shaders::hzb::TestBounds {
            bounds: if self.bug == Bug::NoOutwardRounding { self.bounds.all() } else { world.bounds() },
            levels: pyramid.levels(),
            pyramid: pyramid.texels(),
            seen_before: self.seen_before.all(),
            seen: self.seen.all(),
            newly: self.newly.all(),
            blocks,
            view: cull,
            object_count: world.len() as u32,
            coarsest_level,
            constants: Default::default(),
        };
        f.dispatch_indirect(test, blocks);
        self.lists[1].pack(f, world, self.newly.all());
        world.draw(f, &self.lists[1], view, target);
        Ok(())
    }

    fn forget(&mut self) -> culling::Result<()> {
        if self.bug == Bug::ForgetsNothing {
            return Ok(());
        }
        self.last = None;
        self.seen.write(&vec![0; self.seen.len()])?;
        Ok(())
    }
}

/// The first failure of the catalogue's default size, if there is one: the rest is not run.
fn first_failure(gpu: &Gpu, make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>) -> Vec<String> {
    let subject = Subject { options: Options::new("buggy", &[]), make };
    let mut found = Vec::new();
    let stopped = run(gpu, &default_plan(vec![subject], true), &mut |_, outcome| {
        found = told(outcome);
        anyhow::ensure!(found.is_empty(), "found one");
        Ok(())
    });
    assert_eq!(stopped.is_err(), !found.is_empty(), "{stopped:?}");
    found
}

#[test]
fn a_method_without_a_bug_passes() {
    assert_none(&first_failure(&gpu(), |setup| make(setup, Bug::None)));
}

#[test]
fn a_footprint_that_is_off_by_one_is_caught() {
    assert!(!first_failure(&gpu(), |setup| make(setup, Bug::FootprintOffByOne)).is_empty());
}

#[test]
fn missing_outward_rounding_is_caught() {
    assert!(!first_failure(&gpu(), |setup| make(setup, Bug::NoOutwardRounding)).is_empty());
}

#[test]
fn unsorted_packing_is_caught() {
    let found = first_failure(&gpu(), |setup| make(setup, Bug::UnsortedPacking));
    assert!(found.iter().any(|fault| fault.contains("another run draws another picture or list")), "{found:?}");
}

#[test]
fn a_dropped_overflow_is_caught() {
    assert!(!first_failure(&gpu(), |setup| make(setup, Bug::DroppedOverflow)).is_empty());
}

#[test]
fn stale_flags_after_reuse_are_caught() {
    let found = first_failure(&gpu(), |setup| make(setup, Bug::StaleFlags));
    assert!(found.iter().any(|fault| fault.contains("moving") || fault.contains("reuse")), "{found:?}");
}
