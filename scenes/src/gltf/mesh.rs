//! Meshes: positions, normals and indices of a glTF primitive as triangles, lines or points.

use super::accessor::{Accessors, Allowed};
use super::fault::{broken, Fault, Outcome};
use super::morphs::{self, same_count, Weights};
use super::normals;
use crate::model::{Mesh, Topology};
use glam::Vec3;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked::Valid;

/// Most indices of all meshes together, after strips and fans are rewritten: within reach of 32-bit offsets with room to spare.
const MOST_INDICES: usize = 1 << 31;

/// Reads a primitive, and the morph targets whose weight is animated; other targets become part of the mesh. None if the primitive has
/// no positions, which is legal and means nothing to draw. `indices_so_far` counts the indices of the meshes before it; `said_mode`
/// returns the mode as the file has it.
pub(super) fn read(
    accessors: &Accessors,
    primitive: &Primitive,
    weights: &Weights,
    name: String,
    indices_so_far: &mut usize,
    said_mode: impl FnOnce() -> String,
) -> Outcome<Option<(Mesh, Vec<morphs::Moving>)>> {
    let Some(&positions_at) = primitive.attributes.get(&Valid(Semantic::Positions)) else { return Ok(None) };
    if accessors.is_all_zeros(positions_at)? && !morphs::displace_positions(primitive) {
        tracing::warn!("mesh '{name}': its POSITION has no data, so that all of its vertices are at the origin");
    }
    let positions =
        accessors.vectors::<3>(positions_at, Allowed::Quantized).map_err(|fault| fault.within(|| "POSITION".into()))?;
    let mut mesh = Mesh { name, positions: to_vec3(positions), ..Mesh::default() };
    if let Some(&normals_at) = primitive.attributes.get(&Valid(Semantic::Normals)) {
        mesh.normals = same_count(accessors, normals_at, mesh.positions.len())
            .map_err(|fault| fault.within(|| "NORMAL".into()))?;
    }
    mesh.declared_bounds = accessors.declared_box(positions_at)?.filter(|declared| *declared != mesh.bounds());
    if weights.fixed.iter().any(|weight| *weight != 0.0) {
        // The declared box is that of the mesh before morphing.
        mesh.declared_bounds = None;
    }
    morphs::apply(accessors, primitive, weights, &mut mesh)?;
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
    let normals = if weights.moves.is_empty() { Vec::new() } else { mesh.normals.clone() };
    normals::complete(&mut mesh);
    let moving = morphs::moving(accessors, primitive, weights, (&mesh, &normals))?;
    Ok(Some((mesh, moving)))
}

fn to_vec3(vectors: Vec<[f32; 3]>) -> Vec<Vec3> {
    vectors.into_iter().map(Vec3::from_array).collect()
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
        Mode::Lines => ("lines", Topology::Lines, count >= 2 && count.is_multiple_of(2)),
        Mode::LineLoop => ("a line loop", Topology::Lines, count >= 2),
        Mode::LineStrip => ("a line strip", Topology::Lines, count >= 2),
        Mode::Triangles => ("triangles", Topology::Triangles, count >= 3 && count.is_multiple_of(3)),
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
