//! Deformed meshes: morph targets displace their vertices, a skeleton bends them, or both.
//!
//! A morph target displaces some vertices of a mesh; an animated weight is the factor of its displacements (glTF 2.0, section 3.7.2.2).
//! A vertex at a time is its position at rest plus the sum of weight x displacement. Weights may be negative or larger than 1. A skin
//! bends the sum (section 3.7.3). The import adds targets whose weight never changes to the mesh at rest.
//!
//! [`Scene::meshes`](crate::Scene::meshes) has each deformed mesh in its shape of time 0, with a declared box that holds its shape at
//! every time. So code without knowledge of deformation is right at time 0, and has bounds that always hold. Code that draws other
//! times deforms [`Deformed::rest`] by [`Shapes`].

use crate::skin::{cofactors, mean_place, JointPlaces, RestVertex};
use glam::{DAffine3, DVec3, Vec3};

/// Most targets that may move one mesh. The device loops over the targets of a vertex, and some drivers end a loop at 65,535 turns.
pub const MOST_TARGETS: usize = 1 << 15;

/// A mesh whose vertices move within its object.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformed {
    /// Index into [`Scene::meshes`](crate::Scene::meshes). Every object of the mesh hangs on a node of the animation; where there is a
    /// skin, exactly on its anchor.
    pub mesh: u32,
    /// Index into [`Scene::skins`](crate::Scene::skins) of the skeleton that bends it; none if only morph targets deform it.
    pub skin: Option<u32>,
    /// Its vertices at rest.
    pub rest: Vec<RestVertex>,
    /// Morph targets, which displace the vertices before the skeleton bends them.
    pub targets: Vec<MorphTarget>,
}

/// A morph target whose weight is animated.
#[derive(Clone, Debug, PartialEq)]
pub struct MorphTarget {
    /// Index into [`NodeAnimation::weights`](crate::animation::NodeAnimation::weights).
    pub weight: u32,
    /// The vertices that it displaces, ascending; a vertex that stays where it is need not be listed.
    pub displacements: Vec<Displacement>,
}

/// A morph target's effect on one vertex, at weight 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement {
    /// Index of the vertex in its mesh.
    pub vertex: u32,
    /// Added to its position at rest.
    pub position: Vec3,
    /// Added to its normal at rest.
    pub normal: Vec3,
}

/// The joints and weights that shape deformed meshes at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shapes {
    /// Places of joints.
    pub joints: JointPlaces,
    /// Weights, in the order of [`NodeAnimation::weights`](crate::animation::NodeAnimation::weights).
    pub weights: Vec<f64>,
}

impl Deformed {
    /// Returns its vertices and their normals in object space, in `f64`. Normals have any length.
    pub(crate) fn vertices<'a>(&'a self, shapes: &'a Shapes) -> impl Iterator<Item = (DVec3, DVec3)> + 'a {
        let places = self.skin.map(|skin| shapes.joints.of(skin));
        let morphed = self.morphed(&shapes.weights);
        morphed.into_iter().zip(&self.rest).map(move |(morphed, vertex)| match places {
            Some(places) => bent(vertex, morphed, places),
            None => morphed,
        })
    }

    /// Returns its vertices and their normals after morph targets of these weights have displaced them.
    fn morphed(&self, weights: &[f64]) -> Vec<(DVec3, DVec3)> {
        let rest = self.rest.iter().map(|vertex| (vertex.position.as_dvec3(), vertex.normal.as_dvec3()));
        let mut vertices: Vec<(DVec3, DVec3)> = rest.collect();
        for target in &self.targets {
            let weight = weights[target.weight as usize];
            for displaced in &target.displacements {
                let (position, normal) = &mut vertices[displaced.vertex as usize];
                *position += displaced.position.as_dvec3() * weight;
                *normal += displaced.normal.as_dvec3() * weight;
            }
        }
        vertices
    }
}

/// Bends a displaced vertex by joints in these places.
fn bent(vertex: &RestVertex, (position, normal): (DVec3, DVec3), places: &[DAffine3]) -> (DVec3, DVec3) {
    let mean = mean_place(vertex, places);
    (mean.transform_point3(position), cofactors(mean.matrix3) * normal)
}
