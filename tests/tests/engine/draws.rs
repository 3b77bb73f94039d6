//! Lists of draws: how many commands of one are drawn, from where, and what each query counts.

use engine::{
    Buffer, DepthFormat, Extra, Faces, Format, Frame, FrameReport, Gpu, GpuOptions, Image, IndexedIndirect, KeptSample,
    OcclusionQueries, Placement, Primitives, Queried, Samples, Shapes, Surface, Target, TimerMode,
};
use harness::{gpu, options};
use shaders::engine::SpinPixels;
use shaders::types::{DrawCommand, ITEM_NONE};

const SIDE: u32 = 4;
const PIXELS: u64 = (SIDE * SIDE) as u64;

/// A heat picture, which adds up the fragments of each pixel, and pictures of 0 to 7 triangles that cover it, to compare with.
struct Canvas {
    heat: Image,
    _depth: Image,
    target: Target,
    known: Vec<Vec<u8>>,
}

impl Canvas {
    fn new(gpu: &Gpu) -> Self {
        let size = [SIDE; 2];
        let heat = Image::new(gpu, "test.heat", Format::Heat, size).unwrap();
        let depth = Image::new(gpu, "test.depth", Format::Depth, size).unwrap();
        let target = Target {
            size,
            colour: Some((heat.view(), Format::Heat)),
            item: None,
            depth: depth.view(),
            depth_read_only: false,
            strictly_nearer: false,
            samples: None,
        };
        let mut canvas = Canvas { heat, _depth: depth, target, known: Vec::new() };
        for count in 0..8 {
            let shapes = Shapes { corners: 3, count, surface: Surface::Opaque };
            let (picture, _) = canvas.picture(gpu, |f, target| f.draw_shapes(SpinPixels {}, shapes, target));
            assert!(!canvas.known.contains(&picture), "one triangle more is another picture");
            canvas.known.push(picture);
        }
        canvas
    }

    fn picture(&self, gpu: &Gpu, record: impl FnOnce(&mut Frame, &Target)) -> (Vec<u8>, FrameReport) {
        let mut f = gpu.frame();
        f.clear(&self.target);
        record(&mut f, &self.target);
        let report = f.finish().unwrap();
        (self.heat.read().unwrap(), report)
    }

    /// How many triangles were drawn; none if it is not one of the known pictures.
    fn triangles(&self, gpu: &Gpu, record: impl FnOnce(&mut Frame, &Target)) -> (Option<usize>, FrameReport) {
        let (picture, report) = self.picture(gpu, record);
        (self.known.iter().position(|known| *known == picture), report)
    }
}

/// A list of commands that draw 1, 2 and 4 triangles, so that their sum says which were drawn. Neither its commands nor its count begin where their buffer
/// does: a command of 8 triangles and a count of 77 lie in front. Indices do: lavapipe (Mesa 22.3.6) ignores where a range of them begins in
/// indirect draws.
struct List {
    commands: Buffer<DrawCommand>,
    indices: Buffer<u32>,
    count: Option<Buffer<u32>>,
    max_draws: u32,
}

impl List {
    fn new(gpu: &Gpu, count: Option<u32>, max_draws: u32) -> Self {
        let command = |instance_count| DrawCommand { index_count: 3, instance_count, ..DrawCommand::default() };
        let commands = [8, 1, 2, 4].map(command);
        let made = |name, words: &[u32]| Buffer::with_data(gpu, name, words, Placement::Storage).unwrap();
        List {
            commands: Buffer::with_data(gpu, "test.commands", &commands, Placement::Storage).unwrap(),
            indices: made("test.indices", &[0, 1, 2]),
            count: count.map(|count| made("test.count", &[77, count])),
            max_draws,
        }
    }

    fn draw(&self) -> IndexedIndirect {
        IndexedIndirect {
            vertices: self.indices.all().into(),
            instances: self.indices.all().into(),
            indices: self.indices.all().into(),
            commands: self.commands.all().from(1).into(),
            count: self.count.as_ref().map(|count| count.all().from(1)),
            max_draws: self.max_draws,
            primitives: Primitives::Triangles,
            faces: Faces::Both,
            surface: Surface::Opaque,
        }
    }
}

/// A device that can do without nothing that lists are drawn with.
fn plain() -> Gpu {
    let without = [
        Extra::DrawIndirectCount,
        Extra::MultiDrawIndirect,
        Extra::MappedMemory,
        Extra::HostQueryReset,
        Extra::OcclusionQueryPrecise,
    ];
    let mut options = GpuOptions { timer: Some(TimerMode::Split), ..options() };
    options.without.extend(without.map(|extra| extra.name().to_owned()));
    Gpu::open(&options).unwrap()
}

/// The rows of a frame's table. A device without timestamps has none.
fn assert_rows(gpu: &Gpu, report: &FrameReport, expected: &[&str]) {
    let rows: Vec<_> = report.stages.iter().map(|stage| stage.label.as_str()).collect();
    assert_eq!(rows, if gpu.has(Extra::Timestamps) { expected } else { &[] });
}

/// Both ways of drawing lists: with all that the device has, and with a call a command.
fn on_both(test: impl Fn(&Gpu)) {
    let gpu = gpu();
    test(&gpu);
    let plain = plain();
    test(&plain);
    assert_eq!(plain.take_messages(), []);
}

#[test]
fn a_list_draws_as_many_commands_as_its_count_says_and_never_more_than_its_room() {
    let cases = [
        (Some(0), 3, 0),
        (Some(1), 3, 1),
        (Some(2), 3, 1 + 2),
        (Some(3), 3, 1 + 2 + 4),
        (Some(2), 2, 1 + 2),
        (Some(3), 2, 1 + 2),
        (Some(9), 2, 1 + 2),
        (Some(1), 1, 1),
        (None, 1, 1),
        (None, 2, 1 + 2),
        (None, 3, 1 + 2 + 4),
    ];
    on_both(|gpu| {
        let canvas = Canvas::new(gpu);
        for (count, max_draws, expected) in cases {
            let list = List::new(gpu, count, max_draws);
            let (drawn, report) = canvas.triangles(gpu, |f, target| f.draw(SpinPixels {}, list.draw(), target));
            assert_eq!(drawn, Some(expected), "count {count:?}, room for {max_draws}");
            assert_eq!(report.draws.len(), 1, "count {count:?}, room for {max_draws}");
        }
    });
}

#[test]
fn a_list_without_room_is_a_skip_and_no_draw() {
    let gpu = gpu();
    let canvas = Canvas::new(&gpu);
    for count in [None, Some(3)] {
        let list = List::new(&gpu, count, 0);
        let (drawn, report) = canvas.triangles(&gpu, |f, target| f.draw(SpinPixels {}, list.draw(), target));
        assert_eq!((drawn, report.draws.len()), (Some(0), 0));
        let skips: Vec<_> = report.skips.iter().map(|skip| (skip.label.as_str(), skip.reason)).collect();
        assert_eq!(skips, [("engine/spin_pixels", "no objects")]);
    }
}

#[test]
fn draws_that_show_no_object_draw_as_much_and_are_not_among_the_reports() {
    on_both(|gpu| {
        let (canvas, list) = (Canvas::new(gpu), List::new(gpu, None, 2));
        let (drawn, report) = canvas.triangles(gpu, |f, target| {
            f.test_boxes(SpinPixels {}, list.draw(), target);
            f.draw_unshown(SpinPixels {}, IndexedIndirect { max_draws: 1, ..list.draw() }, target);
        });
        assert_eq!((drawn, report.draws.len()), (Some(1 + 2 + 1), 0));
        // On a device that draws a command a call, each draw is still one row.
        assert_rows(gpu, &report, &["target/clear", "engine/spin_pixels", "engine/spin_pixels"]);
    });
}

/// Queries 2 to 4 of 5 are those of the list's commands; the others keep what they have.
#[test]
fn each_command_is_counted_by_its_own_query() {
    on_both(|gpu| {
        let (canvas, list) = (Canvas::new(gpu), List::new(gpu, None, 3));
        let queries = OcclusionQueries::new(gpu, "test.queries", 6).unwrap();
        assert_eq!((queries.len(), queries.is_empty()), (6, false));
        assert!(OcclusionQueries::new(gpu, "test.none", 0).unwrap().is_empty());
        let shapes = Shapes { corners: 3, count: 3, surface: Surface::Opaque };
        let mut counted = Vec::new();
        let (drawn, report) = canvas.triangles(gpu, |f, target| {
            f.query_shapes(SpinPixels {}, shapes, Queried { queries: &queries, first: 1 }, target);
            f.query_boxes(SpinPixels {}, list.draw(), Queried { queries: &queries, first: 2 }, target);
            counted = f.wait_for_queries(&queries, 1..5).unwrap();
            assert_eq!(f.wait_for_queries(&queries, 3..4).unwrap(), [counted[2]]);
            assert_eq!(f.wait_for_queries(&queries, 3..3).unwrap(), [0; 0]);
        });
        assert_eq!(drawn, None, "ten triangles are more than any known picture's");
        assert_eq!((report.draws.len(), report.submissions), (0, 1));
        assert_eq!(queries.counts_samples(), gpu.has(Extra::OcclusionQueryPrecise));
        match queries.counts_samples() {
            true => assert_eq!(counted, [3, 1, 2, 4].map(|triangles| triangles * PIXELS)),
            false => assert!(counted.iter().all(|samples| *samples > 0), "{counted:?}"),
        }
        // Objects are counted in the same way, and are among the report's draws.
        let (_, report) = canvas.triangles(gpu, |f, target| {
            let none = IndexedIndirect { max_draws: 0, ..list.draw() };
            f.query_objects(SpinPixels {}, none, Queried { queries: &queries, first: 0 }, target);
            f.query_objects(SpinPixels {}, list.draw(), Queried { queries: &queries, first: 0 }, target);
            f.query_objects(SpinPixels {}, list.draw(), Queried { queries: &queries, first: 3 }, target);
        });
        assert_eq!((report.draws.len(), report.skips.len()), (2, 1));
        assert_eq!(report.skips[0].reason, "nothing to ask");
        assert!(queries.read(0..3).unwrap().iter().all(|samples| *samples > 0));
    });
}

/// A picture cleared and drawn to, kept in buffers beyond the frame.
#[test]
fn what_a_target_holds_is_kept_texel_by_texel() {
    let gpu = gpu();
    let size = [SIDE, 2];
    let image = |name, format| Image::new(&gpu, name, format, size).unwrap();
    let (colour, item, depth) =
        (image("test.owner", Format::Owner), image("test.item", Format::Item), image("test.depth", Format::Depth));
    let target = Target {
        size,
        colour: Some((colour.view(), Format::Owner)),
        item: Some(item.view()),
        depth: depth.view(),
        depth_read_only: false,
        strictly_nearer: false,
        samples: None,
    };
    let texels = (size[0] * size[1]) as usize;
    let depths = Buffer::with_data(&gpu, "test.depths", &[9.0f32; 10], Placement::ReadBack).unwrap();
    let items = Buffer::with_data(&gpu, "test.items", &[7u32; 10], Placement::ReadBack).unwrap();
    let mut f = gpu.frame();
    f.clear(&target);
    f.copy_depth("test/keep_depth", &target, &depths);
    f.copy_items("test/keep_items", &target, &items);
    f.copy_items("test/keep_nothing", &target.depth_only(), &items);
    let report = f.finish().unwrap();
    assert_rows(&gpu, &report, &["target/clear", "test/keep_depth", "test/keep_items"]);
    assert_eq!(depths.read().unwrap(), [[0.0; 8].as_slice(), &[9.0; 2]].concat());
    assert_eq!(items.read().unwrap(), [[ITEM_NONE; 8].as_slice(), &[7; 2]].concat());
    assert_eq!(colour.read().unwrap(), [0xff; 32], "nobody's index is full bytes");
    let shapes = Shapes { corners: 3, count: 1, surface: Surface::Opaque };
    for (surface, expected) in [(Surface::Translucent, 0.0), (Surface::Opaque, 0.5)] {
        for read_only in [true, false] {
            let to = Target { depth_read_only: read_only, colour: None, item: None, ..target };
            let mut f = gpu.frame();
            f.clear(&target);
            f.draw_shapes(SpinPixels {}, Shapes { surface, ..shapes }, &to);
            f.copy_depth("test/keep_depth", &target, &depths);
            f.finish().unwrap();
            let wanted = if read_only { 0.0 } else { expected };
            assert_eq!(depths.read().unwrap()[..texels], [wanted; 8], "{surface:?}, read only: {read_only}");
        }
    }
}

/// A triangle covers all samples of all pixels: what stages read of four samples, and what is left of them, is what one sample shows. Vulkan promises four
/// samples of these formats on each device.
#[test]
fn four_samples_of_one_depth_and_colour_are_resolved_to_it() {
    let gpu = gpu();
    let size = [SIDE, 2];
    let image = |name, format, samples| Image::with_samples(&gpu, name, format, size, samples).unwrap();
    let colours = [1, 4].map(|samples| image("test.colour", Format::Colour, samples));
    let depths = [1, 4].map(|samples| image("test.depth", Format::Depth, samples));
    let resolved = Buffer::<f32>::new(&gpu, "test.resolved", 8, Placement::Storage).unwrap();
    let kept = Buffer::<f32>::new(&gpu, "test.kept", 8, Placement::ReadBack).unwrap();
    let single = Target {
        size,
        colour: Some((colours[0].view(), Format::Colour)),
        item: None,
        depth: depths[0].view(),
        depth_read_only: false,
        strictly_nearer: false,
        samples: None,
    };
    let samples = Samples {
        count: 4,
        colour: Some(colours[1].view()),
        depth: depths[1].view(),
        kept: KeptSample::Farthest,
        resolved: resolved.all().into(),
    };
    let shapes = Shapes { corners: 3, count: 1, surface: Surface::Opaque };
    let run = |target: &Target, resolves: bool| {
        let mut f = gpu.frame();
        f.fill("test/fill", &kept, 0);
        f.clear(target);
        f.draw_shapes(SpinPixels {}, shapes, target);
        f.copy_depth("test/keep_depth", target, &kept);
        let report = if resolves { f.finish() } else { f.finish_unresolved() }.unwrap();
        (report, kept.read().unwrap(), colours[0].read().unwrap())
    };
    let (_, depth, picture) = run(&single, true);
    assert_eq!(depth, [0.5; 8]);
    assert!(picture.iter().any(|byte| *byte > 0));
    // The picture is black again, and stays so unless the colours are resolved.
    let mut f = gpu.frame();
    f.clear(&single);
    f.finish().unwrap();
    let several = Target { samples: Some(samples), ..single };
    let (report, depth, left) = run(&several, false);
    assert_eq!((depth, left), (vec![0.5; 8], vec![0; 32]));
    let steps = [
        "test/fill",
        "target/clear",
        "engine/spin_pixels",
        "engine/resolve_depth",
        "target/keep_resolved_depth",
        "test/keep_depth",
    ];
    assert_rows(&gpu, &report, &steps);
    let (report, depth, resolved) = run(&several, true);
    assert_eq!((depth, resolved), (vec![0.5; 8], picture));
    assert_rows(&gpu, &report, &[&steps[..], &["target/resolve_colour"]].concat());
}

/// Keeps 16 texels of depth in a buffer with room for 15.
fn keep_too_much(gpu: &Gpu) {
    let canvas = Canvas::new(gpu);
    let short = Buffer::<f32>::new(gpu, "test.short", 15, Placement::ReadBack).unwrap();
    gpu.frame().copy_depth("test/keep_depth", &canvas.target, &short);
}

#[test]
#[should_panic(expected = "15 words for 16 texels")]
fn a_picture_is_not_kept_where_there_is_no_room() {
    keep_too_much(&gpu());
}

/// Other formats are copied by a stage, 64 texels a group: the last group too. 1 is far, and is kept as the reversed 0.
#[test]
fn a_picture_of_another_depth_format_is_kept_to_its_last_texel() {
    let _turn = gpu();
    let depth = DepthFormat::StandardD32;
    let gpu = Gpu::open(&GpuOptions { timer: Some(TimerMode::Split), depth, ..options() }).unwrap();
    let image = Image::new(&gpu, "test.depth", Format::Depth, [16, 9]).unwrap();
    let canvas = Canvas::new(&gpu);
    let target = Target { size: [16, 9], depth: image.view(), ..canvas.target.depth_only() };
    let kept = Buffer::with_data(&gpu, "test.kept", &[9.0f32; 145], Placement::ReadBack).unwrap();
    let mut f = gpu.frame();
    f.clear(&target);
    f.copy_depth("test/keep_depth", &target, &kept);
    f.finish().unwrap();
    assert_eq!(kept.read().unwrap(), [[0.0; 144].as_slice(), &[9.0]].concat());
}

/// Other formats are copied by a stage, which would write beyond the buffer.
#[test]
#[should_panic(expected = "15 words for 4x4 texels")]
fn a_picture_of_another_depth_format_is_not_kept_where_there_is_no_room() {
    let _turn = gpu();
    let depth = DepthFormat::StandardD32;
    keep_too_much(&Gpu::open(&GpuOptions { timer: Some(TimerMode::Split), depth, ..options() }).unwrap());
}
