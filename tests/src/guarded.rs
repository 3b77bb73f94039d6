//! Buffers with a guard word: a stage that writes behind the end of its output is caught.

use engine::{Buffer, Gpu, Placement};

/// The value of words that no stage has written.
pub const UNTOUCHED: u32 = 0xdead_beef;

/// Makes a buffer of `len` words and the guard word behind them. All are [`UNTOUCHED`].
///
/// # Panics
/// If the device has no memory left.
pub fn words(gpu: &Gpu, len: usize) -> Buffer<u32> {
    Buffer::with_data(gpu, "test.words", &vec![UNTOUCHED; len + 1], Placement::Storage).unwrap()
}

/// Reads the words before the guard word.
///
/// # Panics
/// If the guard word was written.
#[track_caller]
pub fn read(buffer: &Buffer<u32>) -> Vec<u32> {
    let mut words = buffer.read().unwrap();
    assert_eq!(words.pop(), Some(UNTOUCHED), "written behind the end");
    words
}
