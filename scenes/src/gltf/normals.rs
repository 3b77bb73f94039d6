//! Normals for meshes that come with none, or with some that point nowhere.

use crate::model::{Mesh, Topology};
use glam::{DVec3, Vec3};

/// Shorter normals than this have no meaningful direction; longer ones are brought to unit length.
const SHORTEST: f32 = 1e-6;

/// Makes `normals` one unit vector a position. Missing ones, zeros and non-numbers are replaced by the area-weighted mean over the
/// triangles at the vertex; on lines, points and degenerate triangles by +z.
///
/// glTF asks for flat normals where there are none, which needs three vertices a triangle. Sightline shades for orientation only
/// and keeps the vertices shared.
pub(crate) fn complete(mesh: &mut Mesh) {
    mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
    let mut bad = false;
    for normal in &mut mesh.normals {
        // Scaled first: the square of a large f32 may overflow.
        let largest = normal.abs().max_element();
        *normal = if normal.is_finite() && largest > SHORTEST { (*normal / largest).normalize() } else { Vec3::ZERO };
        bad |= *normal == Vec3::ZERO;
    }
    if !bad {
        return;
    }
    let computed = area_weighted(mesh);
    for (normal, computed) in mesh.normals.iter_mut().zip(computed) {
        if *normal == Vec3::ZERO {
            *normal = computed.try_normalize().unwrap_or(DVec3::Z).as_vec3();
        }
    }
}

fn area_weighted(mesh: &Mesh) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    if mesh.topology == Topology::Triangles {
        for triangle in mesh.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| triangle[corner] as usize);
            let [a, b, c] = corners.map(|corner| mesh.positions[corner].as_dvec3());
            // The cross product's length is twice the area.
            let weighted = (b - a).cross(c - a);
            corners.iter().for_each(|&corner| sums[corner] += weighted);
        }
    }
    sums
}
