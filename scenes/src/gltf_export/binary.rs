//! The binary chunk of a .glb, with the accessors and views on it.

use crate::model::Aabb;
use glam::Vec3;
use gltf::binary::{Glb, Header};
use serde_json::{json, Value};

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;

/// Data and what describes it. Every element is 4 bytes wide, so all is aligned.
#[derive(Default)]
pub(super) struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Binary {
    /// Vertex positions; glTF wants their bounds, `declared` or their own.
    pub(super) fn positions(&mut self, positions: &[Vec3], declared: Option<Aabb>) -> usize {
        let bounds =
            declared.unwrap_or_else(|| Aabb::from_points(positions.iter().map(|position| position.as_dvec3())));
        let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
        let accessor = self.vectors("VEC3", positions.iter().map(|position| position.to_array()));
        (self.accessors[accessor]["min"], self.accessors[accessor]["max"]) = (json!(min), json!(max));
        accessor
    }

    /// Vectors of floats; returns the accessor.
    pub(super) fn vectors<const SIZE: usize>(
        &mut self,
        kind: &str,
        vectors: impl Iterator<Item = [f32; SIZE]>,
    ) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(vectors.flatten().flat_map(f32::to_le_bytes));
        self.accessor(start, SIZE, FLOAT, kind)
    }

    /// Key times, ascending; glTF wants their bounds.
    pub(super) fn times(&mut self, times: &[f32]) -> usize {
        let accessor = self.vectors("SCALAR", times.iter().map(|&time| [time]));
        let ends = [times.first(), times.last()].map(|end| end.copied().unwrap_or(0.0));
        (self.accessors[accessor]["min"], self.accessors[accessor]["max"]) = (json!([ends[0]]), json!([ends[1]]));
        accessor
    }

    pub(super) fn indices(&mut self, indices: &[u32]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
        self.accessor(start, 1, UNSIGNED_INT, "SCALAR")
    }

    /// Joints, four a vertex, each of 16 bits; returns the accessor.
    pub(super) fn joints(&mut self, joints: impl Iterator<Item = [u32; 4]>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(joints.flatten().flat_map(|joint| (joint as u16).to_le_bytes()));
        // An element is as wide as two floats.
        self.accessor(start, 2, UNSIGNED_SHORT, "VEC4")
    }

    /// A file within the file; returns the view.
    pub(super) fn file(&mut self, bytes: &[u8]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() }));
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn accessor(&mut self, start: usize, size: usize, component: u32, kind: &str) -> usize {
        let length = self.bytes.len() - start;
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length }));
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1,
            "componentType": component,
            "count": length / (4 * size),
            "type": kind,
        }));
        self.accessors.len() - 1
    }

    /// Accessors, views, and the data.
    pub(super) fn into_parts(self) -> (Vec<Value>, Vec<Value>, Vec<u8>) {
        (self.accessors, self.views, self.bytes)
    }
}

/// A .glb of its two chunks; none if it would pass 4 GiB, which the crate would cut off.
pub(super) fn container(json: Vec<u8>, binary: Vec<u8>) -> Option<Vec<u8>> {
    u32::try_from(12 + 8 + json.len().next_multiple_of(4) + 8 + binary.len()).ok()?;
    let binary = (!binary.is_empty()).then(|| binary.into());
    // Its writer fills in the length.
    let header = Header { magic: *b"glTF", version: 2, length: 0 };
    Glb { header, json: json.into(), bin: binary }.to_vec().ok()
}
