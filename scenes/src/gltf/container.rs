//! The binary container (.glb), which the `gltf` crate splits: a header, a chunk of JSON, and at most one chunk of data.

use super::document::gltf_1;
use super::fault::{broken, Fault, Outcome};
use gltf::binary::{ChunkType, Error, Glb};
use std::borrow::Cow;

/// The parts of a .gltf or .glb file.
pub(super) struct Parts<'a> {
    pub json: Cow<'a, [u8]>,
    /// The data chunk of a .glb.
    pub binary: Option<Cow<'a, [u8]>>,
}

/// Splits a file, which is a .glb if it begins like one, whatever its name.
pub(super) fn split(file: &[u8]) -> Outcome<Parts<'_>> {
    if !file.starts_with(b"glTF") {
        // Byte order marks are not allowed, but some editors write them.
        let json = file.strip_prefix(b"\xef\xbb\xbf").unwrap_or(file);
        return Ok(Parts { json: json.into(), binary: None });
    }
    // The crate looks at lengths before versions, takes files that are longer than they say, and panics at less than a header.
    match word(file, 4) {
        Some(1) => return Err(gltf_1("1.0")),
        Some(version) if version != 2 => {
            let remedy = "export the scene as glTF 2.0".into();
            return Err(Fault::Unsupported { what: format!("glb version {version}"), remedy });
        }
        _ => {}
    }
    if let Some(length) = word(file, 8).filter(|&length| length as usize != file.len()) {
        return broken(format!(
            "its header says {length} bytes, but it has {}; was it cut off on the way?",
            file.len()
        ));
    }
    match (Glb::from_slice(file), word(file, 12)) {
        (Ok(glb), _) => Ok(Parts { json: glb.json, binary: glb.bin }),
        // Chunks after the first that are not of data are for extensions, to be ignored; the crate refuses them.
        (Err(gltf::Error::Binary(Error::ChunkType(_) | Error::UnknownChunkType(_))), Some(length))
            if file[16..].starts_with(b"JSON") =>
        {
            Ok(Parts { json: file[20..20 + length as usize].into(), binary: None })
        }
        (Err(gltf::Error::Binary(error)), _) => broken(fault(&error, file.len())),
        (Err(error), _) => broken(error.to_string()),
    }
}

fn word(file: &[u8], at: usize) -> Option<u32> {
    file.get(at..)?.first_chunk().copied().map(u32::from_le_bytes)
}

fn fault(error: &Error, file_length: usize) -> String {
    match error {
        Error::ChunkLength { ty, length, length_read } => {
            let kind = if let ChunkType::Json = ty { "JSON" } else { "data" };
            format!(
                "its chunk of {kind} says {length} bytes, but only {length_read} follow; was it cut off on the way?"
            )
        }
        Error::ChunkType(_) | Error::UnknownChunkType(_) => "its first chunk is not JSON".into(),
        _ => format!("it ends at byte {file_length}, inside a header; was it cut off on the way?"),
    }
}
