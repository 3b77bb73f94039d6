//! `roc/measure_boxes`, `roc/assign_ranges` and `roc/list_ranges` against their twins: walls and bodies, lines and points, boxes
//! that reach the near plane, bounds without a meaning, every kind of camera.

use culling::roc::{depth_plane, twin, Cuts};
use culling::{View, World};
use engine::{Buffer, Gpu, Placement};
use harness::worlds::{special_projections, walled};
use harness::{gpu, Random};
use scenes::Shot;
use shaders::types::*;
use shaders::{pack, roc};

fn stored<T: bytemuck::Pod>(gpu: &Gpu, data: &[T]) -> Buffer<T> {
    Buffer::with_data(gpu, "test", data, Placement::Storage).unwrap()
}

fn words(gpu: &Gpu, len: usize) -> Buffer<u32> {
    stored(gpu, &vec![0xdead_beef; len])
}

fn views(gpu: &Gpu) -> Vec<(&'static str, View)> {
    let poses = walled(1).shots;
    let look = |(index, (name, projection)): (usize, (&'static str, scenes::Projection))| {
        let shot = Shot { projection, ..poses[index % poses.len()] };
        (name, View::new(&shot, [161, 97], 0, gpu.snap_px()))
    };
    special_projections().into_iter().enumerate().map(look).collect()
}

/// Bounds of a world, some of them without a meaning, and which the last frame saw.
fn input(random: &mut Random, world: &World) -> (Vec<Bounds>, Vec<u32>) {
    let mut bounds = world.read_bounds().unwrap();
    bounds.iter_mut().step_by(17).for_each(|bound| bound.flags |= OBJECT_ALWAYS_KEPT);
    // One so large that it begins behind every eye.
    bounds[1].half_extent = [1.0e6; 3];
    let seen = bounds.iter().map(|_| u32::from(random.below(4) == 0)).collect();
    (bounds, seen)
}

#[test]
fn measuring_boxes_equals_its_twin() {
    let gpu = gpu();
    let mut random = Random::new(81);
    let world = World::new(&gpu, &walled(600).scene).unwrap();
    for (name, view) in views(&gpu) {
        let (bounds, seen) = input(&mut random, &world);
        let (bounds_gpu, seen_gpu, farthest) = (stored(&gpu, &bounds), stored(&gpu, &seen), stored(&gpu, &[0u32]));
        let (selected, depths) = (words(&gpu, bounds.len()), stored(&gpu, &vec![-1.0f32; bounds.len()]));
        let mut f = gpu.frame();
        let stage = roc::MeasureBoxes {
            bounds: bounds_gpu.all(),
            seen: seen_gpu.all(),
            selected: selected.all(),
            depths: depths.all(),
            farthest: farthest.all(),
            view: view.cull(),
            depth_plane: depth_plane(&view),
            object_count: bounds.len() as u32,
        };
        f.dispatch(stage, bounds.len() as u32);
        f.finish().unwrap();
        let (expected, expected_depths, expected_farthest) =
            twin::measure_boxes(&bounds, &view.cull(), depth_plane(&view), &seen);
        assert_eq!(selected.read().unwrap(), expected, "{name}");
        // The products of a depth may be fused or not; anything else must be the same.
        let close = |a: f32, b: f32| (a - b).abs() <= 1e-5 * (1.0 + a.abs());
        let depths = depths.read().unwrap();
        assert!(depths.iter().zip(&expected_depths).all(|(a, b)| close(*a, *b)), "{name}");
        let farthest = f32::from_bits(farthest.read().unwrap()[0]);
        assert!(close(farthest, expected_farthest), "{name}: {farthest}, not {expected_farthest}");
        assert!(farthest > 1.0, "{name}: something must be in view");
        for kind in [SELECT_SEEN, SELECT_TESTED, SELECT_SHOWN] {
            assert!(expected.contains(&kind), "{name}: the case must have objects of kind {kind}");
        }
    }
}

/// View depth is in metres, whatever the camera: no box begins nearer than a point in it, and the eye is at 0.
#[test]
fn depths_are_metres_from_the_eye() {
    let gpu = gpu();
    for (name, view) in views(&gpu) {
        let [x, y, z, w] = depth_plane(&view).map(f64::from);
        let normal = glam::DVec3::new(x, y, z);
        assert!((normal.length() - 1.0).abs() < 1e-6, "{name}: {normal} has no unit length");
        let forward = view.pose.rotation * glam::DVec3::NEG_Z;
        assert!(normal.dot(forward) > 0.9, "{name}: depth must grow forward");
        // Where it is 0: the eye, or the near plane, which lies 3 m behind the parallel camera.
        let expected = if name == "parallel" { 3.0 } else { 0.0 };
        assert!((w - expected).abs() < 1e-6, "{name}: {w}");
    }
}

fn cuts(ranges: u32, outermost: Option<f32>, factor: f32, show_beyond: bool) -> Cuts {
    Cuts { ranges, outermost, share: 1.0 / factor, show_beyond }
}

#[test]
fn assigning_and_listing_equal_their_twins() {
    let gpu = gpu();
    let mut random = Random::new(82);
    let meshes: Vec<_> =
        (0..5).map(|mesh| MeshRange { first_index: mesh * 7, index_count: 3 * mesh, vertex_offset: -5 }).collect();
    for (len, first) in [(1, 0), (63, 0), (64, 0), (65, 1), (128, 64), (3001, 700)] {
        for cuts in [
            cuts(1, None, 2.0, false),
            cuts(3, None, 16.0, true),
            cuts(4, Some(20.0), 2.0, true),
            cuts(8, Some(50.0), 3.0, false),
        ] {
            let selected: Vec<u32> = (0..len).map(|_| random.below(4) as u32).collect();
            let mut depths: Vec<f32> = (0..len).map(|_| random.decade(0.01, 100.0) as f32).collect();
            depths[len / 2] = 0.0;
            let farthest = depths.iter().copied().fold(0.0, f32::max);
            let object_meshes: Vec<u32> = (0..len).map(|_| random.below(5) as u32).collect();
            let found = run(&gpu, &cuts, first, (&selected, &depths, farthest), &object_meshes, &meshes);
            let (places, counts) = twin::assign_ranges(&selected[first..], &depths[first..], farthest, &cuts);
            assert_eq!(found.places[first..], places, "{len} objects from {first}, {cuts:?}");
            assert_eq!(found.counts, counts.concat(), "{len} objects from {first}, {cuts:?}");
            let mut all = vec![SELECT_NONE; first];
            all.extend(&places);
            let lists = twin::list_ranges(&all, cuts.ranges, &object_meshes, &meshes);
            assert_lists(&found, &lists, first, len, &cuts);
        }
    }
}

/// What the stages left.
struct Found {
    places: Vec<u32>,
    counts: Vec<u32>,
    totals: Vec<u32>,
    early: Vec<DrawCommand>,
    late: Vec<DrawCommand>,
    boxes: Vec<DrawCommand>,
}

fn assert_lists(found: &Found, lists: &[Vec<DrawCommand>], first: usize, room: usize, cuts: &Cuts) {
    let ranges = cuts.ranges as usize;
    for (list, expected) in lists.iter().enumerate() {
        let (commands, range) = if list < ranges { (&found.early, list) } else { (&found.late, list - ranges) };
        let at = range * room + first;
        let place = format!("list {list} from {first} of {room}, {cuts:?}");
        assert_eq!(found.totals[list] as usize, expected.len(), "{place}");
        assert_eq!(&commands[at..at + expected.len()], &expected[..], "{place}");
        let end = (range + 1) * room;
        assert!(commands[at + expected.len()..end].iter().all(|rest| *rest == DrawCommand::default()), "{place}");
        if list >= ranges {
            // This kind of primitive is the second of two.
            assert_eq!(found.boxes[2 * range + 1].instance_count as usize, expected.len(), "{place}");
            assert_eq!(found.boxes[2 * range].instance_count, 0, "{place}: the other kind's");
        }
    }
}

fn run(
    gpu: &Gpu,
    cuts: &Cuts,
    first: usize,
    (selected, depths, farthest): (&[u32], &[f32], f32),
    object_meshes: &[u32],
    meshes: &[MeshRange],
) -> Found {
    let (len, ranges) = (selected.len(), cuts.ranges as usize);
    let (first_object, object_count) = (first as u32, (len - first) as u32);
    let chunks = object_count.div_ceil(PACK_CHUNK);
    let (selected, depths, farthest) = (stored(gpu, selected), stored(gpu, depths), stored(gpu, &[farthest.to_bits()]));
    let (object_meshes, meshes) = (stored(gpu, object_meshes), stored(gpu, meshes));
    let lists = 2 * ranges;
    let (counts, starts) = (words(gpu, lists * chunks as usize), words(gpu, lists * chunks as usize));
    let (places, totals) = (words(gpu, len), words(gpu, lists));
    let commands = |len: usize| Buffer::<DrawCommand>::new(gpu, "test.commands", len, Placement::Storage).unwrap();
    let (early, late, boxes) = (commands(ranges * len), commands(ranges * len), commands(2 * ranges));
    let mut f = gpu.frame();
    let assign = roc::AssignRanges {
        selected: selected.all(),
        depths: depths.all(),
        farthest: farthest.all(),
        places: places.all(),
        counts: counts.all(),
        first_object,
        object_count,
        range_count: cuts.ranges,
        outermost: cuts.outermost.unwrap_or(0.0),
        share: cuts.share,
        constants: roc::AssignRangesConstants { show_beyond: cuts.show_beyond },
    };
    f.dispatch(assign, chunks);
    let scan = pack::ScanCounts {
        counts: counts.all(),
        starts: starts.all(),
        total: totals.all(),
        chunk_count: chunks,
        constants: pack::ScanCountsConstants { subgroup_size: gpu.subgroup_size() },
    };
    f.dispatch_groups(scan, lists as u32);
    let list = roc::ListRanges {
        places: places.all(),
        starts: starts.all(),
        totals: totals.all(),
        object_meshes: object_meshes.all(),
        meshes: meshes.all(),
        early: early.all(),
        late: late.all(),
        boxes: boxes.all(),
        first_object,
        object_count,
        range_count: cuts.ranges,
        room: len as u32,
        kind: 1,
        kind_count: 2,
    };
    f.dispatch(list, chunks);
    f.finish().unwrap();
    let (places, counts, totals) = (places.read().unwrap(), counts.read().unwrap(), totals.read().unwrap());
    let (early, late, boxes) = (early.read().unwrap(), late.read().unwrap(), boxes.read().unwrap());
    Found { places, counts, totals, early, late, boxes }
}
