//! The world's stages in plain Rust: their definition.

use super::upload::octahedron;
use glam::Vec3;
use shaders::draw::ObjectsVertex;
use shaders::types::{Bounds, JointPlace, MovedObject, MovedTransform, Object, RestVertex};

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

/// Where joints put a vertex. Twin of `world/skin_vertices`: positions to the bit where a device rounds as IEEE 754 says and keeps numbers below f32's smallest normal one; normals
/// within a few steps, as a device may round divisions as it likes.
pub fn skin_vertex(vertex: &RestVertex, places: &[JointPlace]) -> ObjectsVertex {
    let [a, b, c, d] = vertex.joints.map(|joint| &places[joint as usize]);
    let [wa, wb, wc, wd] = vertex.weights;
    let mean = |of: fn(&JointPlace) -> [f32; 3]| {
        let of = |place: &JointPlace| Vec3::from(of(place));
        of(a) * wa + of(b) * wb + of(c) * wc + of(d) * wd
    };
    let (x, y, z) = (mean(|place| place.column_x), mean(|place| place.column_y), mean(|place| place.column_z));
    let shift = mean(|place| place.shift);
    let ([px, py, pz], [nx, ny, nz]) = (vertex.position, vertex.normal);
    let position = x * px + y * py + z * pz + shift;
    let normal = y.cross(z) * nx + z.cross(x) * ny + x.cross(y) * nz;
    ObjectsVertex { position: position.to_array(), normal_snorm16: octahedron(normal) }
}

/// The same of many.
pub fn skin_vertices(rest: &[RestVertex], places: &[JointPlace]) -> Vec<ObjectsVertex> {
    rest.iter().map(|vertex| skin_vertex(vertex, places)).collect()
}
