//! Buffers and images: zeroed, freed, and refused where they are too large.

use culling::boxes::BoxShape;
use culling::{View, World};
use engine::{Buffer, Error, Format, Image, IndexedIndirect, OcclusionQueries, Placement, Queried};
use harness::{gpu, worlds};
use shaders::types::DrawCommand;
use sightline::run::targets::Targets;

const PLACEMENTS: [Placement; 4] = [Placement::Storage, Placement::Geometry, Placement::Upload, Placement::ReadBack];

#[test]
fn new_buffers_are_zero() {
    let gpu = gpu();
    for placement in PLACEMENTS {
        for len in [1, 3, 100_000] {
            // Dirt where the next buffer will likely lie.
            drop(Buffer::with_data(&gpu, "test.dirt", &vec![u32::MAX; len], placement).unwrap());
            let fresh = Buffer::<u32>::new(&gpu, "test.fresh", len, placement).unwrap();
            assert!(fresh.read().unwrap().iter().all(|word| *word == 0), "{placement:?}, {len} words");
        }
    }
}

#[test]
fn what_is_written_is_read_back() {
    let gpu = gpu();
    // More than one piece of staging.
    let words: Vec<u32> = (0..10_000_019u32).map(|word| word.wrapping_mul(2_654_435_761)).collect();
    let buffer = Buffer::with_data(&gpu, "test.words", &words, Placement::Storage).unwrap();
    assert!(buffer.read().unwrap() == words);
    for placement in PLACEMENTS {
        let mut small = Buffer::with_data(&gpu, "test.bytes", &[1u8, 2, 3, 4, 5], placement).unwrap();
        small.write(&[9, 8]).unwrap();
        assert_eq!(small.read().unwrap(), [9, 8, 3, 4, 5], "{placement:?}");
        let empty = Buffer::<u64>::new(&gpu, "test.empty", 0, placement).unwrap();
        assert!(empty.is_empty() && empty.read().unwrap().is_empty());
    }
}

#[test]
fn dropped_resources_are_freed() {
    let gpu = gpu();
    let before = gpu.memory_mib();
    for _ in 0..20 {
        let buffer = Buffer::<u32>::new(&gpu, "test.large", 4 << 20, Placement::Storage).unwrap();
        let image = Image::new(&gpu, "test.image", Format::Depth, [1024, 1024]).unwrap();
        assert!(gpu.memory_mib() >= before + 20.0, "16 MiB and 4 MiB are counted");
        drop((buffer, image));
        assert!((gpu.memory_mib() - before).abs() < 0.01, "{} MiB are left of {before}", gpu.memory_mib());
    }
}

#[test]
fn a_recorded_frame_keeps_what_it_names_alive() {
    let gpu = gpu();
    let before = gpu.memory_mib();
    let result = Buffer::<u32>::new(&gpu, "test.result", 64, Placement::ReadBack).unwrap();
    let mut f = gpu.frame();
    {
        let words = Buffer::with_data(&gpu, "test.words", &[5u32; 64], Placement::Storage).unwrap();
        f.copy("test/copy", words.all(), result.all());
    }
    f.finish().unwrap();
    assert_eq!(result.read().unwrap(), [5; 64]);
    drop(result);
    drop(gpu.frame());
    assert!((gpu.memory_mib() - before).abs() < 0.01, "{} MiB are left of {before}", gpu.memory_mib());
}

/// The pool goes while a frame that queries is recorded; a layer that saw it destroyed would say so.
#[test]
fn a_recorded_frame_keeps_the_queries_that_it_names_alive() {
    let gpu = gpu();
    let case = worlds::walled(20);
    let world = World::new(&gpu, &case.scene).unwrap();
    let targets = Targets::new(&gpu, case.size).unwrap();
    let mut shape = BoxShape::new(&gpu, "test", 1).unwrap();
    shape.look(&View::new(&case.shots[0], case.size, 0, gpu.snap_px())).unwrap();
    let commands = [DrawCommand { instance_count: 1, ..BoxShape::no_boxes(0) }];
    let commands = Buffer::with_data(&gpu, "test.commands", &commands, Placement::Upload).unwrap();
    let listed = Buffer::with_data(&gpu, "test.listed", &[0], Placement::Upload).unwrap();
    let target = targets.timed();
    let mut f = gpu.frame();
    f.clear(&target);
    {
        let queries = OcclusionQueries::new(&gpu, "test.queries", 1).unwrap();
        let stage = shaders::queries::TestObjects { bounds: world.bounds(), listed: listed.all(), views: shape.view() };
        let draw = IndexedIndirect { count: None, ..shape.draw(commands.all(), 1) };
        f.query_boxes(stage, draw, Queried { queries: &queries, first: 0 }, &target.test_only());
    }
    f.finish().unwrap();
}

#[test]
fn a_huge_image_is_refused_by_name() {
    let gpu = gpu();
    for size in [[1 << 20, 4], [4, 1 << 20], [0, 4], [u32::MAX; 2]] {
        let Err(error) = Image::new(&gpu, "the picture", Format::Colour, size) else { panic!("{size:?} was made") };
        assert!(matches!(error, Error::TooLarge { .. }), "{error}");
        assert!(error.to_string().contains("the picture") && error.to_string().contains("--size"), "{error}");
    }
}

#[test]
fn a_huge_buffer_is_refused_by_name() {
    let gpu = gpu();
    let before = gpu.memory_mib();
    let Err(error) = Buffer::<u32>::new(&gpu, "the flags", 1 << 32, Placement::Storage) else {
        panic!("16 GiB were bound")
    };
    assert!(matches!(error, Error::TooLarge { .. }) && error.to_string().contains("the flags"), "{error}");
    let Err(error) = Buffer::<u32>::new(&gpu, "the vertices", 1 << 42, Placement::Geometry) else {
        panic!("16 TiB were made")
    };
    assert!(matches!(error, Error::TooLarge { .. } | Error::OutOfMemory { .. } | Error::Vulkan { .. }), "{error}");
    assert!((gpu.memory_mib() - before).abs() < 0.01, "a refused buffer is not counted");
    // The layer says what we say.
    let _ = gpu.take_messages();
}
