//! The passes of `bench`: the frames that it asks of a method, in which order, and the errors that it reports of methods whose every error
//! is known.

#[path = "bench/raster_conditions.rs"]
mod raster_conditions;

use culling::{Entry, Guarantee, Method, Options, Setup, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use harness::{gpu, sessions};
use shaders::types::DrawCommand;
use sightline::results::Results;
use sightline::run::bench::{bench, header, BenchOptions};
use sightline::run::session::{Session, SessionOptions};
use sightline::run::truth::RunTruth;
use std::cell::RefCell;
use Call::{Counted, Forget, Measured, Ran, Repeat};

/// A call of a method by `bench`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Call {
    Repeat,
    Forget,
    /// A frame that counts no work: its number, and the number of frames since the last [`Forget`].
    Ran(usize, usize),
    /// The same with work counted, as in the pass that measures errors.
    Counted(usize, usize),
    /// The method was told how long its last frame took.
    Measured,
}

thread_local! {
    static CALLS: RefCell<Vec<Call>> = const { RefCell::new(Vec::new()) };
}

fn log(call: Call) {
    CALLS.with_borrow_mut(|calls| calls.push(call));
}

/// What a planted method does wrong.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fault {
    /// Leaves out the first half of the objects in its seventh frame since it forgot, and the second half in its eighth.
    LosesHalvesByAge,
    /// Draws the view of the frame before.
    Late,
}

struct Planted {
    fault: Fault,
    all: Buffer<DrawCommand>,
    /// The commands without the first half of the objects, and without the second.
    without: [Buffer<DrawCommand>; 2],
    last: Option<View>,
    age: usize,
    counting: bool,
}

fn make(setup: &Setup<'_>, fault: Fault) -> culling::Result<Box<dyn Method>> {
    let commands = setup.world.commands();
    let made =
        |commands: &[DrawCommand]| Buffer::with_data(setup.gpu, "planted.commands", commands, Placement::Storage);
    let without = |half: usize| {
        let mut commands = commands.clone();
        for object in halves(commands.len())[half].clone() {
            commands[object].instance_count = 0;
        }
        made(&commands)
    };
    let (all, without) = (made(&commands)?, [without(0)?, without(1)?]);
    Ok(Box::new(Planted { fault, all, without, last: None, age: 0, counting: false }))
}

fn halves(objects: usize) -> [std::ops::Range<usize>; 2] {
    [0..objects / 2, objects / 2..objects]
}

impl Method for Planted {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        log(if self.counting { Counted(view.frame, self.age) } else { Ran(view.frame, self.age) });
        let last = self.last.replace(*view).unwrap_or(*view);
        let (view, commands) = match (self.fault, self.age) {
            (Fault::LosesHalvesByAge, 6) => (view, &self.without[0]),
            (Fault::LosesHalvesByAge, 7) => (view, &self.without[1]),
            (Fault::LosesHalvesByAge, _) => (view, &self.all),
            (Fault::Late, _) => (&last, &self.all),
        };
        world.update(f);
        f.clear(target);
        world.draw_commands(f, commands.all(), view, target);
        self.age += 1;
        Ok(())
    }

    fn count_work(&mut self, on: bool) {
        self.counting = on;
    }

    fn measured(&mut self, _frame_ms: f64) {
        log(Measured);
    }

    fn repeat(&mut self) {
        log(Repeat);
    }

    fn forget(&mut self) -> culling::Result<()> {
        log(Forget);
        self.age = 0;
        Ok(())
    }
}

const fn entry(id: &'static str, make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>) -> Entry {
    Entry { id, title: "a planted method", source: "this test", guarantee: Guarantee::Exact, options: &[], make }
}

static LOSES: Entry = entry("loses", |setup| make(setup, Fault::LosesHalvesByAge));
static LATE: Entry = entry("late", |setup| make(setup, Fault::Late));

const WARMUP: usize = 5;
const FRAMES: usize = 3;

fn session(gpu: &Gpu) -> Session {
    sessions::open(gpu, ("boxes", 1.0, "pan"), FRAMES)
}

fn run(session: &mut Session, methods: Vec<&'static Entry>, metrics: bool) -> Results {
    let methods = methods.into_iter().map(|entry| (entry, Options::new(entry.id, entry.options))).collect();
    let options = BenchOptions {
        methods,
        warmup: WARMUP,
        metrics,
        pairs: Vec::new(),
        capture: None,
        cache: None,
        command: "a test".into(),
    };
    bench(session, options, &mut |_, _, _| ()).unwrap()
}

/// A warm-up without `forget` leaked one pass's history into the next, and nothing noticed.
#[test]
fn each_pass_begins_without_history_and_runs_the_same_frames() {
    run(&mut session(&gpu()), vec![&LOSES], true);
    let calls = CALLS.take();
    // The warm-up has more frames than the path, and begins again at frame 0.
    let (warm, path) = ([(0, 0), (1, 1), (2, 2), (0, 3), (1, 4)], [(0, 5), (1, 6), (2, 7)]);
    let timed = |frames: &[(usize, usize)]| {
        frames.iter().flat_map(|(frame, age)| [Ran(*frame, *age), Measured]).collect::<Vec<_>>()
    };
    let untimed = |frames: &[(usize, usize)]| frames.iter().map(|(frame, age)| Ran(*frame, *age)).collect::<Vec<_>>();
    let counted = path.map(|(frame, age)| Counted(frame, age)).to_vec();
    let passes = [
        [vec![Forget], timed(&warm), timed(&path)].concat(),
        [vec![Repeat, Forget], untimed(&warm), untimed(&path)].concat(),
        [vec![Repeat, Forget], timed(&warm), counted].concat(),
    ];
    assert_eq!(calls, passes.concat());
}

#[test]
fn without_metrics_there_is_no_pass_for_errors() {
    run(&mut session(&gpu()), vec![&LOSES], false);
    let calls = CALLS.take();
    assert_eq!(calls.iter().filter(|call| **call == Forget).count(), 2);
    assert!(!calls.iter().any(|call| matches!(call, Counted(..))));
}

/// The visible sets say what must be reported: two bad frames of three, which lose different numbers of objects.
#[test]
fn two_bad_frames_are_both_counted_with_every_object_that_they_lose() {
    let gpu = gpu();
    let mut session = session(&gpu);
    let results = run(&mut session, vec![culling::find("none").unwrap(), &LOSES], true);
    let sets = RunTruth::draw(&mut session, || ()).unwrap().sets;
    let halves = halves(session.world.total());
    let visible = |frame: usize, half: usize| {
        let set = sets.frame(frame).unwrap();
        halves[half].clone().filter(|object| set.contains(*object)).count() as u64
    };
    let lost = [0, visible(1, 0), visible(2, 1)];
    assert!(lost[1] > 0 && lost[2] > 0 && lost[1] != lost[2], "{lost:?}: sum, maximum and last value must differ");
    let [none, loses] = &results.methods[..] else { panic!("{} methods", results.methods.len()) };
    assert_eq!(none.frames.false_negatives, [0; FRAMES]);
    assert_eq!((none.false_negatives, none.differing_pixels_mean, none.psnr_worst_db), (0, 0.0, None));
    assert_eq!(loses.frames.false_negatives, lost);
    assert_eq!((loses.false_negatives, loses.false_negative_frames), (lost.iter().sum(), 2));
    let pixels = &loses.frames.differing_pixels;
    assert!(pixels[0] == 0 && pixels[1] > 0 && pixels[2] > 0, "{pixels:?}");
    assert_eq!(loses.differing_pixels_mean, pixels.iter().sum::<u64>() as f64 / FRAMES as f64);
    assert_eq!(loses.frames.psnr_db.iter().map(Option::is_some).collect::<Vec<_>>(), [false, true, true]);
}

/// `none` beside it has no error, so that a truth of the wrong frame fails here too.
#[test]
fn a_method_that_draws_the_frame_before_is_wrong_in_every_frame() {
    let gpu = gpu();
    let results = run(&mut session(&gpu), vec![&LATE, culling::find("none").unwrap()], true);
    let [late, none] = &results.methods[..] else { panic!("{} methods", results.methods.len()) };
    assert!(late.frames.differing_pixels.iter().all(|pixels| *pixels > 1000), "{:?}", late.frames.differing_pixels);
    assert_eq!(none.frames.differing_pixels, [0; FRAMES]);
}

/// Each number of the session differs from the others.
#[test]
fn the_header_holds_what_was_run() {
    let gpu = gpu();
    let options = SessionOptions {
        scene: "moving-boxes".into(),
        scale: 0.5,
        path: Some("pan".into()),
        speed: 3.0,
        seed: 7,
        frames: 5,
        size: [96, 54],
        ..SessionOptions::default()
    };
    let session = Session::on(&gpu, options).unwrap();
    let header = header(&session, "typed");
    assert_eq!((header.size, header.frames, header.speed, header.seed), ([96, 54], 5, 3.0, 7));
    assert_eq!((header.command.as_str(), header.path), ("typed", session.path().describe()));
    assert_eq!((header.scene.name.as_str(), header.scene.shading.as_str()), ("moving-boxes", "lambert"));
    assert_eq!((header.scene.hash, header.scene.moving_bounds.as_str()), (session.scene_hash(), "per-frame"));
    let (objects, triangles) = (header.scene.objects, header.scene.triangles);
    assert_eq!((objects, triangles), (session.world.total() as u64, session.world.triangles()));
    assert!(objects > 0 && triangles > objects, "the numbers must differ: {objects}, {triangles}");
    let info = gpu.info().unwrap();
    assert_eq!((&header.device.name, &header.device.driver), (&info.name, &info.driver));
    assert_eq!(
        (header.device.api_version, header.device.depth_format),
        (info.api.clone(), "D32_SFLOAT (reversed)".to_owned())
    );
    assert!(header.methods.is_empty());
}
