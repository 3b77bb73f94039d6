//! URIs of data (RFC 3986 and 2397), parsed before they are decoded: an escaped `:` is part of a name and starts no scheme.

use super::fault::{broken, one_line, Fault, Outcome};
use base64::alphabet::{STANDARD, URL_SAFE};
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{DecodeError, Engine};
use std::path::{Path, PathBuf};

/// The place of a URI's bytes.
pub(super) enum Place {
    /// Within the URI.
    Data(Vec<u8>),
    /// In a file. These are the relative paths that the URI may mean, the likeliest first: exporters escape differently.
    File(Vec<PathBuf>),
}

/// Finds the bytes of a URI. Decodes `data:` URIs.
pub(super) fn place(uri: &str) -> Outcome<Place> {
    let uri = uri.trim_matches(|letter: char| letter.is_ascii_whitespace());
    match scheme(uri) {
        Some((scheme, rest)) if scheme.eq_ignore_ascii_case("data") => decode_data(rest).map(Place::Data),
        // A letter, a colon and a slash are a Windows drive.
        Some((scheme, rest)) if !(scheme.len() == 1 && rest.starts_with(['/', '\\'])) => Err(elsewhere(uri)),
        _ if uri.starts_with("//") => Err(elsewhere(uri)),
        _ => relative(uri).map(Place::File),
    }
}

/// Splits a URI at the colon of its scheme.
fn scheme(uri: &str) -> Option<(&str, &str)> {
    let (scheme, rest) = uri.split_once(':')?;
    let is_scheme = scheme.starts_with(|letter: char| letter.is_ascii_alphabetic())
        && scheme.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte));
    is_scheme.then_some((scheme, rest))
}

fn elsewhere(uri: &str) -> Fault {
    let remedy = match uri.contains("//") {
        true => "download the file, put it beside the scene and refer to it by its name",
        false => "put the file beside the scene and refer to it by its name, in which ':' is written %3A",
    };
    Fault::Unsupported { what: format!("data at '{}'", one_line(uri, 200)), remedy: remedy.into() }
}

/// The paths that a relative reference may mean.
fn relative(uri: &str) -> Outcome<Vec<PathBuf>> {
    // A query and a fragment are not part of a file's name, unless an exporter left the name unescaped.
    let path = uri.split(['?', '#']).next().unwrap_or(uri);
    let mut readings = vec![decoded(path), decoded(uri)];
    if uri.contains('\\') {
        readings.push(decoded(&path.replace('\\', "/")));
    }
    readings.push(uri.into());
    let mut paths: Vec<PathBuf> = Vec::new();
    for path in readings {
        let shown = path.to_string_lossy();
        let drive = shown.as_bytes().get(1) == Some(&b':') && matches!(shown.as_bytes().get(2), Some(b'/' | b'\\'));
        if path.is_absolute() || drive || shown.starts_with('\\') {
            return broken(format!(
                "its data '{}' is not given relative to the scene; put the file beside the scene and refer to it by its name alone",
                one_line(uri, 200)
            ));
        }
        if !path.as_os_str().is_empty() && !paths.contains(&path) {
            paths.push(path);
        }
    }
    match paths.is_empty() {
        true => broken("its URI is empty; give it the name of a file beside the scene"),
        false => Ok(paths),
    }
}

/// Decodes the escapes of a path; each is one byte of a file's name. An escaped `/` separates folders, as many exporters escape whole
/// paths.
#[cfg(unix)]
fn decoded(path: &str) -> PathBuf {
    use std::os::unix::ffi::OsStringExt;
    std::ffi::OsString::from_vec(percent_decoded(path)).into()
}

/// Decodes the escapes of a path. Names have to be UTF-8 here.
#[cfg(not(unix))]
fn decoded(path: &str) -> PathBuf {
    String::from_utf8_lossy(&percent_decoded(path)).into_owned().into()
}

/// The name of a path for messages.
pub(super) fn shown(path: &Path) -> String {
    one_line(&path.to_string_lossy(), 200)
}

/// A data URI without its `data:`.
fn decode_data(data: &str) -> Outcome<Vec<u8>> {
    let Some((kind, text)) = data.split_once(',') else {
        return broken("its data URI has no comma before the data");
    };
    let text = percent_decoded(text.split('#').next().unwrap_or(text));
    let last = kind.rsplit(';').next().filter(|last| last.len() < kind.len());
    if last.is_some_and(|last| last.trim().eq_ignore_ascii_case("base64")) {
        decode_base64(&text)
    } else {
        Ok(text)
    }
}

/// Decodes base64 of either alphabet, padded or not. White space is skipped: some exporters break lines.
fn decode_base64(text: &[u8]) -> Outcome<Vec<u8>> {
    let lenient = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    let text: Vec<u8> = text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let alphabet = if text.iter().any(|letter| b"-_".contains(letter)) { URL_SAFE } else { STANDARD };
    GeneralPurpose::new(&alphabet, lenient).decode(text).or_else(|error| match error {
        DecodeError::InvalidByte(at, _) => broken(format!("its base64 data has an illegal character at {at}")),
        other => broken(format!("its base64 data is illegal: {other}")),
    })
}

fn percent_decoded(text: &str) -> Vec<u8> {
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
