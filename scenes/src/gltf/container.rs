//! The binary container (.glb): a header, a chunk of JSON, at most one chunk of data, and chunks for extensions, which are ignored.
//!
//! The `gltf` crate's own reading panics at a length under 12, ignores a file's real length, and refuses chunks for extensions.

use super::document::gltf_1;
use super::fault::{broken, Fault, Outcome};

/// Bytes of the file's header.
const HEADER: usize = 12;
/// Bytes of a chunk's header: its length and its type.
const CHUNK_HEADER: usize = 8;

/// The parts of a .gltf or .glb file.
pub(super) struct Parts<'a> {
    pub json: &'a [u8],
    /// The data chunk of a .glb.
    pub binary: Option<&'a [u8]>,
}

/// Splits a file, which is a .glb if it begins like one, whatever its name.
pub(super) fn split(file: &[u8]) -> Outcome<Parts<'_>> {
    if !file.starts_with(b"glTF") {
        // Byte order marks are not allowed, but some editors write them.
        let json = file.strip_prefix(b"\xef\xbb\xbf").unwrap_or(file);
        return Ok(Parts { json, binary: None });
    }
    match word(file, 4) {
        Some(1) => return Err(gltf_1("1.0")),
        Some(version) if version != 2 => {
            let remedy = "export the scene as glTF 2.0".into();
            return Err(Fault::Unsupported { what: format!("glb version {version}"), remedy });
        }
        _ => {}
    }
    let declared = word(file, 8).map(|length| length as usize);
    let Some(length) = declared.filter(|_| file.len() >= HEADER + CHUNK_HEADER) else {
        return broken(format!("it ends at byte {}, inside a header; was it cut off on the way?", file.len()));
    };
    if length > file.len() {
        return broken(format!(
            "its header says {length} bytes, but it has {}; was it cut off on the way?",
            file.len()
        ));
    }
    if length < file.len() {
        tracing::warn!(
            "the .glb file has {} bytes behind the {length} that its header declares; they are ignored",
            file.len() - length
        );
    }
    let within = Within { bytes: &file[..length], behind: file.len() - length };
    let Some((kind, json, next)) = within.chunk(HEADER)? else {
        return broken(format!("its header says {length} bytes, which hold no chunk; export the scene again"));
    };
    if kind != *b"JSON" {
        return broken("its first chunk is not JSON");
    }
    // The data chunk comes second or not at all; all others are for extensions.
    let second = within.chunk(next)?;
    // Some writers pad the JSON with zeros instead of spaces.
    let json = &json[..json.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1)];
    Ok(Parts { json, binary: second.filter(|(kind, ..)| kind == b"BIN\0").map(|(_, bytes, _)| bytes) })
}

/// A chunk's type, its bytes, and the offset of the next chunk.
type Chunk<'a> = ([u8; 4], &'a [u8], usize);

/// The part of a file that its header declares.
struct Within<'a> {
    bytes: &'a [u8],
    /// Bytes of the file behind that part.
    behind: usize,
}

impl<'a> Within<'a> {
    /// Reads the chunk at an offset; none where fewer bytes are left than a chunk's header has: padding.
    fn chunk(&self, start: usize) -> Outcome<Option<Chunk<'a>>> {
        let left = self.bytes.get(start..).unwrap_or_default();
        let (Some(length), Some(kind)) = (word(left, 0), left.get(4..).and_then(|rest| rest.first_chunk::<4>())) else {
            return Ok(None);
        };
        let length = length as usize;
        let Some(bytes) = left[CHUNK_HEADER..].get(..length) else {
            return self.overrun(*kind, length, left.len() - CHUNK_HEADER);
        };
        let end = start + CHUNK_HEADER + length;
        // A length that is no multiple of 4 is illegal. Such writers either leave the padding out of the length, or write none.
        let is_data = |at: usize| self.bytes.get(at + 4..).is_some_and(|rest| rest.starts_with(b"BIN\0"));
        let padded = end.next_multiple_of(4);
        Ok(Some((*kind, bytes, if !is_data(end) && is_data(padded) { padded } else { end })))
    }

    /// Reports a chunk that is longer than the rest of the file. Chunks for extensions are not needed, so they are ignored.
    fn overrun(&self, kind: [u8; 4], length: usize, left: usize) -> Outcome<Option<Chunk<'a>>> {
        let name = match &kind {
            b"JSON" => "JSON",
            b"BIN\0" => "data",
            _ => return Ok(None),
        };
        let remedy = match self.behind {
            0 => "was it cut off on the way?".into(),
            behind => format!(
                "its header says {} bytes, but the file has {}; export the scene again",
                self.bytes.len(),
                self.bytes.len() + behind
            ),
        };
        broken(format!("its chunk of {name} says {length} bytes, but only {left} follow; {remedy}"))
    }
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().copied().map(u32::from_le_bytes)
}
