//! From a scene's data to the GPU's: order, compression, outward rounding.

use super::order::{order, Placed};
use super::{split, Range};
use engine::Primitives;
use glam::{DAffine3, DVec3, Vec3};
use scenes::{Aabb, Mesh, Scene, Topology, WorldBounds};
use shaders::draw::ObjectsVertex;
use shaders::types::{Bounds, DrawCommand, MeshRange, Object, OBJECT_ALWAYS_KEPT, OBJECT_DYNAMIC, OBJECT_WIDE_RASTER};

/// A scene as the GPU takes it.
pub(super) struct Flat {
    pub(super) vertices: Vec<ObjectsVertex>,
    pub(super) indices: Vec<u32>,
    pub(super) meshes: Vec<MeshRange>,
    pub(super) objects: Vec<Object>,
    pub(super) bounds: Vec<Bounds>,
    pub(super) boxes: Vec<Aabb>,
    pub(super) object_meshes: Vec<u32>,
    pub(super) commands: Vec<DrawCommand>,
    pub(super) ranges: Vec<Range>,
    pub(super) scene_object: Vec<u32>,
    pub(super) world_bounds: WorldBounds,
}

pub(super) fn flatten(scene: &Scene) -> Flat {
    let (vertices, indices, meshes) = geometry(&scene.meshes);
    let world_bounds = WorldBounds::new(scene);
    let placed = |object: &scenes::Object| Placed {
        bounds: world_bounds.of(object.mesh, &object.world_from_object),
        kind: scene.meshes[object.mesh as usize].topology as u32,
        moves: object.dynamic,
    };
    let scene_object = order(&scene.objects.iter().map(placed).collect::<Vec<_>>());
    let (mut objects, mut bounds, mut object_meshes, mut commands) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut boxes = Vec::new();
    for (index, scene_index) in scene_object.iter().enumerate() {
        let from = &scene.objects[*scene_index as usize];
        let wide = scene.meshes[from.mesh as usize].topology != Topology::Triangles;
        let flags = if wide { OBJECT_WIDE_RASTER } else { 0 } | if from.dynamic { OBJECT_DYNAMIC } else { 0 };
        objects.push(object(&from.world_from_object, colour(from.colour)));
        let aabb = world_bounds.of(from.mesh, &from.world_from_object);
        bounds.push(self::bounds(&aabb, &from.world_from_object, flags));
        boxes.push(aabb);
        object_meshes.push(from.mesh);
        let mesh = meshes[from.mesh as usize];
        commands.push(DrawCommand {
            index_count: mesh.index_count,
            instance_count: 1,
            first_index: mesh.first_index,
            vertex_offset: mesh.vertex_offset,
            first_instance: index as u32,
        });
    }
    let ranges =
        ranges(scene_object.iter().map(|object| scene.meshes[scene.objects[*object as usize].mesh as usize].topology));
    Flat {
        vertices,
        indices,
        meshes,
        objects,
        bounds,
        boxes,
        object_meshes,
        commands,
        ranges,
        scene_object,
        world_bounds,
    }
}

fn geometry(meshes: &[Mesh]) -> (Vec<ObjectsVertex>, Vec<u32>, Vec<MeshRange>) {
    let (mut vertices, mut indices, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
    for mesh in meshes {
        ranges.push(MeshRange {
            first_index: indices.len() as u32,
            index_count: mesh.indices.len() as u32,
            vertex_offset: vertices.len() as i32,
        });
        let vertex = |(position, normal): (&Vec3, &Vec3)| ObjectsVertex {
            position: position.to_array(),
            normal_snorm16: octahedron(*normal),
        };
        vertices.extend(mesh.positions.iter().zip(&mesh.normals).map(vertex));
        indices.extend_from_slice(&mesh.indices);
    }
    (vertices, indices, ranges)
}

fn ranges(topologies: impl Iterator<Item = Topology>) -> Vec<Range> {
    let mut ranges: Vec<Range> = Vec::new();
    for (index, topology) in topologies.enumerate() {
        let primitives = match topology {
            Topology::Triangles => Primitives::Triangles,
            Topology::Lines => Primitives::Lines,
            Topology::Points => Primitives::Points,
        };
        match ranges.last_mut() {
            Some(last) if last.primitives == primitives => last.count += 1,
            _ => ranges.push(Range { first: index as u32, count: 1, primitives }),
        }
    }
    ranges
}

/// The place of each scene object in the world's order.
pub(super) fn inverse(scene_object: &[u32]) -> Vec<u32> {
    let mut object_of_scene = vec![0; scene_object.len()];
    for (index, scene_index) in scene_object.iter().enumerate() {
        object_of_scene[*scene_index as usize] = index as u32;
    }
    object_of_scene
}

/// An object's transform and colour.
pub(super) fn object(world_from_object: &DAffine3, colour: u32) -> Object {
    let linear = world_from_object.matrix3;
    let (origin_high, origin_low) = split(world_from_object.translation);
    Object {
        column_x: linear.x_axis.as_vec3().to_array(),
        column_y: linear.y_axis.as_vec3().to_array(),
        column_z: linear.z_axis.as_vec3().to_array(),
        origin_high,
        origin_low,
        colour,
    }
}

/// What splitting a position in two floats and subtracting the parts can lose: each of centre, origin and their two fine
/// differences at most 2^-48 of its size, eight of them rounded up to a power of two.
const SPLIT_ERROR: f64 = 1.0 / (1u64 << 45) as f64;

/// Bounds as the GPU takes them, rounded outward; bounds that are not finite in f32 are flagged to be kept always.
pub fn bounds(box_: &Aabb, world_from_object: &DAffine3, flags: u32) -> Bounds {
    let centre = box_.centre();
    let pad = SPLIT_ERROR * (centre.abs() + world_from_object.translation.abs());
    // The box is measured from the centre as the GPU has it, so that the split's own rounding is inside too.
    let (centre_high, centre_low) = split(centre);
    let split_centre = Vec3::from(centre_high).as_dvec3() + Vec3::from(centre_low).as_dvec3();
    let half = (box_.max - split_centre).max(split_centre - box_.min) + pad;
    let half_extent = round_up(half);
    let reach = half_extent.abs() + Vec3::from(centre_high).abs() + Vec3::from(centre_low).abs();
    let usable = reach.is_finite() && reach.max_element() < MOST_REACH;
    if !usable {
        return Bounds { flags: flags | OBJECT_ALWAYS_KEPT, ..Bounds::default() };
    }
    Bounds { centre_high, centre_low, half_extent: half_extent.to_array(), flags }
}

/// Bounds that reach farther, in metres, are not tested: products with the matrix and sums over axes could leave what f32 holds.
/// 10^18 m leaves a factor of 10^20 for both.
const MOST_REACH: f32 = 1.0e18;

fn round_up(value: DVec3) -> Vec3 {
    let one = |value: f64| {
        let rounded = value as f32;
        if f64::from(rounded) < value {
            rounded.next_up()
        } else {
            rounded
        }
    };
    Vec3::new(one(value.x), one(value.y), one(value.z))
}

fn colour(linear: [f32; 4]) -> u32 {
    u32::from_le_bytes(linear.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8))
}

/// A unit normal folded onto an octahedron, as two signed 16-bit fractions.
fn octahedron(normal: Vec3) -> [i16; 2] {
    let sum = normal.x.abs() + normal.y.abs() + normal.z.abs();
    let (mut x, mut y) = if sum > 0.0 { (normal.x / sum, normal.y / sum) } else { (0.0, 0.0) };
    if normal.z < 0.0 {
        (x, y) = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
    }
    [x, y].map(|part| (part.clamp(-1.0, 1.0) * 32767.0).round() as i16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_hold_their_box_a_million_metres_out() {
        let box_ = Aabb { min: DVec3::new(1e6, -3.0, 0.1), max: DVec3::new(1e6 + 0.25, 4.0, 0.3) };
        let gpu = bounds(&box_, &DAffine3::IDENTITY, 0);
        for axis in 0..3 {
            let centre = f64::from(gpu.centre_high[axis]) + f64::from(gpu.centre_low[axis]);
            let half = f64::from(gpu.half_extent[axis]);
            assert!(centre - half <= box_.min[axis] && centre + half >= box_.max[axis], "axis {axis}");
            assert!(
                half < (box_.max[axis] - box_.min[axis]) * 0.5 + 1e-6,
                "axis {axis} is not padded beyond need: {half}"
            );
        }
    }

    #[test]
    fn bounds_too_large_for_floats_are_always_kept() {
        for reach in [2e18, 3e38, 1e40] {
            let box_ = Aabb { min: DVec3::splat(-reach), max: DVec3::splat(reach) };
            assert_eq!(bounds(&box_, &DAffine3::IDENTITY, 0).flags, OBJECT_ALWAYS_KEPT, "{reach}");
        }
        let box_ = Aabb { min: DVec3::splat(-1e17), max: DVec3::splat(1e17) };
        assert_eq!(bounds(&box_, &DAffine3::IDENTITY, 0).flags, 0);
    }

    #[test]
    fn ranges_follow_topology() {
        let mixed = [Topology::Triangles, Topology::Triangles, Topology::Points];
        let found = ranges(mixed.into_iter());
        assert_eq!(found[0], Range { first: 0, count: 2, primitives: Primitives::Triangles });
        assert_eq!(found[1], Range { first: 2, count: 1, primitives: Primitives::Points });
    }
}
