//! The world's stages in plain Rust: their definition.

use super::upload::octahedron;
use glam::Vec3;
use shaders::draw::ObjectsVertex;
use shaders::types::{
    Bounds, Displacement, DrawCommand, Influence, JointPlace, MeshRange, MovedObject, MovedTransform, Object,
    RestVertex, TurnedObject,
};

/// Puts each moved object in its place. Twin of `world/move_objects`.
pub fn move_objects(moves: &[MovedObject], objects: &mut [Object], bounds: &mut [Bounds]) {
    for moved in moves {
        objects[moved.index as usize] = moved.object;
        bounds[moved.index as usize] = moved.bounds;
    }
}

/// Puts each moved object in its place, whose bounds stay. Twin of `world/move_transforms`.
pub fn move_transforms(moves: &[MovedTransform], objects: &mut [Object]) {
    for moved in moves {
        objects[moved.index as usize] = moved.object;
    }
}

/// Gives objects the index ranges of their meshes of this frame. Twin of `world/turn_objects`.
pub fn turn_objects(
    turned: &[TurnedObject],
    meshes: &[MeshRange],
    object_meshes: &mut [u32],
    all_commands: &mut [DrawCommand],
) {
    for now in turned {
        object_meshes[now.object as usize] = now.mesh;
        all_commands[now.object as usize].first_index = meshes[now.mesh as usize].first_index;
    }
}

/// The buffers that deform meshes, as `world/skin_vertices` reads them.
#[derive(Clone, Debug, Default)]
pub struct Deformers {
    /// Vertices at rest.
    pub rest: Vec<RestVertex>,
    /// Joints that carry them.
    pub influences: Vec<Influence>,
    /// Displacements of them by morph targets.
    pub displacements: Vec<Displacement>,
    /// Where joints are.
    pub places: Vec<JointPlace>,
    /// Weights of morph targets.
    pub weights: Vec<f32>,
}

impl Deformers {
    fn displacements_of(&self, vertex: &RestVertex) -> &[Displacement] {
        &self.displacements[vertex.first_displacement as usize..][..vertex.displacement_count as usize]
    }

    fn influences_of(&self, vertex: &RestVertex) -> &[Influence] {
        &self.influences[vertex.first_influence as usize..][..vertex.influence_count as usize]
    }

    /// Deforms a vertex by morph targets, then by joints. Twin of `world/skin_vertices`. Positions agree to the bit where a device
    /// rounds as IEEE 754 says and keeps numbers below f32's smallest normal one. Normals agree within a few steps, as a device may
    /// round divisions as it likes.
    pub fn skin_vertex(&self, vertex: &RestVertex) -> ObjectsVertex {
        let (mut position, mut normal) = (Vec3::from(vertex.position), Vec3::from(vertex.normal));
        for displacement in self.displacements_of(vertex) {
            let weight = self.weights[displacement.weight as usize];
            position += Vec3::from(displacement.position) * weight;
            normal += Vec3::from(displacement.normal) * weight;
        }
        if vertex.influence_count > 0 {
            let mean = |of: fn(&JointPlace) -> [f32; 3]| {
                let carried = self.influences_of(vertex).iter();
                let part = |carried: &Influence| Vec3::from(of(&self.places[carried.place as usize])) * carried.share;
                carried.map(part).fold(Vec3::ZERO, |sum, part| sum + part)
            };
            let (x, y, z) = (mean(|place| place.column_x), mean(|place| place.column_y), mean(|place| place.column_z));
            position = x * position.x + y * position.y + z * position.z + mean(|place| place.shift);
            normal = y.cross(z) * normal.x + z.cross(x) * normal.y + x.cross(y) * normal.z;
        }
        ObjectsVertex { position: position.to_array(), normal_snorm16: octahedron(normal) }
    }

    /// Deforms all vertices.
    pub fn skin_vertices(&self) -> Vec<ObjectsVertex> {
        self.rest.iter().map(|vertex| self.skin_vertex(vertex)).collect()
    }
}
