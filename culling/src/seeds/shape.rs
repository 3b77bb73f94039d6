//! Where in its box a mesh has triangles, as bits of a small grid.

use glam::{UVec3, Vec3};
use shaders::draw::ObjectsVertex;
use shaders::types::{MeshRange, MeshShape, SHAPE_HALVINGS, SHAPE_WORDS};

/// How thin a box may be, as a share of its longest side: flat meshes have a grid too.
const THINNEST: f32 = 1.0e-3;

/// The shapes of meshes.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// By mesh: its box and how many cells that has.
    pub meshes: Vec<MeshShape>,
    /// By mesh, [`SHAPE_WORDS`] each: which cells hold triangles.
    pub filled: Vec<u32>,
}

impl Shapes {
    /// The shapes of meshes of triangles. A mesh of lines or points has one too, which says little, and one without triangles an empty one.
    pub fn of(meshes: &[MeshRange], vertices: &[ObjectsVertex], indices: &[u32]) -> Self {
        let mut shapes = Shapes::default();
        for mesh in meshes {
            let range = mesh.first_index as usize..(mesh.first_index + mesh.index_count) as usize;
            let position = |index: &u32| vertices[(mesh.vertex_offset + *index as i32) as usize].position.into();
            let corners: Vec<Vec3> = indices[range].iter().map(position).collect();
            let (shape, filled) = shape_of(&corners);
            shapes.meshes.push(shape);
            shapes.filled.extend(filled);
        }
        shapes
    }
}

/// The shape of triangles, by their corners: each cell of their box that a triangle touches is filled.
pub fn shape_of(corners: &[Vec3]) -> (MeshShape, [u32; SHAPE_WORDS as usize]) {
    let mut filled = [0; SHAPE_WORDS as usize];
    let low = corners.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = corners.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    if corners.len() < 3 || !(high - low).is_finite() {
        return (MeshShape { low: [0.0; 3], size: [1.0; 3], cells: [1; 3] }, filled);
    }
    let thinnest = THINNEST * (high - low).max_element();
    let size = (high - low).max(Vec3::splat(thinnest.max(f32::MIN_POSITIVE)));
    let mut cells = UVec3::ONE;
    for _ in 0..SHAPE_HALVINGS {
        let longest = (size / cells.as_vec3()).max_position();
        cells[longest] *= 2;
    }
    for triangle in corners.chunks_exact(3) {
        let in_cells = |corner: usize| (triangle[corner] - low) / size * cells.as_vec3();
        fill(&mut filled, cells, [0, 1, 2].map(in_cells));
    }
    (MeshShape { low: low.to_array(), size: size.to_array(), cells: cells.to_array() }, filled)
}

/// Fills the cells that a triangle touches. Positions are in cells.
fn fill(filled: &mut [u32; SHAPE_WORDS as usize], count: UVec3, corners: [Vec3; 3]) {
    let [a, b, c] = corners;
    let cell_of = |position: Vec3| position.floor().clamp(Vec3::ZERO, count.as_vec3() - 1.0).as_uvec3();
    let (first, last) = (cell_of(a.min(b).min(c)), cell_of(a.max(b).max(c)));
    for z in first.z..=last.z {
        for y in first.y..=last.y {
            for x in first.x..=last.x {
                let centre = UVec3::new(x, y, z).as_vec3() + 0.5;
                if touches(corners.map(|corner| corner - centre)) {
                    let bit = x + count.x * (y + count.y * z);
                    filled[bit as usize / 32] |= 1 << (bit % 32);
                }
            }
        }
    }
}

/// Does a triangle whose box meets the cell around the origin touch the cell? No axis parts them: neither its normal, nor one across an
/// edge of each (Akenine-Moeller 2001).
fn touches(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners;
    let edges = [b - a, c - b, a - c];
    let normal = edges[0].cross(edges[1]);
    let parts = |axis: Vec3| {
        let along = corners.map(|corner| axis.dot(corner));
        let reach = 0.5 * axis.abs().element_sum();
        let (low, high) = (along[0].min(along[1]).min(along[2]), along[0].max(along[1]).max(along[2]));
        low > reach || high < -reach
    };
    let across = edges.into_iter().flat_map(|edge| Vec3::AXES.map(|axis| axis.cross(edge)));
    !std::iter::once(normal).chain(across).any(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_filled(shape: &MeshShape, filled: &[u32], position: Vec3) -> bool {
        let cells = UVec3::from(shape.cells);
        let cell = (position - Vec3::from(shape.low)) / Vec3::from(shape.size) * cells.as_vec3();
        let cell = cell.floor().clamp(Vec3::ZERO, cells.as_vec3() - 1.0).as_uvec3();
        let bit = cell.x + cells.x * (cell.y + cells.y * cell.z);
        filled[bit as usize / 32] >> (bit % 32) & 1 != 0
    }

    fn share(filled: &[u32]) -> f64 {
        f64::from(filled.iter().map(|word| word.count_ones()).sum::<u32>()) / f64::from(1u32 << SHAPE_HALVINGS)
    }

    #[test]
    fn where_a_triangle_is_its_cell_is_filled_and_little_else() {
        let triangle = [Vec3::new(-3.0, 0.1, 2.0), Vec3::new(5.0, 1.7, 2.5), Vec3::new(0.3, 6.0, -4.0)];
        let (shape, filled) = shape_of(&triangle);
        for step in 0..2000 {
            let (a, b) = ((step % 50) as f32 / 49.0, (step / 50) as f32 / 39.0);
            let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
            let position = triangle[0] + a * (triangle[1] - triangle[0]) + b * (triangle[2] - triangle[0]);
            assert!(is_filled(&shape, &filled, position), "{position}");
        }
        assert!(share(&filled) < 0.15, "a triangle fills {} of its box", share(&filled));
    }

    #[test]
    fn cells_are_as_long_as_wide() {
        let long = [Vec3::ZERO, Vec3::new(100.0, 0.0, 0.0), Vec3::new(100.0, 3.0, 3.0)];
        let (shape, _) = shape_of(&long);
        let [x, y, z] = [0, 1, 2].map(|axis| shape.size[axis] / shape.cells[axis] as f32);
        assert!(x.max(y).max(z) <= 2.0 * x.min(y).min(z), "{x} {y} {z}");
        assert_eq!(shape.cells.iter().product::<u32>(), 1 << SHAPE_HALVINGS);
    }

    #[test]
    fn flat_and_empty_meshes_have_shapes() {
        let flat = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let (shape, filled) = shape_of(&flat);
        assert!(shape.size.iter().all(|size| *size > 0.0) && is_filled(&shape, &filled, Vec3::new(0.2, 0.2, 0.0)));
        for nothing in [&[][..], &[Vec3::ZERO; 2], &[Vec3::splat(f32::MAX), Vec3::splat(-f32::MAX), Vec3::ZERO]] {
            assert_eq!(share(&shape_of(nothing).1), 0.0);
        }
        let point = [Vec3::ONE; 3];
        assert!(shape_of(&point).0.size.iter().all(|size| *size > 0.0));
    }
}
