//! The binary container (.glb): a header, a chunk of JSON, and at most one chunk of data (glTF 2.0, section 4).

use super::document::gltf_1;
use super::fault::{broken, Fault, Outcome};

const MAGIC: &[u8] = b"glTF";
const JSON: &[u8] = b"JSON";
const BINARY: &[u8] = b"BIN\0";

/// The parts of a .gltf or .glb file.
pub(super) struct Parts<'a> {
    pub json: &'a [u8],
    /// The data chunk of a .glb.
    pub binary: Option<&'a [u8]>,
}

/// Splits a file, which is a .glb if it begins like one, whatever its name.
pub(super) fn split(file: &[u8]) -> Outcome<Parts<'_>> {
    if !file.starts_with(MAGIC) {
        // Byte order marks are not allowed, but some editors write them.
        let json = file.strip_prefix(b"\xef\xbb\xbf").unwrap_or(file);
        return Ok(Parts { json, binary: None });
    }
    let version = word(file, 4)?;
    if version != 2 {
        return Err(if version == 1 {
            gltf_1("1.0")
        } else {
            Fault::Unsupported { what: format!("glb version {version}"), remedy: "export the scene as glTF 2.0".into() }
        });
    }
    let length = word(file, 8)?;
    if length as usize != file.len() {
        return broken(format!(
            "its header says {length} bytes, but it has {}; was it cut off on the way?",
            file.len()
        ));
    }
    let (kind, json, rest) = chunk(file, 12)?;
    if kind != JSON {
        return broken("its first chunk is not JSON");
    }
    // Chunks after the first two, or of unknown kinds, are for extensions: to be ignored.
    let binary = if rest == file.len() { None } else { Some(chunk(file, rest)?) };
    Ok(Parts { json, binary: binary.filter(|(kind, ..)| *kind == BINARY).map(|(_, data, _)| data) })
}

/// Kind and contents of the chunk at `start`, and where the next one starts.
fn chunk(file: &[u8], start: usize) -> Outcome<(&[u8], &[u8], usize)> {
    let length = word(file, start)? as usize;
    word(file, start + 4)?;
    let data = start + 8;
    match file[data..].get(..length) {
        Some(contents) => Ok((&file[start + 4..data], contents, data + length)),
        None => broken(format!("the chunk at byte {start} says {length} bytes, but only {} follow", file.len() - data)),
    }
}

fn word(file: &[u8], at: usize) -> Outcome<u32> {
    match file.get(at..).and_then(|rest| rest.first_chunk()) {
        Some(bytes) => Ok(u32::from_le_bytes(*bytes)),
        None => broken(format!("it ends at byte {}, inside a header; was it cut off on the way?", file.len())),
    }
}
