//! Typed reading of accessors: the `gltf` crate decodes elements of any component type and stride; here are the checks it leaves out,
//! sparse substitution, and the numbers that quantised vectors stand for (glTF 2.0, section 3.6.2).
//!
//! Every offset is computed with checks and every count is held against the bytes there are before anything is allocated, so
//! that no file, however broken, makes this panic or ask for more memory than a small multiple of its own size. The crate's own
//! `accessor::Iter` overflows at wrong offsets, counts from 0 - 1, and drops sparse values that are out of order.

use super::buffers::Bytes;
use super::document::Document;
use super::fault::{broken, element, Fault, Outcome};
use crate::model::Aabb;
use glam::DVec3;
use gltf::accessor::util::{Item, ItemIter, SparseIndicesIter};
use gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf::json::buffer::View;
use gltf::json::validation::Checked::Valid;
use gltf::json::validation::USize64;
use gltf::json::Index;
use std::cell::Cell;

/// Most elements of an accessor that has no bytes of its own, so that 30 bytes of JSON cannot ask for gigabytes.
const MOST_ZEROS: u64 = 1 << 22;
/// Elements that any file may read in all, however small it is. A deformed mesh is read once for each of its nodes, so legal files read the
/// same bytes many times.
const LEAST_ELEMENTS: u64 = 1 << 26;
/// Elements that a file may read for each byte of its own. A compressed file decodes to 50 bytes for each of its bytes at most, and an
/// element has 1 to 64 bytes.
const ELEMENTS_A_BYTE: u64 = 64;
/// Most elements of any file. Bounds the time and the memory of an import.
const MOST_ELEMENTS: u64 = 1 << 31;

/// A vector of any size, where the crate has single numbers and arrays of 2, 3 and 4.
struct Vector<C, const N: usize>([C; N]);

impl<C: Item, const N: usize> Item for Vector<C, N> {
    fn from_slice(bytes: &[u8]) -> Self {
        Vector(std::array::from_fn(|axis| C::from_slice(&bytes[axis * size_of::<C>()..])))
    }
    fn zero() -> Self {
        Vector(std::array::from_fn(|_| C::zero()))
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
    document: &'a Document<'a>,
    buffers: &'a [Bytes<'a>],
    most_elements: u64,
    elements_left: Cell<u64>,
}

impl<'a> Accessors<'a> {
    /// Takes the buffers after decompression. `size` is the number of bytes of the file and its data files, as they are stored.
    pub(super) fn new(document: &'a Document, buffers: &'a [Bytes<'a>], size: u64) -> Self {
        let most_elements = size.saturating_mul(ELEMENTS_A_BYTE).saturating_add(LEAST_ELEMENTS).min(MOST_ELEMENTS);
        Accessors { document, buffers, most_elements, elements_left: Cell::new(most_elements) }
    }

    fn get(&self, index: Index<Accessor>) -> Outcome<&'a Accessor> {
        element(&self.document.root, index, "accessor")
    }

    /// How many elements it has, according to the JSON.
    pub(super) fn count(&self, index: Index<Accessor>) -> Outcome<u64> {
        Ok(self.get(index)?.count.0)
    }

    /// True if there are neither bytes nor sparse values: it holds zeros only.
    pub(super) fn is_all_zeros(&self, index: Index<Accessor>) -> Outcome<bool> {
        let accessor = self.get(index)?;
        Ok(accessor.buffer_view.is_none() && accessor.sparse.is_none())
    }

    /// Reads vectors of `N` numbers; `N` is 1 for SCALAR, 2 for VEC2, 3 for VEC3, 4 for VEC4.
    pub(super) fn vectors<const N: usize>(&self, index: Index<Accessor>, allowed: Allowed) -> Outcome<Vec<[f32; N]>> {
        let read = || {
            let component = self.component(index)?;
            let fits = match allowed {
                Allowed::Floats => component == ComponentType::F32,
                Allowed::Normalized => component == ComponentType::F32 || self.get(index)?.normalized,
                Allowed::Quantized => true,
            };
            match component {
                ComponentType::F32 => self.numbers::<f32, N>(index, None),
                ComponentType::I8 if fits => self.numbers::<i8, N>(index, Some(127.0)),
                ComponentType::U8 if fits => self.numbers::<u8, N>(index, Some(255.0)),
                ComponentType::I16 if fits => self.numbers::<i16, N>(index, Some(32767.0)),
                ComponentType::U16 if fits => self.numbers::<u16, N>(index, Some(65535.0)),
                other => broken(format!("component type {} is not allowed here", other.as_gl_enum())),
            }
        };
        read().map_err(|fault| fault.within(|| format!("accessor {index}")))
    }

    /// Integers that are normalised stand for -1..=1 or 0..=1, `largest` for 1 (section 3.6.2.2).
    fn numbers<C: Item + Copy + Into<f32>, const N: usize>(
        &self,
        index: Index<Accessor>,
        largest: Option<f32>,
    ) -> Outcome<Vec<[f32; N]>> {
        let wanted = [Type::Scalar, Type::Vec2, Type::Vec3, Type::Vec4][N - 1];
        let largest = largest.filter(|_| self.get(index).is_ok_and(|accessor| accessor.normalized));
        let number = |component: C| match largest {
            Some(largest) => (component.into() / largest).max(-1.0),
            None => component.into(),
        };
        self.elements(index, wanted, |Vector(components): Vector<C, N>| components.map(number))
    }

    /// Reads matrices of four columns and rows, column by column.
    pub(super) fn matrices(&self, index: Index<Accessor>) -> Outcome<Vec<[f32; 16]>> {
        let read = || match self.component(index)? {
            ComponentType::F32 => self.elements(index, Type::Mat4, |Vector(numbers): Vector<f32, 16>| numbers),
            other => {
                broken(format!("component type {} is not allowed here; matrices are of floats", other.as_gl_enum()))
            }
        };
        read().map_err(|fault| fault.within(|| format!("accessor {index}")))
    }

    /// Reads four unsigned integers each, of 8 or 16 bits.
    pub(super) fn joints(&self, index: Index<Accessor>) -> Outcome<Vec<[u32; 4]>> {
        let read = || match self.component(index)? {
            ComponentType::U8 => self.elements(index, Type::Vec4, |Vector(four): Vector<u8, 4>| four.map(u32::from)),
            ComponentType::U16 => self.elements(index, Type::Vec4, |Vector(four): Vector<u16, 4>| four.map(u32::from)),
            other => {
                broken(format!("joints of component type {}; they must be unsigned (5121 or 5123)", other.as_gl_enum()))
            }
        };
        read().map_err(|fault| fault.within(|| format!("accessor {index}")))
    }

    /// Reads unsigned integers.
    pub(super) fn indices(&self, index: Index<Accessor>) -> Outcome<Vec<u32>> {
        let read = || match self.component(index)? {
            ComponentType::U8 => self.elements(index, Type::Scalar, |index: u8| index.into()),
            ComponentType::U16 => self.elements(index, Type::Scalar, |index: u16| index.into()),
            ComponentType::U32 => self.elements(index, Type::Scalar, |index: u32| index),
            other => broken(format!(
                "indices of component type {}; they must be unsigned (5121, 5123 or 5125)",
                other.as_gl_enum()
            )),
        };
        read().map_err(|fault| fault.within(|| format!("accessor {index}")))
    }

    /// The `min` and `max` that the JSON declares for vectors of three floats, rounded to the floats they stand for; none if
    /// there are none, or of integers, whose bounds are not in the vectors' own unit.
    pub(super) fn declared_box(&self, index: Index<Accessor>) -> Outcome<Option<Aabb>> {
        let accessor = self.get(index)?;
        if accessor.normalized || self.component(index)? != ComponentType::F32 {
            return Ok(None);
        }
        let corner = |value: &Option<serde_json::Value>| -> Option<DVec3> {
            let parts: Vec<f64> = value.as_ref()?.as_array()?.iter().filter_map(serde_json::Value::as_f64).collect();
            // Decimal digits are cut off by many writers: no vertex lies between a float and its digits.
            Some(DVec3::from_array(parts.try_into().ok()?).as_vec3().as_dvec3())
        };
        Ok(corner(&accessor.min).zip(corner(&accessor.max)).map(|(min, max)| Aabb { min, max }))
    }

    fn component(&self, index: Index<Accessor>) -> Outcome<ComponentType> {
        match self.get(index)?.component_type {
            Valid(GenericComponentType(component)) => Ok(component),
            _ => broken(format!(
                "component type {} is none of 5120 to 5123, 5125 and 5126",
                self.document.said(&format!("/accessors/{index}/componentType"))
            )),
        }
    }

    /// Counts elements that are read, or work of the same order.
    pub(super) fn spend(&self, count: u64) -> Outcome<()> {
        let left = self.elements_left.get().checked_sub(count).ok_or_else(|| {
            Fault::TooLarge(format!(
                "the file reads more than {} elements, too many for its size; export fewer copies, keys or morph targets",
                self.most_elements
            ))
        })?;
        self.elements_left.set(left);
        Ok(())
    }

    fn elements<T: Item, U: Clone>(
        &self,
        index: Index<Accessor>,
        wanted: Type,
        convert: impl Fn(T) -> U,
    ) -> Outcome<Vec<U>> {
        let accessor = self.get(index)?;
        if accessor.type_ != Valid(wanted) {
            let kind = self.document.said(&format!("/accessors/{index}/type"));
            return broken(format!(
                "its type is '{kind}', but {} is needed here",
                format!("{wanted:?}").to_uppercase()
            ));
        }
        let count = accessor.count.0;
        let mut elements: Vec<U> = match accessor.buffer_view {
            Some(view) => {
                let items = self.items(view, accessor.byte_offset, count, true)?;
                self.spend(count)?;
                items.map(&convert).collect()
            }
            None if count > MOST_ZEROS => {
                return Err(Fault::TooLarge(format!("{count} elements without data; the limit is {MOST_ZEROS}")));
            }
            None => {
                self.spend(count)?;
                vec![convert(T::zero()); count as usize]
            }
        };
        let Some(sparse) = &accessor.sparse else { return Ok(elements) };
        let (at, count) = (&sparse.indices, sparse.count.0);
        let (view, offset) = (at.buffer_view, Some(at.byte_offset));
        let at = match at.component_type {
            Valid(kind) if kind.0 == ComponentType::U8 => {
                SparseIndicesIter::U8(self.items(view, offset, count, false)?)
            }
            Valid(kind) if kind.0 == ComponentType::U16 => {
                SparseIndicesIter::U16(self.items(view, offset, count, false)?)
            }
            Valid(_) => SparseIndicesIter::U32(self.items(view, offset, count, false)?),
            _ => return broken("its sparse indices must be unsigned (5121, 5123 or 5125)"),
        };
        let values = self.items(sparse.values.buffer_view, Some(sparse.values.byte_offset), count, false)?;
        for (at, value) in at.zip(values) {
            let Some(element) = elements.get_mut(at as usize) else {
                return broken(format!("a sparse value is for element {at} of {}", accessor.count.0));
            };
            *element = convert(value);
        }
        Ok(elements)
    }

    /// `count` elements in a buffer view.
    fn items<T: Item>(
        &self,
        view: Index<View>,
        offset: Option<USize64>,
        count: u64,
        strided: bool,
    ) -> Outcome<ItemIter<'a, T>> {
        let bytes = self.view(view).map_err(|fault| fault.within(|| format!("buffer view {view}")))?;
        let (size, offset) = (size_of::<T>(), offset.unwrap_or_default().0);
        let stride = element(&self.document.root, view, "buffer view")?.byte_stride.filter(|_| strided);
        let stride = stride.map_or(size, |stride| stride.0);
        if stride < size {
            return broken(format!("buffer view {view} has a stride of {stride} bytes, less than an element's {size}"));
        }
        // Bytes from the first element's start to the last one's end.
        let span = match count {
            0 => Some(0),
            _ => (count - 1).checked_mul(stride as u64).and_then(|last| last.checked_add(size as u64)),
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
        Ok(ItemIter::new(bytes, stride))
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, index: Index<View>) -> Outcome<&'a [u8]> {
        let view = element(&self.document.root, index, "buffer view")?;
        element(&self.document.root, view.buffer, "buffer")?;
        let Some(bytes) = &self.buffers[view.buffer.value()] else {
            return broken(format!("buffer {} has no data", view.buffer));
        };
        let (offset, length) = (view.byte_offset.unwrap_or_default().0, view.byte_length.0);
        let range = offset
            .checked_add(length)
            .and_then(|end| bytes.get(usize::try_from(offset).ok()?..usize::try_from(end).ok()?));
        match range {
            Some(bytes) => Ok(bytes),
            None => broken(format!(
                "{length} bytes from byte {offset} do not fit into buffer {} of {} bytes",
                view.buffer,
                bytes.len()
            )),
        }
    }
}
