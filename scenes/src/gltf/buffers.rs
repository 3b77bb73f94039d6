//! The bytes behind each buffer: the data chunk, a file beside the scene, or base64 within it.
//!
//! Not the `gltf` crate's reading of them, which does not name the file that is missing, opens files anywhere on the machine, devices
//! and pipes too, and panics at names that are not UTF-8.

use super::fault::{broken, Fault, Outcome};
use base64::alphabet::{STANDARD, URL_SAFE};
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{DecodeError, Engine};
use gltf::json::{Buffer, Root};
use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The contents of one buffer, exactly as long as the file says; none where only an extension knows them.
pub(super) type Bytes<'a> = Option<Cow<'a, [u8]>>;

/// Loads all buffers of the document. Files are looked for in `folder`.
pub(super) fn load<'a>(root: &Root, binary: Option<&'a [u8]>, folder: &Path) -> Outcome<Vec<Bytes<'a>>> {
    let load = |index: usize, buffer: &Buffer| {
        let length = buffer.byte_length.0;
        let bytes = match &buffer.uri {
            Some(uri) => Some(Cow::Owned(fetch(uri, length, folder)?)),
            None => binary.filter(|_| index == 0).map(Cow::Borrowed),
        };
        exactly(bytes, length)
    };
    let buffers = root.buffers.iter().enumerate();
    buffers
        .map(|(index, buffer)| load(index, buffer).map_err(|fault| fault.within(|| format!("buffer {index}"))))
        .collect()
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
    if let Some(data) = uri.strip_prefix("data:") {
        return decode_data(data);
    }
    let name = percent_decoded(uri)?;
    let scheme = name.split_once(':').map(|(scheme, _)| scheme);
    if scheme.is_some_and(|scheme| {
        scheme.len() > 1 && scheme.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte))
    }) {
        let remedy = "download the file, put it beside the scene and refer to it by its name".into();
        return Err(Fault::Unsupported { what: format!("data at '{name}'"), remedy });
    }
    if Path::new(&name).is_absolute() {
        return broken(format!("its data '{name}' is not given relative to the scene; refer to it by its name alone"));
    }
    read_file(&folder.join(&name), length).map_err(|error| {
        Fault::Broken(format!(
            "its data file '{name}' cannot be read ({error}); put it in the folder '{}'",
            shown(folder)
        ))
    })
}

fn shown(folder: &Path) -> String {
    if folder.as_os_str().is_empty() {
        ".".into()
    } else {
        folder.display().to_string()
    }
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

/// A data URI without its "data:".
fn decode_data(data: &str) -> Outcome<Vec<u8>> {
    match data.split_once(',') {
        Some((kind, text)) if kind.ends_with(";base64") => decode_base64(text.as_bytes()),
        Some((_, text)) => Ok(percent_decoded_bytes(text)),
        None => broken("its data URI has no comma before the data"),
    }
}

/// Of either alphabet, padded or not.
fn decode_base64(text: &[u8]) -> Outcome<Vec<u8>> {
    let lenient = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    let alphabet = if text.iter().any(|letter| b"-_".contains(letter)) { URL_SAFE } else { STANDARD };
    GeneralPurpose::new(&alphabet, lenient).decode(text).or_else(|error| match error {
        DecodeError::InvalidByte(at, _) => broken(format!("its base64 data has an illegal character at {at}")),
        other => broken(format!("its base64 data is illegal: {other}")),
    })
}

fn percent_decoded(text: &str) -> Outcome<String> {
    let bytes = percent_decoded_bytes(text);
    String::from_utf8(bytes).or_else(|_| broken(format!("its URI '{text}' is not UTF-8")))
}

fn percent_decoded_bytes(text: &str) -> Vec<u8> {
    let digit = |byte: Option<&u8>| byte.and_then(|&byte| char::from(byte).to_digit(16));
    let text = text.as_bytes();
    let mut bytes = Vec::with_capacity(text.len());
    let mut at = 0;
    while at < text.len() {
        match (text[at], digit(text.get(at + 1)), digit(text.get(at + 2))) {
            (b'%', Some(high), Some(low)) => {
                bytes.push((high * 16 + low) as u8);
                at += 3;
            }
            (byte, ..) => {
                bytes.push(byte);
                at += 1;
            }
        }
    }
    bytes
}
