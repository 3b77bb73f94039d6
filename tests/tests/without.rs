//! Each feature that a device may lack, turned off: the laws hold, pictures and draw lists are the same, and what cannot be measured
//! is left out. And `engine/clear_tail` against its twin.

use culling::boxes::BoxShape;
use culling::{DrawList, Drawn, View, World};
use engine::{
    Buffer, Error, Extra, FrameReport, Gpu, GpuOptions, IndexedIndirect, OcclusionQueries, Placement, Queried,
    TimerMode,
};
use harness::{assert_caught, assert_none, gpu, laws, options, worlds, Case, Lab, Random, Subject};
use scenes::SceneOptions;
use shaders::types::DrawCommand;
use sightline::run::targets::Targets;

/// A device without a feature. Stages are timed without a self-check, which takes longer than all else here.
fn open(extra: Extra) -> Gpu {
    open_without(&[extra])
}

fn open_without(extras: &[Extra]) -> Gpu {
    let mut options = GpuOptions { timer: Some(TimerMode::Split), ..options() };
    options.without.extend(extras.iter().map(|extra| extra.name().to_owned()));
    let gpu = Gpu::open(&options).unwrap_or_else(|error| panic!("without {extras:?}: {error}"));
    assert!(!extras.iter().any(|extra| gpu.has(*extra)), "{extras:?}: one was not turned off");
    gpu
}

/// Every way to make and draw lists: methods that draw once, twice, by ranges, by boxes, by read-back, by all that there is.
fn subjects() -> Vec<Subject> {
    let eovc = Subject::named("eovc");
    let methods =
        ["none", "frustum", "hzb", "hzb-iterative", "roc", "roc-iterative", "woc-exact", "query-wait", "chc++", "ref"];
    let mut subjects: Vec<Subject> = methods.into_iter().map(Subject::named).collect();
    subjects.extend([
        eovc.clone(),
        eovc.clone().with("cr", "true"),
        eovc.with("commands", "zero-instance"),
        Subject::named("hzb").with("skip", "false"),
    ]);
    subjects
}

fn cases() -> [Case; 3] {
    [worlds::special::topologies(), worlds::special::ties(), worlds::walled(200)]
}

/// Features that decide how lists are made and drawn: without these, every method meets every world.
const MAKES_LISTS: [Extra; 3] = [Extra::DrawIndirectCount, Extra::MultiDrawIndirect, Extra::PushDescriptor];

#[test]
fn the_laws_hold_without_any_one_feature() {
    let _turn = gpu();
    for extra in Extra::ALL {
        let gpu = open(extra);
        let mut faults = Vec::new();
        for (turn, subject) in subjects().iter().enumerate() {
            for (case, world) in cases().iter().enumerate() {
                if MAKES_LISTS.contains(&extra) || harness::takes_turn(turn, case, 3) {
                    faults.extend(laws::no_visible_object_is_culled(&gpu, subject, world));
                }
            }
            if MAKES_LISTS.contains(&extra) {
                faults.extend(laws::decisions_do_not_depend_on_the_pass(&gpu, subject, &worlds::special::ties()));
            }
        }
        faults.extend(gpu.take_messages().into_iter().map(|message| format!("validation: {message:?}")));
        let without = |fault| format!("without {}: {fault}", extra.name());
        assert_none(&faults.into_iter().map(without).collect::<Vec<_>>());
    }
}

/// Each command is a call of its own then, and boxes that are tested read commands that other calls have written to.
#[test]
fn the_laws_hold_where_no_call_draws_several() {
    let _turn = gpu();
    let gpu = open_without(&[Extra::DrawIndirectCount, Extra::MultiDrawIndirect]);
    let subjects = ["roc", "roc-iterative", "hzb-iterative", "auto"].map(Subject::named);
    let faults = subjects
        .iter()
        .flat_map(|subject| laws::no_visible_object_is_culled(&gpu, subject, &worlds::special::topologies()));
    assert_none(&faults.collect::<Vec<_>>());
}

/// Frames of each method that may upload: its buffers are made and filled then.
const SETTLING: usize = 3;

/// Uploads of a method's later frames, on a device whose memory the host does not see: how far it is from none.
fn late_uploads(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let mut lab = Lab::new(gpu, case);
    let sets = lab.sets_for(subject, &case.shots);
    let mut method = lab.make(subject, &sets);
    let twice = case.shots.iter().chain(&case.shots).enumerate();
    let frames: Vec<_> = twice
        .map(|(frame, shot)| (frame, lab.take_timed(&mut *method, shot, frame % case.shots.len()).report.uploads))
        .collect();
    let late = frames.into_iter().filter(|(frame, uploads)| *frame >= SETTLING && *uploads > 0);
    let place = format!("{} on {}", subject.options.label(), case.name);
    late.map(|(frame, uploads)| format!("{place}, frame {frame}: {uploads} uploads")).collect()
}

/// A scene in which something moves or bends, each frame a little later.
fn moving(name: &str) -> Case {
    let scene = scenes::open(name, &SceneOptions { scale: 0.2, seed: 1, ..SceneOptions::default() }).unwrap();
    let camera = &scene.cameras[0];
    let mut shots = worlds::wander(camera.pose.position, glam::DVec3::ZERO, camera.projection);
    shots.iter_mut().enumerate().for_each(|(frame, shot)| shot.seconds = 0.1 * frame as f64);
    Case::new(name, scene, shots)
}

#[test]
fn no_frame_waits_for_an_upload_of_its_own() {
    let _turn = gpu();
    let gpu = open(Extra::MappedMemory);
    let mut faults = Vec::new();
    for case in [worlds::walled(200), moving("moving-boxes"), moving("tentacles"), moving("jellyfish")] {
        let subjects = culling::METHODS.iter().map(|entry| Subject::named(entry.id));
        faults.extend(subjects.flat_map(|subject| late_uploads(&gpu, &subject, &case)));
    }
    assert_none(&faults);
}

#[test]
fn no_feature_changes_a_picture_or_a_list() {
    let turn = gpu();
    let film = |gpu: &Gpu, subject: &Subject, case: &Case| {
        let mut lab = Lab::new(gpu, case);
        let sets = lab.sets_for(subject, &case.shots);
        let mut method = lab.make(subject, &sets);
        let takes = lab.film(&mut *method, &case.shots);
        takes.into_iter().map(|take| (take.images, take.drawn, take.commands)).collect::<Vec<_>>()
    };
    let subjects = ["hzb", "roc-iterative", "eovc"].map(Subject::named);
    let case = worlds::special::topologies();
    let expected: Vec<_> = subjects.iter().map(|subject| film(&turn, subject, &case)).collect();
    for extra in Extra::ALL {
        let gpu = open(extra);
        for (subject, expected) in subjects.iter().zip(&expected) {
            let found = film(&gpu, subject, &case);
            assert!(found == *expected, "{} without {}", subject.options.label(), extra.name());
        }
    }
}

/// Twin of `engine/clear_tail`: a list of so many commands, of which `count` count, that begins at `first`.
fn clear_tail(commands: &mut [DrawCommand], first: usize, len: usize, count: u32) {
    let tail = commands[first..first + len].iter_mut().skip(count as usize);
    tail.for_each(|command| command.instance_count = 0);
}

#[test]
fn clearing_equals_its_twin_at_any_length() {
    let gpu = gpu();
    let mut random = Random::new(151);
    for (first, len, after) in [(0, 1, 0), (0, 64, 3), (1, 63, 1), (7, 65, 0), (100, 4097, 20)] {
        for count in [0, 1, len / 2, len - 1, len, len + 5] {
            let mut word = || random.below(1 << 31) as u32 + 1;
            let command = |_| DrawCommand {
                index_count: word(),
                instance_count: word(),
                first_index: word(),
                vertex_offset: word() as i32,
                first_instance: word(),
            };
            let mut commands: Vec<DrawCommand> = (0..first + len + after).map(command).collect();
            let listed = Buffer::with_data(&gpu, "test.commands", &commands, Placement::Storage).unwrap();
            let counts = Buffer::with_data(&gpu, "test.counts", &[9, 9, count as u32], Placement::Storage).unwrap();
            let mut f = gpu.frame();
            let clear = shaders::engine::ClearTail {
                count: counts.all(),
                commands: shaders::BufferRef { element: std::marker::PhantomData, ..words_of(&listed) },
                count_word: 2,
                first_word: 5 * first as u32,
                command_count: len as u32,
            };
            f.dispatch(clear, len as u32);
            f.finish().unwrap();
            clear_tail(&mut commands, first, len, count as u32);
            assert_eq!(listed.read().unwrap(), commands, "{count} of {len} commands from {first} on");
        }
    }
}

fn words_of(commands: &Buffer<DrawCommand>) -> shaders::BufferRef<u32> {
    let all = commands.all();
    shaders::BufferRef {
        id: all.id,
        raw: all.raw,
        offset: all.offset,
        size: all.size,
        element: std::marker::PhantomData,
    }
}

/// Lists everything, then every third object, and draws that as `draws` makes it of the first frame's draws: objects in the picture
/// that are not listed. Draws of objects that something hides, or that come to lie where they are anyway, would show in no other law.
fn unlisted(gpu: &Gpu, draws: impl Fn(&FrameReport) -> Vec<IndexedIndirect>) -> (Vec<String>, Drawn) {
    let case = worlds::special::topologies();
    let world = World::new(gpu, &case.scene).unwrap();
    let targets = Targets::new(gpu, case.size).unwrap();
    let (view, target) = (View::new(&case.shots[0], case.size, 0, gpu.snap_px()), targets.with_items());
    let list = DrawList::new(gpu, "test.list", &world).unwrap();
    let some: Vec<u32> = (0..world.len() as u32).map(|object| u32::from(object % 3 == 0)).collect();
    let flags = [vec![1; world.len()], some.clone()]
        .map(|flags| Buffer::with_data(gpu, "test.flags", &flags, Placement::Storage).unwrap());
    let mut f = gpu.frame();
    f.clear(&target);
    list.pack(&mut f, &world, flags[0].all());
    world.draw(&mut f, &list, &view, &target);
    let full = f.finish().unwrap();
    let mut f = gpu.frame();
    f.clear(&target);
    list.pack(&mut f, &world, flags[1].all());
    world.draw_again(&mut f, &draws(&full), &view, &target);
    let report = f.finish().unwrap();
    let items = targets.read().unwrap().items;
    let shown: std::collections::BTreeSet<u32> =
        items.into_iter().filter(|item| (*item as usize) < some.len()).collect();
    assert!(!shown.is_empty(), "shows nothing, so it proves nothing");
    let unlisted = shown.into_iter().filter(|item| some[*item as usize] == 0);
    let faults = unlisted.map(|item| format!("object {item} shows, though it is not listed")).collect();
    (faults, culling::drawn_objects(gpu, &world, &report).unwrap())
}

#[test]
fn what_is_behind_a_lists_end_is_not_drawn() {
    let turn = gpu();
    let counting = unlisted(&turn, |report| report.draws.clone());
    let clearing = unlisted(&open(Extra::DrawIndirectCount), |report| report.draws.clone());
    assert_none(&counting.0);
    assert_none(&clearing.0);
    assert_eq!(counting.1, clearing.1, "what is reported as drawn");
}

/// The planted error: a tail that nobody has cleared.
#[test]
fn a_tail_that_is_not_cleared_is_noticed() {
    let _turn = gpu();
    let gpu = open(Extra::DrawIndirectCount);
    let uncounted = |report: &FrameReport| {
        report.draws.iter().map(|draw| IndexedIndirect { count: None, ..*draw }).collect::<Vec<_>>()
    };
    assert_caught(&unlisted(&gpu, uncounted).0, "is not listed");
}

/// A submission of queried boxes alone had no room for their descriptors: steps that query were not counted.
#[test]
fn queries_alone_have_room_for_what_they_bind() {
    let _turn = gpu();
    let gpu = open(Extra::PushDescriptor);
    let case = worlds::walled(20);
    let world = World::new(&gpu, &case.scene).unwrap();
    let targets = Targets::new(&gpu, case.size).unwrap();
    let mut shape = BoxShape::new(&gpu, "test", 1).unwrap();
    shape.look(&View::new(&case.shots[0], case.size, 0, gpu.snap_px())).unwrap();
    let commands = [DrawCommand { instance_count: 1, ..BoxShape::no_boxes(0) }];
    let commands = Buffer::with_data(&gpu, "test.commands", &commands, Placement::Upload).unwrap();
    let listed = Buffer::with_data(&gpu, "test.listed", &[0], Placement::Upload).unwrap();
    let queries = OcclusionQueries::new(&gpu, "test.queries", 1).unwrap();
    let target = targets.timed();
    let mut f = gpu.frame();
    f.clear(&target);
    let stage = shaders::queries::TestObjects { bounds: world.bounds(), listed: listed.all(), views: shape.view() };
    let draw = IndexedIndirect { count: None, ..shape.draw(commands.all(), 1) };
    f.query_boxes(stage, draw, Queried { queries: &queries, first: 0 }, &target.test_only());
    assert!(f.wait_for_queries(&queries, 0..1).unwrap()[0] > 0, "the wall's box shows");
    f.finish().unwrap();
}

/// A work group of several subgroups, and one that a subgroup is too wide for: what a device makes of it that takes no size.
#[test]
fn prefix_sums_are_right_whatever_subgroups_there_are() {
    let _turn = gpu();
    let gpu = open(Extra::SubgroupSizeControl);
    let mut random = Random::new(152);
    let natural = gpu.subgroup_size();
    for subgroup_size in [1, natural / 2, natural, 2 * natural, 4 * natural, 3 * natural - 1] {
        for chunk_count in [1, 2, natural - 1, natural, 5 * natural + 3, 1000] {
            let flagged: Vec<u32> = (0..chunk_count).map(|_| random.below(64) as u32).collect();
            let words = |data: &[u32]| Buffer::with_data(&gpu, "test.words", data, Placement::Storage).unwrap();
            let (counts, starts, total) = (words(&flagged), words(&vec![7; flagged.len()]), words(&[7]));
            let mut f = gpu.frame();
            let scan = shaders::pack::ScanCounts {
                counts: counts.all(),
                starts: starts.all(),
                total: total.all(),
                chunk_count,
                constants: shaders::pack::ScanCountsConstants { subgroup_size },
            };
            f.dispatch_groups(scan, 1);
            f.finish().unwrap();
            let found = (starts.read().unwrap(), total.read().unwrap()[0]);
            let expected = culling::pack::twin::scan_counts(&flagged);
            assert_eq!(
                found, expected,
                "{chunk_count} counts, a work group of {subgroup_size}, subgroups of {natural}"
            );
        }
    }
}

#[test]
fn stages_that_cannot_be_timed_or_counted_are_left_out() {
    let turn = gpu();
    let report = |gpu: &Gpu| {
        let words = Buffer::with_data(gpu, "test.words", &[1u32; 64], Placement::Storage).unwrap();
        let mut f = gpu.frame();
        f.count_statistics();
        f.dispatch(shaders::engine::SpinWords { words: words.all(), word_count: 64 }, 64);
        assert_eq!(f.read(&words).unwrap().len(), 64);
        f.finish().unwrap()
    };
    let untimed = open(Extra::Timestamps);
    assert_eq!(untimed.timer_mode(), TimerMode::Off);
    assert!(untimed.timer_mode().to_string().contains("no timestamps"));
    assert_eq!(report(&untimed).stages, [], "no stage has a time, and none has a wrong one");
    assert!(report(&untimed).frame_ms > 0.0);
    assert_eq!(report(&open(Extra::PipelineStatistics)).statistics, None);
    assert_eq!(report(&turn).stages.is_empty(), !turn.has(Extra::Timestamps));
}

#[test]
fn an_unknown_feature_is_refused_and_the_known_ones_named() {
    let _turn = gpu();
    let without = |name: &str| {
        let opened = Gpu::open(&GpuOptions { without: vec![name.to_owned()], ..options() });
        opened.err().unwrap_or_else(|| panic!("opened without {name}"))
    };
    let error = without("drawIndirectCont");
    assert!(matches!(error, Error::NoSuchFeature { .. }), "{error}");
    assert!(
        error.to_string().contains("drawIndirectCont") && error.to_string().contains("VK_KHR_push_descriptor"),
        "{error}"
    );
    // What every stage needs has no way around it.
    let error = without("scalarBlockLayout");
    assert!(
        matches!(error, Error::MissingFeatures { .. }) && error.to_string().contains("scalarBlockLayout"),
        "{error}"
    );
}
