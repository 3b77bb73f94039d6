//! Typed reading of accessors: any component type, stride and sparse substitution (glTF 2.0, section 3.6.2).
//!
//! Every offset is computed with checks and every count is held against the bytes there are before anything is allocated, so
//! that no file, however broken, makes this panic or ask for more memory than a small multiple of its own size.

use super::buffers::Bytes;
use super::document::{Accessor, Document};
use super::fault::{broken, element, Fault, Outcome};
use crate::model::Aabb;
use glam::DVec3;
use std::cell::Cell;

/// Most elements of an accessor that has no bytes of its own, so that 30 bytes of JSON cannot ask for gigabytes.
const MOST_ZEROS: u64 = 1 << 22;
/// Most elements read in all: bounds the memory of files that read the same bytes over and over.
const MOST_ELEMENTS: u64 = 1 << 31;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn from_number(number: u32) -> Outcome<Self> {
        Ok(match number {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return broken(format!("component type {number} is none of 5120 to 5123, 5125 and 5126")),
        })
    }

    fn bytes(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// The number in the first bytes. `normalized` maps integers to -1..=1 or 0..=1 (section 3.6.2.2).
    fn number(self, bytes: &[u8], normalized: bool) -> f32 {
        let one = |value: f32, largest: f32| if normalized { (value / largest).max(-1.0) } else { value };
        match (self, bytes) {
            (Component::I8, &[a, ..]) => one(f32::from(a as i8), 127.0),
            (Component::U8, &[a, ..]) => one(f32::from(a), 255.0),
            (Component::I16, &[a, b, ..]) => one(f32::from(i16::from_le_bytes([a, b])), 32767.0),
            (Component::U16, &[a, b, ..]) => one(f32::from(u16::from_le_bytes([a, b])), 65535.0),
            (Component::F32, &[a, b, c, d, ..]) => f32::from_le_bytes([a, b, c, d]),
            (Component::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]) as f32,
            _ => 0.0,
        }
    }

    /// The index in the first bytes.
    fn index(self, bytes: &[u8]) -> u32 {
        match (self, bytes) {
            (Component::U8, &[a, ..]) => u32::from(a),
            (Component::U16, &[a, b, ..]) => u32::from(u16::from_le_bytes([a, b])),
            (Component::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
            _ => 0,
        }
    }
}

/// Which component types an attribute may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Allowed {
    /// `f32` alone.
    Floats,
    /// `f32`, and 8 and 16 bit integers, normalised or plain: quantised attributes.
    Quantized,
    /// `f32` and normalised 8 and 16 bit integers.
    Normalized,
}

/// The accessors of a file and the bytes they look at.
pub(super) struct Accessors<'a> {
    document: &'a Document,
    buffers: &'a [Bytes<'a>],
    elements_left: Cell<u64>,
}

impl<'a> Accessors<'a> {
    pub(super) fn new(document: &'a Document, buffers: &'a [Bytes<'a>]) -> Self {
        Accessors { document, buffers, elements_left: Cell::new(MOST_ELEMENTS) }
    }

    /// How many elements it has, according to the JSON.
    pub(super) fn count(&self, index: usize) -> Outcome<u64> {
        Ok(element(&self.document.accessors, index, "accessor")?.count)
    }

    /// True if there are neither bytes nor sparse values: it holds zeros only.
    pub(super) fn is_all_zeros(&self, index: usize) -> Outcome<bool> {
        let accessor = element(&self.document.accessors, index, "accessor")?;
        Ok(accessor.buffer_view.is_none() && accessor.sparse.is_none())
    }

    /// Reads vectors of `N` numbers; `N` is 1 for SCALAR, 3 for VEC3, 4 for VEC4.
    pub(super) fn vectors<const N: usize>(&self, index: usize, allowed: Allowed) -> Outcome<Vec<[f32; N]>> {
        let accessor = element(&self.document.accessors, index, "accessor")?;
        let read = || {
            let component = Component::from_number(accessor.component_type)?;
            let fits = match (component, allowed) {
                (Component::F32, _) => true,
                (Component::U32, _) | (_, Allowed::Floats) => false,
                (_, Allowed::Quantized) => true,
                (_, Allowed::Normalized) => accessor.normalized,
            };
            if !fits {
                return broken(format!("component type {} is not allowed here", accessor.component_type));
            }
            let wanted = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
            self.elements(accessor, component, wanted, N, |bytes| {
                std::array::from_fn(|axis| {
                    component.number(bytes.get(axis * component.bytes()..).unwrap_or(&[]), accessor.normalized)
                })
            })
        };
        read().map_err(|fault| fault.within(|| format!("accessor {index}")))
    }

    /// The `min` and `max` that the JSON declares for vectors of three floats, rounded to the floats they stand for; none if
    /// there are none, or of integers, whose bounds are not in the vectors' own unit.
    pub(super) fn declared_box(&self, index: usize) -> Outcome<Option<Aabb>> {
        let accessor = element(&self.document.accessors, index, "accessor")?;
        if accessor.normalized || Component::from_number(accessor.component_type)? != Component::F32 {
            return Ok(None);
        }
        let corner = |value: &serde_json::Value| -> Option<DVec3> {
            let parts: Vec<f64> = value.as_array()?.iter().filter_map(serde_json::Value::as_f64).collect();
            // Decimal digits are cut off by many writers: no vertex lies between a float and its digits.
            Some(DVec3::from_array(parts.try_into().ok()?).as_vec3().as_dvec3())
        };
        Ok(corner(&accessor.min).zip(corner(&accessor.max)).map(|(min, max)| Aabb { min, max }))
    }

    /// Reads unsigned integers.
    pub(super) fn indices(&self, index: usize) -> Outcome<Vec<u32>> {
        let accessor = element(&self.document.accessors, index, "accessor")?;
        let read = || {
            let component = unsigned(accessor.component_type)?;
            self.elements(accessor, component, "SCALAR", 1, |bytes| component.index(bytes))
        };
        read().map_err(|fault| fault.within(|| format!("accessor {index}")))
    }

    fn elements<T: Copy>(
        &self,
        accessor: &Accessor,
        component: Component,
        wanted: &str,
        width: usize,
        decode: impl Fn(&[u8]) -> T,
    ) -> Outcome<Vec<T>> {
        if accessor.kind != wanted {
            return broken(format!("its type is '{}', but {wanted} is needed here", accessor.kind));
        }
        let left = self.elements_left.get().checked_sub(accessor.count);
        self.elements_left
            .set(left.ok_or_else(|| Fault::TooLarge(format!("more than {MOST_ELEMENTS} elements in all")))?);
        let size = width * component.bytes();
        let mut elements: Vec<T> = match accessor.buffer_view {
            Some(view) => self.slices(view, accessor.byte_offset, accessor.count, size, true)?.map(&decode).collect(),
            None if accessor.count > MOST_ZEROS => {
                return Err(Fault::TooLarge(format!(
                    "{} elements without data; the limit is {MOST_ZEROS}",
                    accessor.count
                )));
            }
            None => vec![decode(&[0; 16]); accessor.count as usize],
        };
        if let Some(sparse) = &accessor.sparse {
            let positions = unsigned(sparse.indices.component_type)?;
            let at = self.slices(
                sparse.indices.buffer_view,
                sparse.indices.byte_offset,
                sparse.count,
                positions.bytes(),
                false,
            )?;
            let values =
                self.slices(sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, size, false)?;
            for (at, value) in at.zip(values) {
                let at = positions.index(at);
                let Some(element) = elements.get_mut(at as usize) else {
                    return broken(format!("a sparse value is for element {at} of {}", accessor.count));
                };
                *element = decode(value);
            }
        }
        Ok(elements)
    }

    /// The bytes of each of `count` elements of `size` bytes in a buffer view.
    fn slices(
        &self,
        view: usize,
        offset: u64,
        count: u64,
        size: usize,
        strided: bool,
    ) -> Outcome<impl Iterator<Item = &'a [u8]>> {
        let bytes = self.view(view).map_err(|fault| fault.within(|| format!("buffer view {view}")))?;
        let stride = self.document.buffer_views[view].byte_stride.filter(|_| strided);
        let stride = stride.unwrap_or(size as u64);
        if stride < size as u64 {
            return broken(format!("buffer view {view} has a stride of {stride} bytes, less than an element's {size}"));
        }
        // Bytes from the first element's start to the last one's end.
        let span = match count {
            0 => Some(0),
            _ => (count - 1).checked_mul(stride).and_then(|last| last.checked_add(size as u64)),
        };
        let end = span.and_then(|span| span.checked_add(offset)).filter(|&end| end <= bytes.len() as u64);
        let Some(end) = end else {
            return broken(format!(
                "{count} elements, {stride} bytes apart from byte {offset}, do not fit into buffer view {view} of {} bytes",
                bytes.len()
            ));
        };
        // Offset and stride are now known to be within memory.
        let bytes = if count == 0 { &bytes[..0] } else { &bytes[offset as usize..end as usize] };
        Ok(bytes.chunks(stride as usize).map(move |chunk| &chunk[..size]))
    }

    fn view(&self, index: usize) -> Outcome<&'a [u8]> {
        let view = element(&self.document.buffer_views, index, "buffer view")?;
        let Some(bytes) = element(self.buffers, view.buffer, "buffer")? else {
            return broken(format!("buffer {} has no data", view.buffer));
        };
        let range = view
            .byte_offset
            .checked_add(view.byte_length)
            .and_then(|end| bytes.get(usize::try_from(view.byte_offset).ok()?..usize::try_from(end).ok()?));
        match range {
            Some(bytes) => Ok(bytes),
            None => broken(format!(
                "{} bytes from byte {} do not fit into buffer {} of {} bytes",
                view.byte_length,
                view.byte_offset,
                view.buffer,
                bytes.len()
            )),
        }
    }
}

fn unsigned(number: u32) -> Outcome<Component> {
    match Component::from_number(number)? {
        component @ (Component::U8 | Component::U16 | Component::U32) => Ok(component),
        _ => broken(format!("indices of component type {number}; they must be unsigned (5121, 5123 or 5125)")),
    }
}
