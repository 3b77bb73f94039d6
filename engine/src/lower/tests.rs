use super::*;
use crate::recorder::{QueriesRef, Recorder, Shapes};
use crate::transfer::everything;
use shaders::{Access, BindingInfo, BindingKind, BufferRef, ImageRef, ResourceId, StageInfo};
use std::marker::PhantomData;
use vk::{AccessFlags2 as Accesses, PipelineStageFlags2 as Stages};

#[test]
fn a_list_in_pieces_is_drawn_once_and_in_order() {
    let of = |draws, most| pieces(draws, most).collect::<Vec<_>>();
    assert_eq!(of(0, 4), []);
    assert_eq!(of(4, 4), [(0, 4)]);
    assert_eq!(of(9, 4), [(0, 4), (4, 4), (8, 1)]);
    assert_eq!(of(3, 1), [(0, 1), (1, 1), (2, 1)]);
    assert_eq!(of(94_000, u32::MAX), [(0, 94_000)]);
}

#[test]
fn folded_grids_cover_every_group_within_the_limit() {
    for groups in [1, 64, 65_535, 65_536, 156_250, 4_000_000_000] {
        let [x, y] = folded(groups);
        assert!(x <= MOST_GROUPS && u64::from(x) * u64::from(y) >= u64::from(groups), "{groups}: {x}x{y}");
        // A row that is not full costs less than a row of groups that do nothing.
        assert!(u64::from(x) * u64::from(y) < u64::from(groups) + u64::from(y), "{groups}: {x}x{y}");
    }
    assert_eq!([0, 1, 65_535, 65_536].map(folded), [[0, 0], [1, 1], [65_535, 1], [32_768, 2]]);
}

#[test]
fn a_submission_has_one_timestamp_more_than_stages_and_no_more_than_the_pool() {
    assert_eq!([0, 1, 4095].map(|stages| timestamps(stages, "a device").unwrap()), [1, 2, 4096]);
    assert_eq!(MAX_TIMESTAMPS, 4096);
    for stages in [4096, 4097, 1 << 32, (1 << 32) + 3] {
        let error = timestamps(stages, "a device").unwrap_err();
        assert!(matches!(error, Error::TooLarge { .. }), "{error}");
        let text = error.to_string();
        let (wanted, limit) = (format!("{stages} stages"), "4095 stages a submission");
        assert!([wanted.as_str(), limit, "a device"].iter().all(|part| text.contains(part)), "{text}");
    }
}

#[test]
fn a_bound_buffer_is_its_handle_and_range() {
    let bound = Bound::Buffer { id: X, raw: 7, offset: 12, size: 40 };
    assert_eq!(range(&bound), (vk::Buffer::from_raw(7), 12, 40));
    assert_eq!(range(&Bound::Image(image(X))), (vk::Buffer::null(), 0, 0));
}

/// The resource that both steps of a pair touch. All others are each step's own.
const X: ResourceId = ResourceId(1_000);

fn buffer(id: ResourceId) -> Bound {
    Bound::Buffer { id, raw: 0, offset: 0, size: 4 }
}

fn words(id: ResourceId) -> BufferRef<u32> {
    BufferRef { id, raw: 0, offset: 0, size: 12, element: PhantomData }
}

fn image(id: ResourceId) -> ImageRef {
    ImageRef { id, view: 0, image: 0 }
}

const fn binding(kind: BindingKind, access: Access) -> BindingInfo {
    BindingInfo { name: "items", binding: 0, kind, access }
}

const fn stage_with(bindings: &'static [BindingInfo], instance_stride: u32) -> StageInfo {
    StageInfo {
        name: "test/stage",
        modules: &[],
        bindings,
        push_size: 0,
        constants: &[],
        local_size: [64, 1, 1],
        vertex: &[],
        vertex_stride: 0,
        instance: &[],
        instance_stride,
        outputs: &[],
    }
}

static READS: StageInfo = stage_with(&[binding(BindingKind::StorageBuffer, Access::Read)], 0);
static WRITES: StageInfo = stage_with(&[binding(BindingKind::StorageBuffer, Access::Write)], 0);
static BOTH: StageInfo = stage_with(&[binding(BindingKind::StorageBuffer, Access::ReadWrite)], 0);
static SAMPLES: StageInfo = stage_with(&[binding(BindingKind::SampledImage, Access::Read)], 0);
static STORES: StageInfo = stage_with(&[binding(BindingKind::StorageImage, Access::ReadWrite)], 0);
static INSTANCED: StageInfo = stage_with(&[], 16);

fn bound(info: &'static StageInfo, resource: Bound) -> BoundStage {
    BoundStage::new(info, info.bindings.iter().map(|_| resource).collect(), &[], Vec::new())
}

/// Resources of one step, each its own.
struct Own {
    commands: ResourceId,
    count: ResourceId,
    vertices: ResourceId,
    instances: ResourceId,
    indices: ResourceId,
    binding: ResourceId,
    colour: ResourceId,
    item: ResourceId,
    depth: ResourceId,
    read_only: bool,
}

impl Own {
    /// Those of the first step, or of the second.
    fn new(second: bool) -> Self {
        let id = |number: u32| ResourceId(number + if second { 100 } else { 0 });
        Own {
            commands: id(1),
            count: id(2),
            vertices: id(3),
            instances: id(4),
            indices: id(5),
            binding: id(6),
            colour: id(7),
            item: id(8),
            depth: id(9),
            read_only: false,
        }
    }

    fn target(&self) -> Target {
        Target {
            size: [4, 4],
            colour: Some((image(self.colour), Format::Colour)),
            item: Some(image(self.item)),
            depth: image(self.depth),
            depth_read_only: self.read_only,
            strictly_nearer: false,
            samples: None,
        }
    }

    fn indirect(&self, count: Option<BufferRef<u32>>) -> IndexedIndirect {
        IndexedIndirect {
            vertices: buffer(self.vertices),
            instances: buffer(self.instances),
            indices: buffer(self.indices),
            commands: buffer(self.commands),
            count,
            max_draws: 3,
            primitives: Primitives::Triangles,
            faces: Faces::Both,
            surface: Surface::Opaque,
        }
    }

    fn draw(&self, info: &'static StageInfo) -> Op {
        let draw = self.indirect(Some(words(self.count)));
        Op::Draw { stage: bound(info, buffer(self.binding)), draw, target: self.target() }
    }

    fn query(&self, info: &'static StageInfo) -> Op {
        let (draw, queries) = (self.indirect(None), QueriesRef { raw: 0 });
        let stage = bound(info, buffer(self.binding));
        Op::Query { stage, draw, queries, first_query: 0, target: self.target() }
    }

    fn shapes(&self, info: &'static StageInfo) -> Op {
        let shapes = Shapes { corners: 3, count: 1, surface: Surface::Opaque };
        Op::Shapes { stage: bound(info, buffer(self.binding)), shapes, query: None, target: self.target() }
    }

    fn clear(&self) -> Op {
        Op::Clear { target: self.target() }
    }

    fn dispatch(&self, info: &'static StageInfo) -> Op {
        Op::Dispatch { stage: bound(info, buffer(self.binding)), groups: [1, 1] }
    }
}

/// A way to touch the shared resource.
struct Touch {
    name: &'static str,
    reads: bool,
    writes: bool,
    /// The stages in which Vulkan does it.
    stages: Stages,
    /// The accesses by which Vulkan writes, where it writes.
    write: Accesses,
    step: fn(Own) -> Op,
}

const NONE: Accesses = Accesses::empty();
/// Vulkan, "Supported Access Types": VERTEX_INPUT is INDEX_INPUT and VERTEX_ATTRIBUTE_INPUT.
const FETCH: Stages = Stages::VERTEX_INPUT;
const SHADERS: Stages = Stages::from_raw(Stages::VERTEX_SHADER.as_raw() | Stages::FRAGMENT_SHADER.as_raw());
const COMPUTE: Stages = Stages::COMPUTE_SHADER;
const STORE: Accesses = Accesses::SHADER_STORAGE_WRITE;
/// Depth is loaded and cleared in the early tests, and stored in the late ones.
const TESTS: Stages = Stages::from_raw(Stages::EARLY_FRAGMENT_TESTS.as_raw() | Stages::LATE_FRAGMENT_TESTS.as_raw());
const DEPTH: Accesses = Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE;
/// Attachments are cleared, loaded, blended and stored in one stage.
const OUTPUT: Stages = Stages::COLOR_ATTACHMENT_OUTPUT;
const COLOUR: Accesses = Accesses::COLOR_ATTACHMENT_WRITE;
/// Copies, resolves, clears (a fill is one).
const MOVES: Stages = Stages::ALL_TRANSFER;
const MOVE: Accesses = Accesses::TRANSFER_WRITE;

const fn reads(name: &'static str, stages: Stages, step: fn(Own) -> Op) -> Touch {
    Touch { name, reads: true, writes: false, stages, write: NONE, step }
}

const fn writes(name: &'static str, stages: Stages, write: Accesses, step: fn(Own) -> Op) -> Touch {
    Touch { name, reads: false, writes: true, stages, write, step }
}

const fn both(name: &'static str, stages: Stages, write: Accesses, step: fn(Own) -> Op) -> Touch {
    Touch { name, reads: true, writes: true, stages, write, step }
}

/// Every way in which a step can touch a resource, written by hand from the Vulkan specification ("Synchronization and Cache Control"): not from
/// [`source`] and not from the recorder's `uses`. Vulkan names DRAW_INDIRECT for arguments of dispatches too. Images never leave the general
/// layout, so no pair needs a transition.
const TOUCHES: [Touch; 30] = [
    reads("arguments of a dispatch", Stages::DRAW_INDIRECT, |own| {
        let stage = bound(&READS, buffer(own.binding));
        Op::DispatchIndirect { stage, groups: words(X) }
    }),
    reads("binding of an indirect dispatch", COMPUTE, |own| Op::DispatchIndirect {
        stage: bound(&READS, buffer(X)),
        groups: words(own.commands),
    }),
    reads("commands of a draw", Stages::DRAW_INDIRECT, |own| Own { commands: X, ..own }.draw(&READS)),
    reads("commands of a query", Stages::DRAW_INDIRECT, |own| Own { commands: X, ..own }.query(&READS)),
    reads("count of a draw", Stages::DRAW_INDIRECT, |own| Own { count: X, ..own }.draw(&READS)),
    reads("vertices", FETCH, |own| Own { vertices: X, ..own }.draw(&READS)),
    reads("indices", FETCH, |own| Own { indices: X, ..own }.draw(&READS)),
    reads("instances", FETCH, |own| Own { instances: X, ..own }.draw(&INSTANCED)),
    reads("binding read by a compute stage", COMPUTE, |own| Own { binding: X, ..own }.dispatch(&READS)),
    writes("binding written by a compute stage", COMPUTE, STORE, |own| Own { binding: X, ..own }.dispatch(&WRITES)),
    both("binding read and written by a compute stage", COMPUTE, STORE, |own| {
        Own { binding: X, ..own }.dispatch(&BOTH)
    }),
    reads("image sampled by a compute stage", COMPUTE, |_| Op::Dispatch {
        stage: bound(&SAMPLES, Bound::Image(image(X))),
        groups: [1, 1],
    }),
    both("image stored by a compute stage", COMPUTE, STORE, |_| Op::Dispatch {
        stage: bound(&STORES, Bound::Image(image(X))),
        groups: [1, 1],
    }),
    reads("binding read by a drawing", SHADERS, |own| Own { binding: X, ..own }.draw(&READS)),
    writes("binding written by a drawing", SHADERS, STORE, |own| Own { binding: X, ..own }.draw(&WRITES)),
    both("binding read and written by a drawing", SHADERS, STORE, |own| Own { binding: X, ..own }.query(&BOTH)),
    reads("binding read by shapes", SHADERS, |own| Own { binding: X, ..own }.shapes(&READS)),
    both("depth that is drawn to", TESTS, DEPTH, |own| Own { depth: X, ..own }.draw(&READS)),
    reads("depth that is only tested", TESTS, |own| Own { depth: X, read_only: true, ..own }.query(&READS)),
    both("depth that is cleared", TESTS, DEPTH, |own| Own { depth: X, ..own }.clear()),
    both("colour that is drawn to", OUTPUT, COLOUR, |own| Own { colour: X, ..own }.draw(&READS)),
    both("colour that shapes are drawn to", OUTPUT, COLOUR, |own| Own { colour: X, ..own }.shapes(&READS)),
    both("items that are drawn to", OUTPUT, COLOUR, |own| Own { item: X, ..own }.draw(&READS)),
    both("items that are cleared", OUTPUT, COLOUR, |own| Own { item: X, ..own }.clear()),
    writes("buffer that is filled", MOVES, MOVE, |_| Op::Fill { buffer: buffer(X), value: 0 }),
    reads("source of a copy", MOVES, |own| Op::Copy { from: buffer(X), to: buffer(own.binding) }),
    writes("destination of a copy", MOVES, MOVE, |own| Op::Copy { from: buffer(own.binding), to: buffer(X) }),
    writes("buffer that an image is copied to", MOVES, MOVE, |own| Op::CopyImage {
        from: image(own.depth),
        format: Format::Depth,
        size: [1, 1],
        to: buffer(X),
    }),
    writes("image that is filled", MOVES, MOVE, |own| Op::FillImage {
        from: buffer(own.binding),
        to: image(X),
        format: Format::Depth,
        size: [1, 1],
    }),
    reads("samples that are resolved", MOVES, |own| Op::ResolveColour {
        from: image(X),
        to: image(own.colour),
        size: [1, 1],
    }),
];

fn recorded(first: &Touch, second: &Touch) -> Option<vk::MemoryBarrier2<'static>> {
    let mut recorder = Recorder::default();
    recorder.push("test/first", (first.step)(Own::new(false)));
    recorder.push("test/second", (second.step)(Own::new(true)));
    assert_eq!(recorder.ops.len(), 2);
    assert_eq!(recorder.ops[0].barrier, None, "the first step of all");
    let barrier = recorder.ops[1].barrier.as_ref();
    assert!(barrier.is_none_or(|barrier| barrier.because == X), "{} and {}", first.name, second.name);
    barrier.map(memory_barrier)
}

/// The table against what is recorded: from a frame's steps to the structure that Vulkan gets.
#[test]
fn every_ordered_pair_of_touches_gets_the_barrier_of_the_specification() {
    for (first, second) in TOUCHES.iter().flat_map(|first| TOUCHES.iter().map(move |second| (first, second))) {
        let place = format!("{}, then {}", first.name, second.name);
        let Some(found) = recorded(first, second) else {
            // Two reads need no order. All else does.
            assert!(!first.writes && !second.writes, "{place}: no barrier");
            continue;
        };
        assert!(first.writes || second.writes, "{place}: a barrier between reads");
        // A write after a read waits for the read's stages, and has nothing to make available.
        assert!(found.src_stage_mask.contains(first.stages), "{place}: waits for {:?} alone", found.src_stage_mask);
        assert!(found.src_access_mask.contains(first.write), "{place}: {:?} is available", found.src_access_mask);
        assert_eq!(found.dst_stage_mask, Stages::ALL_COMMANDS, "{place}");
        assert_eq!(found.dst_access_mask, Accesses::MEMORY_READ | Accesses::MEMORY_WRITE, "{place}");
    }
}

/// No step hides which uses it has behind the others that it has: each touch alone, from its own point.
#[test]
fn every_touch_waits_for_its_own_stages_and_no_others() {
    let overwrites = TOUCHES.iter().find(|touch| touch.name == "buffer that is filled").unwrap();
    for touch in &TOUCHES {
        let uses = crate::recorder::uses(&(touch.step)(Own::new(false)));
        let shared: Vec<_> = uses.into_iter().filter(|each| each.resource == X).collect();
        assert_eq!(shared.len(), 1, "{}", touch.name);
        assert_eq!((shared[0].reads, shared[0].writes), (touch.reads, touch.writes), "{}", touch.name);
        let (stages, write) = source(shared[0].point);
        assert_eq!(stages, touch.stages, "{}", touch.name);
        assert_eq!(if touch.writes { write } else { NONE }, touch.write, "{}", touch.name);
        assert!(recorded(touch, overwrites).is_some(), "{}: it is overwritten while it is used", touch.name);
    }
}

/// One barrier for several uses before it: all stages, and the writes of those that wrote.
#[test]
fn a_barrier_waits_for_all_stages_since_the_last_and_makes_only_writes_available() {
    let bits = |points: &[Point]| points.iter().fold(0, |bits, point| bits | point.bit());
    let points = [Point::Indirect, Point::Colour, Point::Transfer];
    let barrier = Barrier { after: bits(&points), written: bits(&points[2..]), because: X };
    let found = memory_barrier(&barrier);
    assert_eq!(found.src_stage_mask, Stages::DRAW_INDIRECT | OUTPUT | MOVES);
    assert_eq!(found.src_access_mask, MOVE);
    let all = memory_barrier(&Barrier { after: 0b111_1111, written: 0b111_1111, because: X });
    assert_eq!(all.src_stage_mask, Stages::DRAW_INDIRECT | FETCH | SHADERS | TESTS | OUTPUT | COMPUTE | MOVES);
    assert_eq!(all.src_access_mask, STORE | DEPTH | COLOUR | MOVE);
}

/// The host reads mapped buffers after a submission, and writes them before the next one. Vulkan orders host writes before a submission by the
/// submission itself. Host reads need the writes of all commands available to HOST.
#[test]
fn the_host_sees_what_a_submission_wrote() {
    let edge = everything();
    assert_eq!((edge.src_stage_mask, edge.src_access_mask), (Stages::ALL_COMMANDS, Accesses::MEMORY_WRITE));
    assert_eq!(edge.dst_stage_mask, Stages::ALL_COMMANDS | Stages::HOST);
    assert_eq!(edge.dst_access_mask, Accesses::MEMORY_READ | Accesses::MEMORY_WRITE);
}

/// The tracker knows buffers and no ranges: two disjoint ranges of one buffer are cut as two that overlap are. Slower than it could be, and never wrong.
#[test]
fn ranges_of_one_buffer_are_cut_as_the_whole_buffer_is() {
    let part = |offset, size| Bound::Buffer { id: X, raw: 0, offset, size };
    let barrier = |first, second| {
        let mut recorder = Recorder::default();
        recorder.push("test/fill", Op::Fill { buffer: first, value: 1 });
        recorder.push("test/fill", Op::Fill { buffer: second, value: 2 });
        recorder.ops[1].barrier
    };
    let whole = barrier(part(0, 64), part(0, 64));
    assert!(whole.is_some());
    for (case, second) in [("disjoint", part(32, 32)), ("overlapping", part(16, 32)), ("inside", part(4, 4))] {
        assert_eq!(barrier(part(0, 32), second), whole, "{case}");
    }
}

fn listed(count: bool) -> Recorded {
    let own = Own::new(false);
    let op = if count { own.draw(&READS) } else { own.query(&READS) };
    Recorded { label: if count { "test/counted" } else { "test/plain" }.to_owned(), op, barrier: None }
}

#[test]
fn counts_may_follow_plain_draws_and_each_other() {
    assert_counts_do_not_lapse(&[listed(false), listed(false), listed(true), listed(true)]);
    assert_counts_do_not_lapse(&[listed(true), Recorded { op: Own::new(true).clear(), ..listed(false) }]);
}

#[test]
#[should_panic(expected = "test/plain: a draw without a count after one with a count")]
fn a_plain_draw_may_not_follow_a_count() {
    assert_counts_do_not_lapse(&[listed(true), listed(true), listed(false)]);
}
