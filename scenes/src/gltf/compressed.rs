//! Compressed geometry (EXT_meshopt_compression, KHR_meshopt_compression, KHR_draco_mesh_compression), decoded before anything else is
//! read. Decoded bytes become buffers and buffer views of the document, so the rest of the import reads and checks them like
//! uncompressed data.

mod draco;
mod meshopt;

use super::buffers::{stored, Bytes};
use super::document::Document;
use super::fault::{Fault, Outcome};
use gltf::json::buffer::{Buffer, View};
use gltf::json::validation::USize64;
use gltf::json::{Index, Root};
use std::borrow::Cow;

/// Bytes that any file may decode to, however small it is.
const LEAST_BUDGET: u64 = 1 << 25;
/// Decoded bytes that a file may have for each byte of its own: about 5 times the ratio of gltfpack and Draco on regular grids.
const BUDGET_FACTOR: u64 = 256;

/// Decodes all compressed geometry.
///
/// # Errors
/// A stream cannot be decoded and has no uncompressed copy, or the file decodes to more than its budget.
pub(super) fn decode<'a>(document: &mut Document, buffers: &mut Vec<Bytes<'a>>) -> Outcome<()> {
    let mut budget = Budget { left: stored(buffers).saturating_mul(BUDGET_FACTOR).max(LEAST_BUDGET) };
    meshopt::decode(document, buffers, &mut budget)?;
    draco::decode(document, buffers, &mut budget)
}

/// The bytes that may still be decoded, or read by a decoder. A few bytes of Draco can stand for any number of equal vertices, so without a bound a small file
/// could ask for all memory.
struct Budget {
    left: u64,
}

impl Budget {
    fn spend(&mut self, bytes: u64) -> Outcome<()> {
        self.left = self.left.checked_sub(bytes).ok_or_else(|| {
            Fault::TooLarge(format!(
                "it decodes to more than {BUDGET_FACTOR} times its size; export it without mesh compression"
            ))
        })?;
        Ok(())
    }
}

/// Adds decoded bytes as a buffer of their own.
fn add_buffer(root: &mut Root, buffers: &mut Vec<Bytes<'_>>, bytes: Vec<u8>) -> Index<Buffer> {
    root.buffers.push(Buffer {
        byte_length: USize64(bytes.len() as u64),
        name: None,
        uri: None,
        extensions: None,
        extras: Default::default(),
    });
    buffers.push(Some(Cow::Owned(bytes)));
    // The file's own list is far shorter than 2^32.
    Index::new(root.buffers.len() as u32 - 1)
}

/// Adds a view of a whole buffer.
fn add_view(root: &mut Root, buffer: Index<Buffer>) -> Index<View> {
    root.buffer_views.push(View {
        buffer,
        byte_length: root.buffers[buffer.value()].byte_length,
        byte_offset: None,
        byte_stride: None,
        name: None,
        target: None,
        extensions: None,
        extras: Default::default(),
    });
    Index::new(root.buffer_views.len() as u32 - 1)
}
