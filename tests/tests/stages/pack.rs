//! `pack/*`: commands in object order, at sizes around every limit.

use culling::pack::{twin, Commands};
use culling::{DrawList, World};
use engine::{Buffer, Gpu, Placement};
use harness::{gpu, worlds, Random};
use shaders::pack::{
    CountFlags, ScanCounts, ScanCountsConstants, WriteCommands, WriteInstances, WriteInstancesConstants,
};
use shaders::types::{DrawCommand, MeshRange, PACK_CHUNK};

const STORAGE: Placement = Placement::Storage;

fn flags(random: &mut Random, count: usize, share: f64) -> Vec<u32> {
    // Any value but 0 is a flag.
    (0..count).map(|_| if random.unit() < share { 1 + random.below(3) as u32 * 0x7fff_ffff } else { 0 }).collect()
}

/// The value of words that no stage has written. Buffers end with one such word more, which no stage may read or write.
const UNTOUCHED: u32 = 0xdead_beef;

/// A buffer of `len` words and the word behind them.
fn guarded(gpu: &Gpu, len: usize) -> Buffer<u32> {
    Buffer::with_data(gpu, "test.words", &vec![UNTOUCHED; len + 1], STORAGE).unwrap()
}

/// Reads the words before the last one, which must be untouched.
fn read_guarded(buffer: &Buffer<u32>) -> Vec<u32> {
    let mut words = buffer.read().unwrap();
    assert_eq!(words.pop(), Some(UNTOUCHED), "written behind the end");
    words
}

/// Counts, starts, total and commands as the stages make them, over the objects from `first` on.
fn run(
    gpu: &Gpu,
    flags: &[u32],
    first: usize,
    object_meshes: &[u32],
    meshes: &[MeshRange],
) -> (Vec<u32>, Vec<u32>, u32, Vec<DrawCommand>) {
    let count = flags.len() - first;
    let chunk_count = count.div_ceil(PACK_CHUNK as usize);
    let (counts, starts, total) = (guarded(gpu, chunk_count), guarded(gpu, chunk_count), guarded(gpu, 1));
    // An object behind the last one is flagged too, and has a mesh.
    let flags = Buffer::with_data(gpu, "test.flags", &[flags, &[UNTOUCHED]].concat(), STORAGE).unwrap();
    let object_meshes = [object_meshes, &[0]].concat();
    let object_meshes = Buffer::with_data(gpu, "test.object_meshes", &object_meshes, STORAGE).unwrap();
    let meshes = Buffer::with_data(gpu, "test.meshes", meshes, STORAGE).unwrap();
    let commands = Buffer::<DrawCommand>::new(gpu, "test.commands", flags.len(), STORAGE).unwrap();
    let (first_object, object_count) = (first as u32, count as u32);
    let constants = ScanCountsConstants { subgroup_size: gpu.subgroup_size() };
    let mut f = gpu.frame();
    f.dispatch(CountFlags { flags: flags.all(), counts: counts.all(), first_object, object_count }, chunk_count as u32);
    let scan = ScanCounts {
        counts: counts.all(),
        starts: starts.all(),
        total: total.all(),
        chunk_count: chunk_count as u32,
        constants,
    };
    f.dispatch_groups(scan, 1);
    let write = WriteCommands {
        flags: flags.all(),
        counts: counts.all(),
        starts: starts.all(),
        object_meshes: object_meshes.all(),
        meshes: meshes.all(),
        commands: commands.all(),
        first_object,
        object_count,
    };
    f.dispatch(write, chunk_count as u32);
    f.finish().unwrap();
    (read_guarded(&counts), read_guarded(&starts), read_guarded(&total)[0], commands.read().unwrap())
}

#[test]
fn packing_equals_its_twins_at_any_number_of_objects() {
    let gpu = gpu();
    let mut random = Random::new(51);
    for count in [1, 2, 63, 64, 65, 511, 512, 513, 4095, 4096, 100_003] {
        for share in [0.0, 0.02, 0.5, 1.0] {
            let flags = flags(&mut random, count, share);
            let meshes: Vec<_> = (0..5)
                .map(|mesh| MeshRange { first_index: mesh * 7, index_count: 3 * mesh, vertex_offset: -(mesh as i32) })
                .collect();
            let object_meshes: Vec<u32> = (0..count).map(|_| random.below(5) as u32).collect();
            let first = if count % 3 == 0 { count / 3 } else { 0 };
            let (counts, starts, total, commands) = run(&gpu, &flags, first, &object_meshes, &meshes);
            let expected_counts = twin::count_flags(&flags[first..]);
            let (expected_starts, expected_total) = twin::scan_counts(&expected_counts);
            assert_eq!(
                (counts, starts, total),
                (expected_counts, expected_starts, expected_total),
                "{count} objects, share {share}"
            );
            let mut before = flags.clone();
            before[..first].fill(0);
            let expected = twin::write_commands(&before, &object_meshes, &meshes);
            assert_eq!(&commands[first..first + total as usize], &expected[..], "{count} objects, share {share}");
            let untouched = commands[..first].iter().chain(&commands[first + total as usize..]);
            assert!(
                untouched.into_iter().all(|command| *command == DrawCommand::default()),
                "{count} objects: written outside the list"
            );
        }
    }
}

/// Each list has its own work-group. At these numbers of chunks some lanes stand behind the end of their list, in the next one.
#[test]
fn several_lists_are_scanned_apart() {
    let gpu = gpu();
    let mut random = Random::new(52);
    for chunk_count in [1, 5, 8, 37] {
        let lists: Vec<Vec<u32>> =
            (0..3).map(|_| (0..chunk_count).map(|_| 1 + random.below(64) as u32).collect()).collect();
        let counts = Buffer::with_data(&gpu, "test.counts", &lists.concat(), STORAGE).unwrap();
        let (starts, total) = (guarded(&gpu, 3 * chunk_count), guarded(&gpu, 3));
        let scan = ScanCounts {
            counts: counts.all(),
            starts: starts.all(),
            total: total.all(),
            chunk_count: chunk_count as u32,
            constants: ScanCountsConstants { subgroup_size: gpu.subgroup_size() },
        };
        let mut f = gpu.frame();
        f.dispatch_groups(scan, 3);
        f.finish().unwrap();
        let (expected_starts, expected_totals): (Vec<_>, Vec<_>) =
            lists.iter().map(|counts| twin::scan_counts(counts)).unzip();
        assert_eq!(read_guarded(&starts), expected_starts.concat(), "{chunk_count} chunks");
        assert_eq!(read_guarded(&total), expected_totals, "{chunk_count} chunks");
    }
}

/// lavapipe ends loops without a word after 65,535 rounds: ten million objects must still be below that.
#[test]
fn ten_million_flags_are_counted_and_scanned() {
    let gpu = gpu();
    let count = 10_000_000u32;
    let chunk_count = count.div_ceil(PACK_CHUNK);
    assert_eq!(chunk_count, 156_250);
    let flags: Vec<u32> = (0..count).map(|object| u32::from(object % 7 == 0 || object > 9_999_000)).collect();
    let input = Buffer::with_data(&gpu, "test.flags", &flags, STORAGE).unwrap();
    let words = |len: u32| Buffer::<u32>::new(&gpu, "test.words", len as usize, STORAGE).unwrap();
    let (counts, starts, total) = (words(chunk_count), words(chunk_count), words(1));
    let mut f = gpu.frame();
    f.dispatch(
        CountFlags { flags: input.all(), counts: counts.all(), first_object: 0, object_count: count },
        chunk_count,
    );
    let constants = ScanCountsConstants { subgroup_size: gpu.subgroup_size() };
    f.dispatch_groups(
        ScanCounts { counts: counts.all(), starts: starts.all(), total: total.all(), chunk_count, constants },
        1,
    );
    f.finish().unwrap();
    let expected = twin::count_flags(&flags);
    assert_eq!(counts.read().unwrap(), expected);
    let (expected_starts, expected_total) = twin::scan_counts(&expected);
    assert_eq!(total.read().unwrap(), [expected_total]);
    assert_eq!(starts.read().unwrap(), expected_starts);
}

#[test]
fn each_kind_of_primitive_is_packed_in_its_own_range() {
    let gpu = gpu();
    let case = worlds::special::topologies();
    let world = World::new(&gpu, &case.scene).unwrap();
    assert_eq!(world.ranges().len(), 3);
    let mut random = Random::new(52);
    let chosen = flags(&mut random, world.len(), 0.4);
    let buffer = Buffer::with_data(&gpu, "test.flags", &chosen, STORAGE).unwrap();
    let list = DrawList::new(&gpu, "test.list", &world).unwrap();
    let targets = sightline::run::targets::Targets::new(&gpu, case.size).unwrap();
    let view = culling::View::new(&case.shots[0], case.size, 0, gpu.snap_px());
    let mut f = gpu.frame();
    f.clear(&targets.timed());
    list.pack(&mut f, &world, buffer.all());
    world.draw(&mut f, &list, &view, &targets.timed());
    let report = f.finish().unwrap();
    let drawn = culling::drawn_objects(&gpu, &world, &report).unwrap();
    assert_eq!(drawn.objects, chosen.iter().map(|flag| *flag != 0).collect::<Vec<_>>());
    assert_eq!(drawn.draws, chosen.iter().filter(|flag| **flag != 0).count() as u64);
}

#[test]
fn commands_without_instances_equal_their_twin() {
    let gpu = gpu();
    let mut random = Random::new(53);
    for (count, first, share) in [(1, 0, 1.0), (64, 0, 0.0), (65, 3, 0.5), (5000, 17, 0.01)] {
        let flags = flags(&mut random, count, share);
        let meshes: Vec<_> = (0..5)
            .map(|mesh| MeshRange { first_index: mesh * 7, index_count: 3 * mesh, vertex_offset: -(mesh as i32) })
            .collect();
        let object_meshes: Vec<u32> = (0..count).map(|_| random.below(5) as u32).collect();
        let words = |data: &[u32]| Buffer::with_data(&gpu, "test.words", data, STORAGE).unwrap();
        let (flags_gpu, object_meshes_gpu, end) = (words(&flags), words(&object_meshes), words(&[0]));
        let meshes_gpu = Buffer::with_data(&gpu, "test.meshes", &meshes, STORAGE).unwrap();
        let commands = Buffer::<DrawCommand>::new(&gpu, "test.commands", count, STORAGE).unwrap();
        let places = words(&[0]);
        let stage = WriteInstances {
            flags: flags_gpu.all(),
            object_meshes: object_meshes_gpu.all(),
            meshes: meshes_gpu.all(),
            commands: commands.all(),
            end: end.all(),
            places: places.all(),
            first_object: first as u32,
            object_count: (count - first) as u32,
            constants: WriteInstancesConstants { scattered: false },
        };
        let mut f = gpu.frame();
        f.dispatch(stage, (count - first) as u32);
        f.finish().unwrap();
        let (expected, last) = twin::write_instances(&flags, &object_meshes, &meshes);
        assert_eq!(commands.read().unwrap()[first..], expected[first..], "{count} objects from {first}");
        // The end counts from the range's first object.
        assert_eq!(end.read().unwrap()[0], last.saturating_sub(first as u32), "{count} objects from {first}");
    }
}

/// Shuffled commands are the others, each once, spread evenly: no tenth of the list holds much more than its share.
#[test]
fn shuffled_commands_are_the_same_spread_evenly() {
    let gpu = gpu();
    for case in [worlds::special::topologies(), worlds::walled(5000)] {
        let world = World::new(&gpu, &case.scene).unwrap();
        // Objects in one place of the scene: all commands that draw lie together, if they lie in order.
        let chosen: Vec<u32> = (0..world.len()).map(|object| u32::from(object < world.len() / 5)).collect();
        let flags = Buffer::with_data(&gpu, "test.flags", &chosen, STORAGE).unwrap();
        let run = |style: Commands| -> Vec<Vec<DrawCommand>> {
            let list = DrawList::styled(&gpu, "test.list", &world, style).unwrap();
            let targets = sightline::run::targets::Targets::new(&gpu, case.size).unwrap();
            let view = culling::View::new(&case.shots[0], case.size, 0, gpu.snap_px());
            let mut f = gpu.frame();
            f.clear(&targets.timed());
            list.pack(&mut f, &world, flags.all());
            world.draw(&mut f, &list, &view, &targets.timed());
            let report = f.finish().unwrap();
            let read = |draw: &engine::IndexedIndirect| {
                let mut commands = gpu.read_bound::<DrawCommand>(&draw.commands).unwrap();
                commands.truncate(draw.max_draws as usize);
                commands
            };
            report.draws.iter().map(read).collect()
        };
        let (ordered, shuffled) = (run(Commands::ZeroInstance), run(Commands::Shuffled));
        let places = culling::pack::scattered(world.ranges());
        for ((ordered, shuffled), range) in ordered.iter().zip(&shuffled).zip(world.ranges()) {
            let own = &places[range.first as usize..(range.first + range.count) as usize];
            let mut sorted = own.to_vec();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..range.count), "no permutation");
            assert_eq!(*shuffled, twin::scatter(ordered, own).0);
            let drawn = |part: &[DrawCommand]| part.iter().filter(|command| command.instance_count > 0).count();
            let tenth = shuffled.len().div_ceil(10);
            let fullest = shuffled.chunks(tenth).map(drawn).max().unwrap_or(0);
            assert!(tenth < 100 || fullest * 10 < 2 * drawn(shuffled), "{fullest} of {} in a tenth", drawn(shuffled));
        }
    }
}
