//! The bytes behind each buffer: the data chunk, a file beside the scene, or base64 within it.
//!
//! Not the `gltf` crate's reading of them, which does not name the file that is missing, opens files anywhere on the machine, devices
//! and pipes too, and panics at names that are not UTF-8.

use super::fault::{broken, Fault, Outcome};
use super::uri::{self, Place};
use gltf::json::{Buffer, Root};
use std::borrow::Cow;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// The contents of one buffer, exactly as long as the file says; none where only an extension knows them.
pub(super) type Bytes<'a> = Option<Cow<'a, [u8]>>;

/// Loads all buffers of the document. Files are looked for in `folder`.
pub(super) fn load<'a>(root: &Root, binary: Option<&'a [u8]>, folder: &Path) -> Outcome<Vec<Bytes<'a>>> {
    let load = |index: usize, buffer: &Buffer| {
        let length = buffer.byte_length.0;
        match &buffer.uri {
            // The buffer is for readers that cannot decompress. Its file may be missing.
            Some(uri) if is_fallback(buffer) => Ok(fetch(uri, length, folder).ok().map(Cow::Owned)),
            None if is_fallback(buffer) => Ok(None),
            Some(uri) => exactly(Some(Cow::Owned(fetch(uri, length, folder)?)), length),
            None => exactly(binary.filter(|_| index == 0).map(Cow::Borrowed), length),
        }
    };
    let buffers = root.buffers.iter().enumerate();
    buffers
        .map(|(index, buffer)| load(index, buffer).map_err(|fault| fault.within(|| format!("buffer {index}"))))
        .collect()
}

/// Counts the bytes of all buffers.
pub(super) fn stored(buffers: &[Bytes<'_>]) -> u64 {
    buffers.iter().flatten().map(|bytes| bytes.len() as u64).sum()
}

/// True if the buffer is only a placeholder for compressed data (EXT_meshopt_compression).
fn is_fallback(buffer: &Buffer) -> bool {
    let extensions = buffer.extensions.as_ref().map(|extensions| &extensions.others);
    ["EXT_meshopt_compression", "KHR_meshopt_compression"]
        .iter()
        .filter_map(|name| extensions?.get(*name)?.get("fallback"))
        .any(|fallback| fallback == true)
}

/// Cuts off the padding that a data chunk or file may have.
fn exactly(bytes: Bytes<'_>, length: u64) -> Outcome<Bytes<'_>> {
    let Some(bytes) = bytes else { return Ok(None) };
    let Some(length) = usize::try_from(length).ok().filter(|&length| length <= bytes.len()) else {
        return broken(format!(
            "it should have {length} bytes, but there are {}; was it cut off on the way?",
            bytes.len()
        ));
    };
    Ok(Some(match bytes {
        Cow::Borrowed(bytes) => Cow::Borrowed(&bytes[..length]),
        Cow::Owned(mut bytes) => {
            bytes.truncate(length);
            Cow::Owned(bytes)
        }
    }))
}

/// The bytes that a URI stands for, at most `length` of a file.
pub(super) fn fetch(uri: &str, length: u64, folder: &Path) -> Outcome<Vec<u8>> {
    let paths = match uri::place(uri)? {
        Place::Data(bytes) => return Ok(bytes),
        Place::File(paths) => paths,
    };
    let mut errors = Vec::new();
    for path in &paths {
        match read_file(&folder.join(path), length) {
            Ok(bytes) => return Ok(bytes),
            Err(error) => errors.push((path, error)),
        }
    }
    // An existing file that cannot be read explains more than missing files. There is at least one path, so there is an error.
    let told = errors.iter().find(|(_, error)| error.kind() != ErrorKind::NotFound).or(errors.first());
    let (path, error) = told.map_or_else(Default::default, |(path, error)| (uri::shown(path), error.to_string()));
    Err(Fault::Broken(format!(
        "its data file '{path}' cannot be read ({error}); put it in the folder '{}'",
        if folder.as_os_str().is_empty() { ".".into() } else { uri::shown(folder) }
    )))
}

/// At most `length` bytes of a plain file: a device or pipe of that name could be endless.
fn read_file(path: &Path, length: u64) -> std::io::Result<Vec<u8>> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a plain file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}
