//! KHR_draco_mesh_compression: primitives compressed by Draco, decoded by the `draco-core` crate.
//!
//! The accessors of such a primitive have a type and a count but no bytes. Each gets a buffer view of the decoded bytes.

use super::{add_buffer, add_view, Budget};
use crate::gltf::accessor::Accessors;
use crate::gltf::buffers::Bytes;
use crate::gltf::document::Document;
use crate::gltf::fault::{broken, element, label, Fault, Outcome};
use draco_core::{DataType, DecodeLimits, DecoderBuffer, ErrorKind, Mesh, MeshDecoder, PointAttribute, PointIndex};
use gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked::{self, Valid};
use gltf::json::validation::USize64;
use gltf::json::{Index, Root};
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};

const NAME: &str = "KHR_draco_mesh_compression";

/// The extension's object on a primitive.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Compressed {
    buffer_view: u32,
    /// Draco's identifier of each attribute; the key is the attribute's name in glTF.
    attributes: BTreeMap<String, u32>,
}

/// A part of a stream: its buffer view, and the identifier of an attribute, or none for the triangles.
type Part = (u32, Option<u32>);

/// An accessor's bytes.
struct Decoded {
    component: ComponentType,
    count: u64,
    bytes: Vec<u8>,
}

/// Decodes the primitives whose accessors have no bytes of their own, or all primitives if the file requires the extension.
pub(super) fn decode(document: &mut Document, buffers: &mut Vec<Bytes<'_>>, budget: &mut Budget) -> Outcome<()> {
    let required = document.root.extensions_required.iter().any(|name| name == NAME);
    // The part of a stream that fills each accessor. Primitives may share streams, and accessors of other streams.
    let mut parts: HashMap<usize, Part> = HashMap::new();
    let mut accessor_of: HashMap<(usize, Part), Index<Accessor>> = HashMap::new();
    for mesh in 0..document.root.meshes.len() {
        for at in 0..document.root.meshes[mesh].primitives.len() {
            let Some(compressed) = needed(&document.root, mesh, at, required) else { continue };
            let place = |root: &Root| {
                format!("{}, primitive {at}: {NAME}", label("mesh", mesh, root.meshes[mesh].name.as_deref()))
            };
            let within = |fault: Fault| fault.within(|| place(&document.root));
            let compressed = compressed.map_err(within)?;
            let wanted = wanted(&document.root.meshes[mesh].primitives[at], &compressed);
            let known: Option<Vec<Index<Accessor>>> =
                wanted.iter().map(|(_, index, part)| accessor_of.get(&(index.value(), *part)).copied()).collect();
            let indices = match known {
                Some(indices) => indices,
                None => {
                    let all = stream(document, buffers, &compressed, &wanted, budget).map_err(within)?;
                    let put = |((_, index, part), decoded): (&Wanted, Decoded)| {
                        let new = put(&mut document.root, buffers, *index, *part, decoded, &mut parts);
                        accessor_of.insert((index.value(), *part), new);
                        new
                    };
                    wanted.iter().zip(all).map(put).collect()
                }
            };
            let primitive = &mut document.root.meshes[mesh].primitives[at];
            for ((semantic, ..), index) in wanted.iter().zip(indices) {
                match semantic {
                    Some(semantic) => drop(primitive.attributes.insert(semantic.clone(), index)),
                    None => primitive.indices = Some(index),
                }
            }
            // A strip's triangles are decoded one by one.
            primitive.mode = Valid(Mode::Triangles);
        }
    }
    Ok(())
}

/// An accessor that a stream fills: its attribute, or none for indices; its index; its part of the stream.
type Wanted = (Option<Checked<Semantic>>, Index<Accessor>, Part);

/// The extension's object on a primitive that needs it.
fn needed(root: &Root, mesh: usize, at: usize, required: bool) -> Option<Outcome<Compressed>> {
    let primitive = &root.meshes[mesh].primitives[at];
    let value = primitive.extensions.as_ref()?.others.get(NAME).filter(|value| **value != Value::Null)?;
    let compressed = match Compressed::deserialize(value) {
        Ok(compressed) => compressed,
        Err(error) => return Some(broken(error.to_string())),
    };
    let is_bare = |index: Index<Accessor>| {
        root.accessors.get(index.value()).is_some_and(|accessor| accessor.buffer_view.is_none())
    };
    let bare = wanted(primitive, &compressed).iter().any(|(_, index, _)| is_bare(*index));
    (required || bare).then_some(Ok(compressed))
}

/// The accessors of a primitive that its stream fills.
fn wanted(primitive: &Primitive, compressed: &Compressed) -> Vec<Wanted> {
    let attributes = compressed.attributes.iter().filter_map(|(name, id)| {
        let semantic = Checked::<Semantic>::deserialize(Value::String(name.clone())).ok()?;
        let index = *primitive.attributes.get(&semantic)?;
        Some((Some(semantic), index, (compressed.buffer_view, Some(*id))))
    });
    let indices = primitive.indices.map(|index| (None, index, (compressed.buffer_view, None)));
    attributes.chain(indices).collect()
}

/// Decodes a stream into the bytes of each accessor.
fn stream(
    document: &Document,
    buffers: &[Bytes<'_>],
    compressed: &Compressed,
    wanted: &[Wanted],
    budget: &mut Budget,
) -> Outcome<Vec<Decoded>> {
    // It looks up counts and bytes, and reads no elements.
    let accessors = Accessors::new(document, buffers, 0);
    let bytes = accessors
        .view(Index::new(compressed.buffer_view))
        .map_err(|fault| fault.within(|| format!("buffer view {}", compressed.buffer_view)))?;
    let count = |of_indices: bool| {
        let counts = wanted.iter().filter(|(semantic, ..)| semantic.is_none() == of_indices);
        counts.map(|(_, index, _)| accessors.count(*index)).try_fold(0, |most, count| Ok(most.max(count?)))
    };
    let (most_vertices, most_indices) = (count(false)?, count(true)?);
    let limits = DecodeLimits::default()
        .with_max_points(most_vertices)
        // A strip has about as many triangles as indices, a list a third.
        .with_max_faces(most_indices.min(budget.left / 12))
        .with_max_decoded_bytes(budget.left);
    let mut mesh = Mesh::new();
    let mut stream = DecoderBuffer::new(bytes).with_limits(limits);
    MeshDecoder::new().decode(&mut stream, &mut mesh).or_else(|error| match error.kind() {
        ErrorKind::LimitExceeded => broken(format!(
            "its stream holds more than its accessors say, or than a file of this size may decode to ({error})"
        )),
        _ => broken(format!("its stream cannot be decoded ({error}); compress the file again")),
    })?;
    let (vertices, triangles) = (mesh.num_points() as u64, mesh.num_faces() as u64);
    if vertices > most_vertices {
        return broken(format!("its stream has {vertices} vertices, but its accessors have {most_vertices}"));
    }
    // Attributes that no accessor reads cost as much time as others.
    let attributes = (0..mesh.num_attributes()).map(|number| mesh.attribute(number).buffer().data().len() as u64);
    let stored = attributes.sum::<u64>() + 12 * triangles + bytes.len() as u64;
    budget.spend(stored.saturating_add(vertices.saturating_mul(16 * wanted.len() as u64)))?;
    let decoded = |(semantic, index, (_, id)): &Wanted| {
        let accessor = element(&document.root, *index, "accessor")?;
        match (semantic, id) {
            (Some(_), Some(id)) => match mesh.attribute_by_unique_id(*id) {
                Some(attribute) => attribute_bytes(attribute, mesh.num_points(), accessor)
                    .map_err(|fault| fault.within(|| format!("accessor {index}, attribute {id} of the stream"))),
                None => broken(format!("its stream has no attribute {id}")),
            },
            _ => Ok(triangle_bytes(&mesh)),
        }
    };
    wanted.iter().map(decoded).collect()
}

fn triangle_bytes(mesh: &Mesh) -> Decoded {
    let corners = mesh.faces().iter().flatten();
    let bytes: Vec<u8> = corners.flat_map(|corner| corner.0.to_le_bytes()).collect();
    Decoded { component: ComponentType::U32, count: 3 * mesh.num_faces() as u64, bytes }
}

/// The values of an attribute, one a vertex, in its accessor's component type.
fn attribute_bytes(attribute: &PointAttribute, vertices: usize, accessor: &Accessor) -> Outcome<Decoded> {
    let (Valid(GenericComponentType(component)), Valid(kind)) = (accessor.component_type, accessor.type_) else {
        return broken("its type or component type is unknown");
    };
    let width = match kind {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 => 4,
        _ => return broken("it is a matrix, which no attribute is"),
    };
    let (from, stride) = (attribute.data_type(), usize::try_from(attribute.byte_stride()).unwrap_or(0));
    if usize::from(attribute.num_components()) != width {
        return broken(format!("it has {} numbers a vertex instead of {width}", attribute.num_components()));
    }
    let data = attribute.buffer().data();
    let mut bytes = Vec::with_capacity(vertices * width * component.size());
    for vertex in 0..vertices {
        let value = attribute.mapped_index(PointIndex(vertex as u32)).0 as usize;
        let start = value.checked_mul(stride);
        let Some(numbers) = start.and_then(|start| data.get(start..)?.get(..width * from.byte_length())) else {
            return broken(format!("vertex {vertex} has no value"));
        };
        for number in numbers.chunks_exact(from.byte_length().max(1)) {
            if write(component, read(from, number), &mut bytes).is_none() {
                return broken(format!("a number of vertex {vertex} does not fit its accessor's component type"));
            }
        }
    }
    Ok(Decoded { component, count: vertices as u64, bytes })
}

/// Reads a number of an attribute. None for types that glTF does not have.
fn read(kind: DataType, bytes: &[u8]) -> Option<f64> {
    Some(match (kind, bytes) {
        (DataType::Int8, &[byte]) => (byte as i8).into(),
        (DataType::Uint8 | DataType::Bool, &[byte]) => byte.into(),
        (DataType::Int16, &[a, b]) => i16::from_le_bytes([a, b]).into(),
        (DataType::Uint16, &[a, b]) => u16::from_le_bytes([a, b]).into(),
        (DataType::Int32, &[a, b, c, d]) => i32::from_le_bytes([a, b, c, d]).into(),
        (DataType::Uint32, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]).into(),
        (DataType::Float32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]).into(),
        _ => return None,
    })
}

/// Appends a number in an accessor's component type; none if that cannot hold it.
fn write(kind: ComponentType, number: Option<f64>, out: &mut Vec<u8>) -> Option<()> {
    let number = number?;
    let within = |least: f64, most: f64| (number.fract() == 0.0 && (least..=most).contains(&number)).then_some(number);
    match kind {
        ComponentType::I8 => out.extend((within(-128.0, 127.0)? as i8).to_le_bytes()),
        ComponentType::U8 => out.extend((within(0.0, 255.0)? as u8).to_le_bytes()),
        ComponentType::I16 => out.extend((within(-32_768.0, 32_767.0)? as i16).to_le_bytes()),
        ComponentType::U16 => out.extend((within(0.0, 65_535.0)? as u16).to_le_bytes()),
        ComponentType::U32 => out.extend((within(0.0, f64::from(u32::MAX))? as u32).to_le_bytes()),
        ComponentType::F32 => out.extend((number as f32).to_le_bytes()),
    }
    Some(())
}

/// Gives an accessor its bytes. If another stream has filled the accessor, a copy of it gets them.
fn put(
    root: &mut Root,
    buffers: &mut Vec<Bytes<'_>>,
    index: Index<Accessor>,
    part: Part,
    decoded: Decoded,
    parts: &mut HashMap<usize, Part>,
) -> Index<Accessor> {
    let mut index = index;
    if parts.get(&index.value()).is_some_and(|other| *other != part) {
        root.accessors.push(root.accessors[index.value()].clone());
        // The file's own list is far shorter than 2^32.
        index = Index::new(root.accessors.len() as u32 - 1);
    }
    parts.insert(index.value(), part);
    let buffer = add_buffer(root, buffers, decoded.bytes);
    let view = add_view(root, buffer);
    let accessor = &mut root.accessors[index.value()];
    accessor.buffer_view = Some(view);
    (accessor.byte_offset, accessor.sparse) = (None, None);
    accessor.count = USize64(decoded.count);
    accessor.component_type = Valid(GenericComponentType(decoded.component));
    // Draco rounds positions, so that they may leave the box of the original ones.
    (accessor.min, accessor.max) = (None, None);
    index
}
