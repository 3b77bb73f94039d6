//! Parts of buffers: what a step does to a range, and what it leaves alone.

use engine::{Buffer, Extra, Frame, Gpu, GpuOptions, Placement, TimerMode};
use harness::{gpu, options};
use shaders::engine::SpinWords;
use shaders::BufferRef;

fn words(gpu: &Gpu, data: &[u32]) -> Buffer<u32> {
    Buffer::with_data(gpu, "test.words", data, Placement::Storage).unwrap()
}

/// Words from `first` on, so many.
fn part(buffer: &Buffer<u32>, first: usize, count: u64) -> BufferRef<u32> {
    BufferRef { size: 4 * count, ..buffer.all().from(first) }
}

/// A frame in which the derived barriers alone order its steps: on a CPU a full barrier stands beside each timestamp. Synchronization validation
/// fails the frame where one is missing.
fn untimed(gpu: &Gpu) -> Frame {
    let mut f = gpu.frame();
    f.without_stage_times();
    f
}

#[test]
fn fills_and_copies_touch_their_ranges_alone() {
    let gpu = gpu();
    let (from, to) = (words(&gpu, &[10, 11, 12, 13, 14, 15, 16, 17]), words(&gpu, &[0; 8]));
    let mut f = untimed(&gpu);
    f.fill("test/fill", part(&to, 1, 5), 9);
    // It overlaps what was filled by a word.
    f.copy("test/copy", part(&from, 2, 3), part(&to, 5, 3));
    f.fill("test/fill", part(&from, 7, 1), 8);
    f.finish().unwrap();
    assert_eq!(to.read().unwrap(), [0, 9, 9, 9, 9, 12, 13, 14]);
    assert_eq!(from.read().unwrap(), [10, 11, 12, 13, 14, 15, 16, 8]);
}

/// A copy of a whole buffer is as long as its source: the end of a longer destination stays.
#[test]
fn a_copy_is_as_long_as_its_source() {
    let gpu = gpu();
    let (from, to) = (words(&gpu, &[1, 2, 3]), words(&gpu, &[7; 5]));
    let mut f = gpu.frame();
    f.copy("test/copy", from.all(), to.all());
    f.finish().unwrap();
    assert_eq!(to.read().unwrap(), [1, 2, 3, 7, 7]);
}

/// No stage of a method binds a part of a buffer. One that does works on that part, where it begins at a multiple that the device allows: 256 bytes is
/// the most that Vulkan lets a device ask for. Two parts are cut from each other as the buffer is (`ranges_of_one_buffer_are_cut_as_the_whole_buffer_is`).
#[test]
fn a_stage_works_on_the_part_that_it_binds() {
    let spun = super::frames::spun;
    let _turn = gpu();
    for without in [None, Some(Extra::PushDescriptor)] {
        let mut options = GpuOptions { timer: Some(TimerMode::Split), ..options() };
        options.without.extend(without.map(|extra| extra.name().to_owned()));
        let gpu = Gpu::open(&options).unwrap();
        let buffer = words(&gpu, &[5; 192]);
        let spin = |words| SpinWords { words, word_count: 64 };
        let mut f = untimed(&gpu);
        f.dispatch(spin(part(&buffer, 64, 64)), 64);
        f.dispatch(spin(part(&buffer, 64, 64)), 64);
        f.dispatch(spin(part(&buffer, 128, 64)), 64);
        f.finish().unwrap();
        let expected = [[5; 64], [spun(spun(5)); 64], [spun(5); 64]].concat();
        assert_eq!(buffer.read().unwrap(), expected, "without {without:?}");
        assert_eq!(gpu.take_messages(), []);
    }
}

#[test]
fn a_grid_of_pixels_covers_them_and_an_empty_one_is_a_skip() {
    let gpu = gpu();
    // A group is 64 words wide: 65 texels a row take two.
    let buffer = words(&gpu, &[5; 129]);
    let spin = SpinWords { words: buffer.all(), word_count: 129 };
    let mut f = gpu.frame();
    f.dispatch_over(spin, [65, 1]);
    f.dispatch_over(spin, [65, 0]);
    f.dispatch_over(spin, [0, 65]);
    f.dispatch_groups(spin, 0);
    let report = f.finish().unwrap();
    assert_eq!(buffer.read().unwrap(), [[super::frames::spun(5); 128].as_slice(), &[5]].concat());
    let skipped: Vec<_> = report.skips.iter().map(|skip| (skip.label.as_str(), skip.reason)).collect();
    assert_eq!(skipped, [("engine/spin_words", "nothing to do"); 3]);
    assert_eq!(report.stages.len(), if gpu.has(Extra::Timestamps) { 1 } else { 0 });
}

/// Writes of the host are counted where they are submissions of their own, and in the frame in which they were made.
#[test]
fn a_frame_counts_the_uploads_that_were_waited_for_while_it_was_recorded() {
    let _turn = gpu();
    let name = Extra::MappedMemory.name().to_owned();
    let gpu = Gpu::open(&GpuOptions { timer: Some(TimerMode::Split), without: vec![name], ..options() }).unwrap();
    let mut buffer = words(&gpu, &[1; 4]);
    for uploads in [2, 0, 1] {
        let mut f = gpu.frame();
        f.fill("test/fill", &buffer, 3);
        for _ in 0..uploads {
            buffer.write(&[2; 4]).unwrap();
        }
        assert_eq!(f.finish().unwrap().uploads, uploads);
    }
}
