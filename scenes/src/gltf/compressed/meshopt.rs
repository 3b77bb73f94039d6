//! EXT_meshopt_compression and KHR_meshopt_compression: buffer views compressed by meshoptimizer, decoded by the `meshoptimizer-rs` crate.
//!
//! The crate's `decode_buffer_view` is not used: it takes version 0 of the vertex codec alone, where KHR_meshopt_compression has
//! version 1, and has no filter for colours.

use super::{add_buffer, Budget};
use crate::gltf::buffers::Bytes;
use crate::gltf::document::Document;
use crate::gltf::fault::{broken, Fault, Outcome};
use gltf::json::buffer::View;
use gltf::json::validation::USize64;
use meshoptimizer_rs::codec::{
    decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat, decode_index_buffer,
    decode_index_sequence, decode_vertex_buffer,
};
use meshoptimizer_rs::{Error, Limits, Workspace};
use serde::Deserialize;
use serde_json::Value;

const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// The extension's object on a buffer view.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Compressed {
    buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    byte_stride: u64,
    count: u64,
    mode: String,
    #[serde(default = "none")]
    filter: String,
}

fn none() -> String {
    "NONE".into()
}

/// Decodes each compressed view into a buffer of its own. A view that cannot be decoded is read from its fallback buffer, if that has
/// data.
pub(super) fn decode(document: &mut Document, buffers: &mut Vec<Bytes<'_>>, budget: &mut Budget) -> Outcome<()> {
    for index in 0..document.root.buffer_views.len() {
        let Some((name, value)) = extension(&document.root.buffer_views[index]) else { continue };
        let decoded = Compressed::deserialize(value)
            .map_err(|error| Fault::Broken(error.to_string()))
            .and_then(|compressed| compressed.decode(buffers, budget))
            .map_err(|fault| fault.within(|| format!("buffer view {index}: {name}")));
        match decoded {
            Ok(bytes) => {
                let length = USize64(bytes.len() as u64);
                let buffer = add_buffer(&mut document.root, buffers, bytes);
                let view = &mut document.root.buffer_views[index];
                (view.buffer, view.byte_offset, view.byte_length) = (buffer, None, length);
            }
            Err(fault @ Fault::Broken(_)) if has_fallback(&document.root.buffer_views[index], buffers) => {
                tracing::warn!("its uncompressed copy is read instead: {}", fault.to_line());
            }
            Err(fault) => return Err(fault),
        }
    }
    Ok(())
}

fn extension(view: &View) -> Option<(&'static str, &Value)> {
    let extensions = &view.extensions.as_ref()?.others;
    let value = NAMES.into_iter().find_map(|name| Some((name, extensions.get(name)?)));
    value.filter(|(_, value)| !value.is_null())
}

/// True if the view's own buffer has its bytes.
fn has_fallback(view: &View, buffers: &[Bytes<'_>]) -> bool {
    let end = view.byte_offset.unwrap_or_default().0.checked_add(view.byte_length.0);
    let bytes = buffers.get(view.buffer.value()).and_then(Option::as_ref);
    end.zip(bytes).is_some_and(|(end, bytes)| end <= bytes.len() as u64)
}

impl Compressed {
    fn decode(&self, buffers: &[Bytes<'_>], budget: &mut Budget) -> Outcome<Vec<u8>> {
        let source = self.source(buffers)?;
        let length = self.count.saturating_mul(self.byte_stride);
        // Many views may read the same bytes. A stream that turns out to be broken has cost the time of reading it.
        budget.spend(length.saturating_add(source.len() as u64))?;
        let (Ok(count), Ok(stride)) = (usize::try_from(self.count), usize::try_from(self.byte_stride)) else {
            return broken("its count and byteStride are beyond this machine");
        };
        if count == 0 {
            return Ok(Vec::new());
        }
        // Work is counted in bytes read and written, and once more for a filter.
        let limits = Limits { max_bytes: length as usize, max_work: 4 * (source.len() as u64 + length) };
        let workspace = &mut Workspace::new(limits);
        let decode = match self.mode.as_str() {
            "ATTRIBUTES" => decode_vertex_buffer,
            "TRIANGLES" => decode_index_buffer,
            "INDICES" => decode_index_sequence,
            other => return broken(format!("its mode '{other}' is none of ATTRIBUTES, TRIANGLES and INDICES")),
        };
        let mut bytes = decode(count, stride, source, workspace).map_err(|error| self.fault(error))?;
        let filter = match self.filter.as_str() {
            "NONE" => return Ok(bytes),
            other if self.mode != "ATTRIBUTES" => return broken(format!("its indices have the filter '{other}'")),
            "OCTAHEDRAL" => decode_filter_oct,
            "QUATERNION" => decode_filter_quat,
            "EXPONENTIAL" => decode_filter_exp,
            "COLOR" => decode_filter_color,
            other => {
                return broken(format!(
                    "its filter '{other}' is none of NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL and COLOR"
                ))
            }
        };
        filter(&mut bytes, count, stride, workspace).map_err(|error| self.fault(error))?;
        Ok(bytes)
    }

    fn source<'a>(&self, buffers: &'a [Bytes<'_>]) -> Outcome<&'a [u8]> {
        let bytes = match buffers.get(self.buffer) {
            Some(Some(bytes)) => bytes,
            Some(None) => return broken(format!("buffer {} has no data", self.buffer)),
            None => return broken(format!("it refers to buffer {}, but the file has {}", self.buffer, buffers.len())),
        };
        let start = usize::try_from(self.byte_offset).ok();
        let end = self.byte_offset.checked_add(self.byte_length).and_then(|end| usize::try_from(end).ok());
        match start.zip(end).and_then(|(start, end)| bytes.get(start..end)) {
            Some(source) => Ok(source),
            None => broken(format!(
                "{} bytes from byte {} do not fit into buffer {} of {} bytes",
                self.byte_length,
                self.byte_offset,
                self.buffer,
                bytes.len()
            )),
        }
    }

    fn fault(&self, error: Error) -> Fault {
        let Compressed { count, byte_stride, mode, .. } = self;
        Fault::Broken(format!(
            "{count} elements of {byte_stride} bytes in mode {mode} cannot be decoded ({error}); compress the file again"
        ))
    }
}
