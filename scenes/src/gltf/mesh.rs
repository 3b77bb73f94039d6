//! Meshes: positions, normals and indices of a glTF primitive as triangles, lines or points.

use super::accessor::{Accessors, Allowed};
use super::fault::{broken, Fault, Outcome};
use super::normals;
use crate::model::{Mesh, Topology};
use glam::Vec3;
use gltf::json::accessor::Accessor;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked::Valid;
use gltf::json::Index;

/// Most indices of all meshes together, after strips and fans are rewritten: within reach of 32-bit offsets with room to spare.
const MOST_INDICES: usize = 1 << 31;

/// Reads a primitive, with morph targets at fixed weights. None if it has no positions, which is legal and means nothing to draw.
/// `indices_so_far` counts the indices of the meshes before it, `said_mode` tells what the file has for a mode.
pub(super) fn read(
    accessors: &Accessors,
    primitive: &Primitive,
    weights: &[f32],
    name: String,
    indices_so_far: &mut usize,
    said_mode: impl FnOnce() -> String,
) -> Outcome<Option<Mesh>> {
    let Some(&positions_at) = primitive.attributes.get(&Valid(Semantic::Positions)) else { return Ok(None) };
    if accessors.is_all_zeros(positions_at)? {
        return broken(
            "its POSITION has no data; is the file compressed with an extension that it does not list as required?",
        );
    }
    let positions =
        accessors.vectors::<3>(positions_at, Allowed::Quantized).map_err(|fault| fault.within(|| "POSITION".into()))?;
    let mut mesh = Mesh { name, positions: to_vec3(positions), ..Mesh::default() };
    if let Some(&normals_at) = primitive.attributes.get(&Valid(Semantic::Normals)) {
        mesh.normals = same_count(accessors, normals_at, mesh.positions.len())
            .map_err(|fault| fault.within(|| "NORMAL".into()))?;
    }
    mesh.declared_bounds = accessors.declared_box(positions_at)?.filter(|declared| *declared != mesh.bounds());
    for (index, (target, &weight)) in primitive.targets.iter().flatten().zip(weights).enumerate() {
        if weight != 0.0 {
            let place = || format!("morph target {index}");
            // They are of the mesh before it is morphed.
            mesh.declared_bounds = None;
            morph(accessors, target.positions, weight, &mut mesh.positions).map_err(|fault| fault.within(place))?;
            morph(accessors, target.normals, weight, &mut mesh.normals).map_err(|fault| fault.within(place))?;
        }
    }
    if let Some(vertex) = mesh.positions.iter().position(|position| !position.is_finite()) {
        return broken(format!("the position of vertex {vertex} is not finite: {}", mesh.positions[vertex]));
    }
    let listed = read_indices(accessors, primitive, mesh.positions.len())?;
    let Valid(mode) = primitive.mode else {
        return broken(format!("its mode {} is none of 0 to 6", said_mode()));
    };
    (mesh.topology, mesh.indices) = rewritten(mode, listed)?;
    *indices_so_far += mesh.indices.len();
    if *indices_so_far > MOST_INDICES {
        return Err(Fault::TooLarge(format!("its meshes have more than {MOST_INDICES} indices")));
    }
    normals::complete(&mut mesh);
    Ok(Some(mesh))
}

fn to_vec3(vectors: Vec<[f32; 3]>) -> Vec<Vec3> {
    vectors.into_iter().map(Vec3::from_array).collect()
}

/// Reads one vector a vertex. The count is compared first, so that a wrong one costs no memory.
fn same_count(accessors: &Accessors, index: Index<Accessor>, vertices: usize) -> Outcome<Vec<Vec3>> {
    let count = accessors.count(index)?;
    if count != vertices as u64 {
        return broken(format!("accessor {index} has {count} elements, but there are {vertices} positions"));
    }
    Ok(to_vec3(accessors.vectors::<3>(index, Allowed::Quantized)?))
}

fn morph(accessors: &Accessors, deltas: Option<Index<Accessor>>, weight: f32, base: &mut [Vec3]) -> Outcome<()> {
    let Some(deltas) = deltas.filter(|_| !base.is_empty()) else { return Ok(()) };
    let deltas = same_count(accessors, deltas, base.len())?;
    for (base, delta) in base.iter_mut().zip(deltas) {
        *base += delta * weight;
    }
    Ok(())
}

fn read_indices(accessors: &Accessors, primitive: &Primitive, vertices: usize) -> Outcome<Vec<u32>> {
    let Some(index) = primitive.indices else { return Ok((0..vertices as u32).collect()) };
    let indices = accessors.indices(index).map_err(|fault| fault.within(|| "indices".into()))?;
    if let Some(at) = indices.iter().position(|&index| index as usize >= vertices) {
        return broken(format!(
            "index {at} (accessor {index}) refers to vertex {}, but it has {vertices}",
            indices[at]
        ));
    }
    Ok(indices)
}

/// Strips, fans and loops as lists (glTF 2.0, section 3.7.2.1, where the order of corners is given).
fn rewritten(mode: Mode, list: Vec<u32>) -> Outcome<(Topology, Vec<u32>)> {
    let count = list.len();
    let (name, topology, fits) = match mode {
        Mode::Points => ("points", Topology::Points, count >= 1),
        Mode::Lines => ("lines", Topology::Lines, count >= 2 && count % 2 == 0),
        Mode::LineLoop => ("a line loop", Topology::Lines, count >= 2),
        Mode::LineStrip => ("a line strip", Topology::Lines, count >= 2),
        Mode::Triangles => ("triangles", Topology::Triangles, count >= 3 && count % 3 == 0),
        Mode::TriangleStrip => ("a triangle strip", Topology::Triangles, count >= 3),
        Mode::TriangleFan => ("a triangle fan", Topology::Triangles, count >= 3),
    };
    if !fits {
        return broken(format!("{count} vertices cannot form {name}; some are missing or too many"));
    }
    let indices = match mode {
        Mode::LineLoop => (0..count).flat_map(|first| [list[first], list[(first + 1) % count]]).collect(),
        Mode::LineStrip => list.windows(2).flatten().copied().collect(),
        // Every second triangle of a strip is turned round, so that all face the same way.
        Mode::TriangleStrip => (0..count - 2)
            .flat_map(|first| [list[first], list[first + 1 + first % 2], list[first + 2 - first % 2]])
            .collect(),
        Mode::TriangleFan => list[1..].windows(2).flat_map(|edge| [edge[0], edge[1], list[0]]).collect(),
        Mode::Points | Mode::Lines | Mode::Triangles => list,
    };
    Ok((topology, indices))
}
