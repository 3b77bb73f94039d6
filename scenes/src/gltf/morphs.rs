//! Morph targets. Targets of fixed weight become part of the mesh; targets of animated weight are kept as displacements of single
//! vertices.

use super::accessor::{Accessors, Allowed};
use super::fault::{broken, Fault, Outcome};
use super::normals;
use crate::model::Mesh;
use crate::morph::Displacement;
use glam::Vec3;
use gltf::json::accessor::Accessor;
use gltf::json::mesh::{MorphTarget, Primitive};
use gltf::json::Index;

/// Most vertices that morph targets displace, counted once a target. Targets may share accessors, so a small file could ask for much
/// memory.
const MOST_DISPLACEMENTS: usize = 1 << 23;

/// An index or a vertex for which a normal is computed counts as so many elements: that is how much longer it takes.
const NORMAL_COST: u64 = 8;

/// Refuses a file whose targets displace too many vertices.
pub(super) fn check_displacements(count: usize) -> Outcome<()> {
    match count > MOST_DISPLACEMENTS {
        true => Err(Fault::TooLarge(format!(
            "its morph targets displace more than {MOST_DISPLACEMENTS} vertices; export fewer targets"
        ))),
        false => Ok(()),
    }
}

/// The weights of a mesh's morph targets on a node.
#[derive(Clone, Debug, Default)]
pub(super) struct Weights {
    /// Weights that never change, indexed by target. 0 for targets of animated weight; missing weights at the end are 0.
    pub(super) fixed: Vec<f32>,
    /// Targets whose weight is animated; false for targets beyond the last.
    pub(super) moves: Vec<bool>,
}

/// A target whose weight is animated: its index in the mesh, and its displacements.
pub(super) type Moving = (usize, Vec<Displacement>);

/// True if some target displaces positions. Positions without data are then zeros that mean something.
pub(super) fn displace_positions(primitive: &Primitive) -> bool {
    primitive.targets.iter().flatten().any(|target| target.positions.is_some())
}

/// Adds targets of fixed weight to the mesh.
pub(super) fn apply(accessors: &Accessors, primitive: &Primitive, weights: &Weights, mesh: &mut Mesh) -> Outcome<()> {
    for (index, (target, &weight)) in targets(primitive).zip(&weights.fixed).enumerate() {
        if weight != 0.0 {
            let place = || format!("morph target {index}");
            add(accessors, target.positions, weight, &mut mesh.positions).map_err(|fault| fault.within(place))?;
            add(accessors, target.normals, weight, &mut mesh.normals).map_err(|fault| fault.within(place))?;
        }
    }
    Ok(())
}

fn targets(primitive: &Primitive) -> impl Iterator<Item = &MorphTarget> {
    primitive.targets.iter().flatten()
}

fn add(accessors: &Accessors, deltas: Option<Index<Accessor>>, weight: f32, base: &mut [Vec3]) -> Outcome<()> {
    let Some(deltas) = deltas.filter(|_| !base.is_empty()) else { return Ok(()) };
    let deltas = same_count(accessors, deltas, base.len())?;
    for (base, delta) in base.iter_mut().zip(deltas) {
        *base += delta * weight;
    }
    Ok(())
}

/// Reads one vector a vertex. The count is compared first, so that a wrong one costs no memory.
pub(super) fn same_count(accessors: &Accessors, index: Index<Accessor>, vertices: usize) -> Outcome<Vec<Vec3>> {
    let count = accessors.count(index)?;
    if count != vertices as u64 {
        return broken(format!("accessor {index} has {count} elements, but there are {vertices} positions"));
    }
    Ok(accessors.vectors::<3>(index, Allowed::Quantized)?.into_iter().map(Vec3::from_array).collect())
}

/// Reads the displacements of targets whose weights are animated. `mesh` has unit normals already; `normals` are those of the file,
/// empty if it has none.
pub(super) fn moving(
    accessors: &Accessors,
    primitive: &Primitive,
    weights: &Weights,
    (mesh, normals): (&Mesh, &[Vec3]),
) -> Outcome<Vec<Moving>> {
    let moves = targets(primitive).enumerate().filter(|(index, _)| weights.moves.get(*index) == Some(&true));
    let (mut all, mut count) = (Vec::new(), 0);
    for (index, target) in moves {
        let displacements = displacements(accessors, target, (mesh, normals));
        let displacements = displacements.map_err(|fault| fault.within(|| format!("morph target {index}")))?;
        // Checked here too: the displacements of one primitive alone could fill the memory.
        count += displacements.len();
        check_displacements(count)?;
        // A target that displaces nothing costs nothing.
        if !displacements.is_empty() {
            all.push((index, displacements));
        }
    }
    Ok(all)
}

fn displacements(
    accessors: &Accessors,
    target: &MorphTarget,
    (mesh, normals): (&Mesh, &[Vec3]),
) -> Outcome<Vec<Displacement>> {
    let vertices = mesh.positions.len();
    let read = |index: Option<Index<Accessor>>, name: &str| match index {
        Some(index) => same_count(accessors, index, vertices).map_err(|fault: Fault| fault.within(|| name.into())),
        None => Ok(vec![Vec3::ZERO; vertices]),
    };
    let positions = read(target.positions, "POSITION")?;
    let turns = match normals.is_empty() {
        true => {
            // Each target goes over all triangles: a small file can have many targets and many indices.
            accessors.spend(NORMAL_COST * (mesh.indices.len() + vertices) as u64)?;
            computed(mesh, &positions)
        }
        false => read(target.normals, "NORMAL")?,
    };
    let mut displacements = Vec::new();
    for (vertex, (position, normal)) in positions.into_iter().zip(turns).enumerate() {
        if !(position.is_finite() && normal.is_finite()) {
            return broken(format!("the displacement of vertex {vertex} is not finite"));
        }
        // The normal at rest was divided by its length. The displacement is divided by the same length.
        let length = normals.get(vertex).map_or(1.0, |normal| normal.length());
        let normal = if length.is_normal() { normal / length } else { normal };
        if position != Vec3::ZERO || normal != Vec3::ZERO {
            // Vertices are counted in 32 bits.
            displacements.push(Displacement { vertex: vertex as u32, position, normal });
        }
    }
    Ok(displacements)
}

/// For a mesh without normals of its own: the change of its computed normals when its vertices are displaced.
fn computed(mesh: &Mesh, displacements: &[Vec3]) -> Vec<Vec3> {
    let displaced = mesh.positions.iter().zip(displacements).map(|(position, by)| *position + *by);
    let mut whole = Mesh {
        topology: mesh.topology,
        positions: displaced.collect(),
        indices: mesh.indices.clone(),
        ..Mesh::default()
    };
    normals::complete(&mut whole);
    whole.normals.iter().zip(&mesh.normals).map(|(there, here)| *there - *here).collect()
}
