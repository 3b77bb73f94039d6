//! The stages of `hzb-iterative` against their twins: boxes by chance before and behind a depth by chance, every kind of camera, lists of
//! no, one and many blocks, three kinds of primitive.

use super::input::{Input, BOXES, WALL};
use culling::hzb::iterative::twin;
use engine::{Buffer, Gpu, Placement};
use harness::worlds::special_projections;
use harness::{gpu, Random};
use shaders::hzb;
use shaders::types::*;

fn stored<T: bytemuck::Pod>(gpu: &Gpu, data: &[T]) -> Buffer<T> {
    Buffer::with_data(gpu, "test", data, Placement::Storage).unwrap()
}

fn words(gpu: &Gpu, len: usize) -> Buffer<u32> {
    stored(gpu, &vec![0xdead_beef; len])
}

/// At a tie of roundings stage and twin may decide differently, but not often.
#[track_caller]
fn assert_few(differ: usize, all: usize, what: &str) {
    println!("{what}: {differ} of {all} differ");
    assert!(differ <= all / 500, "{what}: {differ} of {all} differ");
}

#[test]
fn blocks_are_measured_and_tested_as_the_twins_say() {
    let gpu = gpu();
    let mut random = Random::new(1301);
    let (mut all_blocks, mut differ, mut due_blocks) = (0, 0, 0);
    let mut by_fronts = 0;
    for (name, input) in Input::all(&mut random) {
        let views = StepView { object_count: (BOXES * BLOCK_OBJECTS as usize) as u32, ..input.all };
        let (bounds, views) = (stored(&gpu, &input.bounds), stored(&gpu, &[views]));
        let (levels, texels) = (stored(&gpu, &input.levels), stored(&gpu, &input.texels));
        let (spans, reach) = (stored(&gpu, &vec![BlockSpan::default(); BOXES]), stored(&gpu, &[0u32; 2]));
        // Some three quarters of the blocks have an object that was seen.
        let seen: Vec<u32> = (0..BOXES * BLOCK_OBJECTS as usize).map(|_| u32::from(random.below(50) == 0)).collect();
        let seen_gpu = stored(&gpu, &seen);
        let mut f = gpu.frame();
        let measure =
            hzb::MeasureBlocks { bounds: bounds.all(), spans: spans.all(), reach: reach.all(), views: views.all() };
        f.dispatch(measure, BOXES as u32);
        f.finish().unwrap();
        let mut gpu_spans = spans.read().unwrap();
        let found = reach.read().unwrap();
        let found = twin::Reach { farthest: f32::from_bits(found[0]), nearest: f32::from_bits(!found[1]) };
        let (twin_spans, twin_reach) = twin::measure_blocks(&input.bounds, &input.all);
        let close = |one: f32, other: f32| (one - other).abs() <= 1e-4 * twin_reach.farthest;
        assert!(
            close(found.farthest, twin_reach.farthest) && close(found.nearest, twin_reach.nearest),
            "{name}: {found:?} {twin_reach:?}"
        );
        let near = |a: f32, b: f32| (a - b).abs() <= 1e-4 * (a.abs() + b.abs()) + 1e-3;
        let same = |(a, b): &(&BlockSpan, &BlockSpan)| near(a.begin, b.begin) && near(a.end, b.end);
        differ += gpu_spans.iter().zip(&twin_spans).filter(|pair| !same(pair)).count();
        // In several ranges, and in the only one, where nothing was measured.
        for (step, measured) in [(0, true), (1, true), (2, true), (3, true), (0, false), (1, false)] {
            let due = words(&gpu, BOXES);
            let (behind, fronts) = (step > 0, step != 2);
            let mut f = gpu.frame();
            let test = hzb::TestBlocks {
                bounds: bounds.all(),
                spans: spans.all(),
                reach: reach.all(),
                views: views.all(),
                levels: levels.all(),
                pyramid: texels.all(),
                seen: seen_gpu.all(),
                due: due.all(),
                step,
                constants: hzb::TestBlocksConstants {
                    footprint_texels: 4,
                    behind,
                    measured,
                    fronts,
                    finest_level: input.finest,
                },
            };
            f.dispatch(test, BOXES as u32);
            f.finish().unwrap();
            let pyramid = behind.then(|| input.test());
            let spans_before = measured.then_some(&mut gpu_spans[..]);
            let seen_blocks = (&input.bounds[..], &seen[..]);
            let twin_due =
                twin::test_blocks(seen_blocks, spans_before, found, &input.all, pyramid.as_ref(), (step, fronts));
            let found_due = due.read().unwrap();
            if fronts && !measured {
                let plain = twin::test_blocks(seen_blocks, None, found, &input.all, pyramid.as_ref(), (step, false));
                by_fronts += plain.iter().sum::<u32>() - twin_due.iter().sum::<u32>();
            }
            differ += found_due.iter().zip(&twin_due).filter(|(a, b)| a != b).count();
            due_blocks += found_due.iter().sum::<u32>() as usize;
            gpu_spans = spans.read().unwrap();
        }
        all_blocks += 6 * BOXES;
    }
    assert!(
        due_blocks > all_blocks / 20 && due_blocks < all_blocks / 2,
        "{due_blocks} of {all_blocks} due prove little"
    );
    assert!(by_fronts as usize > all_blocks / 170, "{by_fronts} blocks hidden by their fronts alone prove little");
    assert_few(differ, all_blocks, "blocks");
}

#[test]
fn an_object_is_due_in_a_step_of_its_block() {
    // What is not looked at is not drawn: the spans of blocks must hold the ranges of their objects, roundings included.
    let gpu = gpu();
    let mut random = Random::new(77);
    for (name, projection) in special_projections() {
        let mut input = Input::by_chance(&mut random, gpu.snap_px(), projection);
        input.all.range_count = MOST_STEP_RANGES;
        let (spans, reach) = twin::measure_blocks(&input.bounds, &input.all);
        let range = |depth| reach.range_of(depth, &input.all);
        for (bound, span) in input.bounds.iter().zip(spans).filter(|(_, span)| span.begin <= span.end) {
            let kept = bound.flags & OBJECT_ALWAYS_KEPT != 0;
            let begin =
                if kept { 0.0 } else { culling::roc::twin::depth_of(bound, &input.all.view, input.all.depth_plane) };
            assert!((range(span.begin)..=range(span.end)).contains(&range(begin)), "{name}: {bound:?}");
        }
    }
}

#[test]
fn blocks_are_listed_as_the_twin_says() {
    let gpu = gpu();
    let mut random = Random::new(5);
    for (blocks, one_in) in [(1, 1), (1, 9), (63, 2), (64, 1), (1_000, 7), (70_001, 1), (70_001, 1_000)] {
        let due: Vec<u32> = (0..blocks).map(|block| u32::from(block % one_in == 0 && random.below(9) > 0)).collect();
        let (due_gpu, list, counts) = (stored(&gpu, &due), words(&gpu, 8 + blocks), words(&gpu, 2 * blocks));
        let mut f = gpu.frame();
        let stage = hzb::ListBlocks {
            due: due_gpu.all(),
            blocks: list.all(),
            counts: counts.all(),
            block_count: blocks as u32,
            kind_count: 2,
            constants: hzb::ListBlocksConstants { subgroup_size: gpu.subgroup_size() },
        };
        f.dispatch_groups(stage, 1);
        f.finish().unwrap();
        let (twin, mut found) = (twin::list_blocks(&due), list.read().unwrap());
        found[7] = 0; // the header's last word has no meaning
        assert_eq!(found[..twin.len()], twin, "{blocks} blocks");
        let listed = twin.len() - LISTED_HEADER as usize;
        let counts = counts.read().unwrap();
        assert!(
            (0..2).all(|kind| counts[kind * blocks..][..listed].iter().all(|count| *count == 0)),
            "{blocks} blocks"
        );
    }
}

#[test]
fn objects_are_found_and_their_commands_written_as_the_twins_say() {
    let gpu = gpu();
    let mut random = Random::new(4711);
    let meshes: Vec<MeshRange> =
        (0..40).map(|mesh| MeshRange { first_index: 7 * mesh, index_count: 3 * mesh, vertex_offset: -5 }).collect();
    let blocks = BOXES.div_ceil(BLOCK_OBJECTS as usize);
    let (mut all_objects, mut differ, mut outcomes) = (0, 0, [0usize; 3]);
    let mut by_fronts = 0;
    for (number, (name, mut input)) in Input::all(&mut random).into_iter().enumerate() {
        input.all.block_count = blocks as u32;
        let reach = twin::measure_blocks(&input.bounds, &input.all).1;
        let (step, behind, fronts) = match name {
            WALL => (1, true, true),
            _ => (number as u32 % 3, number % 4 != 0, number % 2 == 0),
        };
        let [seen, known] =
            [2, 3].map(|one_in| -> Vec<u32> { (0..BOXES).map(|_| u32::from(random.below(one_in) == 0)).collect() });
        let object_meshes: Vec<u32> = (0..BOXES).map(|_| random.below(40) as u32).collect();
        let list = twin::list_blocks(&(0..blocks).map(|_| u32::from(random.below(3) > 0)).collect::<Vec<_>>());
        let listed = &list[LISTED_HEADER as usize..];
        let found = run(&gpu, &input, (&seen, &known, &object_meshes, &meshes), &list, reach, (step, behind, fronts));

        let pyramid = behind.then(|| input.test());
        let objects = (&input.bounds[..], &seen[..], &known[..]);
        let twin = twin::test_objects(objects, listed, reach, &input.all, pyramid.as_ref(), (step, true, fronts));
        let plain = twin::test_objects(objects, listed, reach, &input.all, pyramid.as_ref(), (step, true, false));
        by_fronts += twin.iter().zip(&plain).filter(|(one, other)| one != other).count();
        // What the GPU made of each object; small meshes are drawn without a test of their box.
        let small = |object: usize| meshes[object_meshes[object] as usize].index_count <= SMALL;
        let mut becomes = vec![STEP_HIDDEN; BOXES];
        for (object, twin) in twin.iter().enumerate() {
            let Some(twin) = *twin else { continue };
            let expected = if twin == STEP_TESTED && small(object) { STEP_SHOWN } else { twin };
            differ += usize::from(found.shown[object] != expected);
            outcomes[found.shown[object] as usize] += 1;
            becomes[object] = found.shown[object];
            all_objects += 1;
        }
        let kinds = [0..2_000, 2_000..3_001, 3_001..BOXES];
        for (kind, objects) in kinds.into_iter().enumerate() {
            let of_kind = |object: usize| if objects.contains(&object) { becomes[object] } else { STEP_HIDDEN };
            let of_kind: Vec<u32> = (0..BOXES).map(of_kind).collect();
            let expected = twin::write_blocks(&of_kind, &object_meshes, &meshes, SMALL);
            let per_block = |block: &u32| {
                let objects = of_kind.iter().skip((block * BLOCK_OBJECTS) as usize).take(BLOCK_OBJECTS as usize);
                objects.filter(|becomes| **becomes != STEP_HIDDEN).count() as u32
            };
            let (starts, total) = twin::scan_blocks(&listed.iter().map(per_block).collect::<Vec<_>>());
            assert_eq!(found.starts[kind * blocks..][..listed.len()], starts, "{name}, kind {kind}");
            assert_eq!((found.totals[kind], found.boxes[kind].instance_count), (total, total), "{name}, kind {kind}");
            assert_eq!(found.commands[objects.start..][..expected.len()], expected, "{name}, kind {kind}");
        }
        let marked = becomes.iter().zip(&known).map(|(becomes, known)| *known | u32::from(*becomes == STEP_SHOWN));
        assert!(found.visible.iter().copied().eq(marked), "{name}: what is drawn for sure counts as seen");
        let drawn = found.totals.iter().any(|total| *total > 0);
        assert_eq!(found.grids, if drawn { [9, 2, 1] } else { [0, 2, 1] }, "{name}");
    }
    assert!(outcomes.iter().all(|count| *count > all_objects / 100), "{outcomes:?} of {all_objects} prove little");
    assert!(by_fronts > all_objects / 100, "{by_fronts} of {all_objects} hidden by their fronts alone prove little");
    assert_few(differ, all_objects, "objects");
}

/// Indices of meshes that need no test of their box.
const SMALL: u32 = 30;

struct Found {
    shown: Vec<u32>,
    visible: Vec<u32>,
    starts: Vec<u32>,
    totals: Vec<u32>,
    boxes: Vec<DrawCommand>,
    grids: Vec<u32>,
    commands: Vec<DrawCommand>,
}

fn run(
    gpu: &Gpu,
    input: &Input,
    (seen, known, object_meshes, meshes): (&[u32], &[u32], &[u32], &[MeshRange]),
    list: &[u32],
    reach: twin::Reach,
    (step, behind, fronts): (u32, bool, bool),
) -> Found {
    let block_count = input.all.block_count;
    let (bounds, views, list) = (stored(gpu, &input.bounds), stored(gpu, &[input.all]), stored(gpu, list));
    let (levels, texels) = (stored(gpu, &input.levels), stored(gpu, &input.texels));
    let (seen, object_meshes, meshes) = (stored(gpu, seen), stored(gpu, object_meshes), stored(gpu, meshes));
    let reach = stored(gpu, &[reach.farthest.to_bits(), !reach.nearest.to_bits()]);
    let (shown, visible) = (words(gpu, BOXES), stored(gpu, known));
    let (totals, grids) = (words(gpu, 3), words(gpu, 3));
    let (counts, starts) = (stored(gpu, &vec![0u32; 3 * block_count as usize]), words(gpu, 3 * block_count as usize));
    let (boxes, commands) =
        (stored(gpu, &[DrawCommand::default(); 3]), stored(gpu, &vec![DrawCommand::default(); BOXES]));
    let full_grids = stored(gpu, &[9u32, 2, 1]);
    let mut f = gpu.frame();
    let test = hzb::TestObjects {
        bounds: bounds.all(),
        seen: seen.all(),
        reach: reach.all(),
        views: views.all(),
        levels: levels.all(),
        pyramid: texels.all(),
        blocks: list.all(),
        shown: shown.all(),
        counts: counts.all(),
        known: visible.all(),
        step,
        constants: hzb::TestObjectsConstants {
            footprint_texels: 4,
            behind,
            boxes: true,
            fronts,
            kind_count: 3,
            finest_level: input.finest,
        },
    };
    f.dispatch_indirect(test, list.all());
    let scan = hzb::ScanBlocks {
        blocks: list.all(),
        counts: counts.all(),
        starts: starts.all(),
        totals: totals.all(),
        boxes: boxes.all(),
        full_grids: full_grids.all(),
        grids: grids.all(),
        block_count,
        kind_count: 3,
        reductions: 1,
        constants: hzb::ScanBlocksConstants { subgroup_size: gpu.subgroup_size() },
    };
    f.dispatch_groups(scan, 1);
    let write = hzb::WriteBlocks {
        blocks: list.all(),
        shown: shown.all(),
        counts: counts.all(),
        starts: starts.all(),
        views: views.all(),
        object_meshes: object_meshes.all(),
        meshes: meshes.all(),
        commands: commands.all(),
        visible: visible.all(),
        small_indices: SMALL,
        constants: hzb::WriteBlocksConstants { kind_count: 3 },
    };
    f.dispatch_indirect(write, list.all().from(LISTED_GRID as usize));
    f.finish().unwrap();
    let read = |buffer: &Buffer<u32>| buffer.read().unwrap();
    Found {
        shown: read(&shown),
        visible: read(&visible),
        starts: read(&starts),
        totals: read(&totals),
        boxes: boxes.read().unwrap(),
        grids: read(&grids),
        commands: commands.read().unwrap(),
    }
}
