//! From a scene's data to the GPU's: order, compression, outward rounding.

use super::order::{order, Placed};
use super::{split, Range, Shading, World};
use engine::{Faces, Primitives, Surface};
use glam::{DAffine3, DVec3, Vec3};
use scenes::{Aabb, Mesh, Scene, Topology, WorldBounds};
use shaders::draw::ObjectsVertex;
use shaders::types::{
    Bounds, DrawCommand, LocalBox, MeshRange, Object, OBJECT_ALWAYS_KEPT, OBJECT_DYNAMIC, OBJECT_WIDE_RASTER,
};

/// A scene as the GPU takes it.
pub(super) struct Flat {
    pub(super) vertices: Vec<ObjectsVertex>,
    pub(super) indices: Vec<u32>,
    pub(super) meshes: Vec<MeshRange>,
    pub(super) objects: Vec<Object>,
    pub(super) bounds: Vec<Bounds>,
    pub(super) boxes: Vec<Aabb>,
    /// By object: what it is drawn from, and its mesh in the scene, which may be wound the other way round.
    pub(super) object_meshes: Vec<u32>,
    pub(super) scene_meshes: Vec<u32>,
    pub(super) commands: Vec<DrawCommand>,
    /// Without those of translucent objects.
    pub(super) ranges: Vec<Range>,
    /// How each translucent object is drawn, as ranges of none.
    pub(super) translucent_kinds: Vec<Range>,
    /// Objects before the translucent ones.
    pub(super) solid: usize,
    pub(super) scene_object: Vec<u32>,
    pub(super) world_bounds: WorldBounds,
    /// Meshes in the order in which their vertices and indices lie.
    pub(super) mesh_order: Vec<usize>,
}

/// How an object is drawn. In this order: translucent ones last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    pub(super) primitives: Primitives,
    pub(super) faces: Faces,
    pub(super) surface: Surface,
}

impl Kind {
    fn of(object: &scenes::Object, mesh: &Mesh, shading: Shading) -> Self {
        let primitives = match mesh.topology {
            Topology::Triangles => Primitives::Triangles,
            Topology::Lines => Primitives::Lines,
            Topology::Points => Primitives::Points,
        };
        let one_sided = object.surface.single_sided && primitives == Primitives::Triangles;
        let surface = match (object.translucent, is_cut_out(object, mesh, shading)) {
            (true, _) => Surface::Translucent,
            (false, true) => Surface::Masked,
            (false, false) => Surface::Opaque,
        };
        Kind { primitives, faces: if one_sided { Faces::Front } else { Faces::Both }, surface }
    }

    fn range(self, first: u32, count: u32) -> Range {
        Range { first, count, primitives: self.primitives, faces: self.faces, surface: self.surface }
    }

    fn order(self) -> u32 {
        let translucent = self.surface == Surface::Translucent;
        let masked = self.surface == Surface::Masked;
        u32::from(translucent) << 4
            | (self.primitives as u32) << 2
            | u32::from(masked) << 1
            | u32::from(self.faces == Faces::Front)
    }
}

/// Masked, by an alpha that is not the same everywhere.
fn is_cut_out(object: &scenes::Object, mesh: &Mesh, shading: Shading) -> bool {
    shading == Shading::Textured && object.masked && (object.surface.texture.is_some() || !mesh.colours.is_empty())
}

/// Masked, and of one alpha that is not enough: not there at all.
fn is_absent(object: &scenes::Object, mesh: &Mesh, shading: Shading) -> bool {
    object.masked
        && !object.translucent
        && !is_cut_out(object, mesh, shading)
        && object.colour[3] < object.surface.cutoff
}

/// The meshes that objects are drawn from: those of the scene, and what mirrored and absent objects need beside them.
struct Variants {
    meshes: Vec<MeshRange>,
    indices: Vec<u32>,
    turned: std::collections::HashMap<u32, u32>,
    empty: Option<u32>,
}

impl Variants {
    /// The mesh for an object. A mirrored transform turns triangles round on the screen, so that those of one side are wound the
    /// other way round first.
    fn mesh_of(&mut self, object: &scenes::Object, kind: Kind, absent: bool) -> u32 {
        let mesh = object.mesh;
        if absent {
            return *self.empty.get_or_insert_with(|| add(&mut self.meshes, MeshRange::default()));
        }
        if kind.faces == Faces::Both || object.world_from_object.matrix3.determinant() >= 0.0 {
            return mesh;
        }
        if let Some(turned) = self.turned.get(&mesh) {
            return *turned;
        }
        let range = self.meshes[mesh as usize];
        let first_index = self.indices.len() as u32;
        for corner in (0..range.index_count as usize).step_by(3).map(|first| range.first_index as usize + first) {
            let [a, b, c] = [0, 1, 2].map(|side| self.indices[corner + side]);
            self.indices.extend([a, c, b]);
        }
        let turned = add(&mut self.meshes, MeshRange { first_index, ..range });
        self.turned.insert(mesh, turned);
        turned
    }
}

fn add(meshes: &mut Vec<MeshRange>, mesh: MeshRange) -> u32 {
    meshes.push(mesh);
    // At most three for each of the scene's.
    (meshes.len() - 1) as u32
}

pub(super) fn flatten(scene: &Scene, shading: Shading) -> Flat {
    let mesh_order = mesh_order(scene);
    let (vertices, indices, meshes) = geometry(&scene.meshes, &mesh_order);
    let mut variants = Variants { meshes, indices, turned: Default::default(), empty: None };
    let kind_of = |object: &scenes::Object| Kind::of(object, &scene.meshes[object.mesh as usize], shading);
    let world_bounds = WorldBounds::new(scene);
    let placed = |object: &scenes::Object| Placed {
        bounds: world_bounds.of(object.mesh, &object.world_from_object),
        kind: kind_of(object).order(),
        moves: object.dynamic,
    };
    let scene_object = order(&scene.objects.iter().map(placed).collect::<Vec<_>>());
    let (mut objects, mut bounds, mut object_meshes, mut commands) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut boxes, mut scene_meshes) = (Vec::new(), Vec::new());
    for (index, scene_index) in scene_object.iter().enumerate() {
        let from = &scene.objects[*scene_index as usize];
        let wide = scene.meshes[from.mesh as usize].topology != Topology::Triangles;
        let flags = if wide { OBJECT_WIDE_RASTER } else { 0 } | if from.dynamic { OBJECT_DYNAMIC } else { 0 };
        objects.push(object(&from.world_from_object, colour(from.colour)));
        let aabb = world_bounds.of(from.mesh, &from.world_from_object);
        bounds.push(self::bounds(&aabb, &from.world_from_object, flags));
        boxes.push(aabb);
        let absent = is_absent(from, &scene.meshes[from.mesh as usize], shading);
        let drawn_mesh = variants.mesh_of(from, kind_of(from), absent);
        object_meshes.push(drawn_mesh);
        scene_meshes.push(from.mesh);
        let mesh = variants.meshes[drawn_mesh as usize];
        commands.push(DrawCommand {
            index_count: mesh.index_count,
            instance_count: 1,
            first_index: mesh.first_index,
            vertex_offset: mesh.vertex_offset,
            first_instance: index as u32,
        });
    }
    let kinds: Vec<Kind> = scene_object.iter().map(|object| kind_of(&scene.objects[*object as usize])).collect();
    let solid = kinds.iter().filter(|kind| kind.surface != Surface::Translucent).count();
    let Variants { meshes, indices, .. } = variants;
    Flat {
        vertices,
        indices,
        meshes,
        objects,
        bounds,
        boxes,
        object_meshes,
        scene_meshes,
        commands,
        ranges: ranges(&kinds[..solid]),
        translucent_kinds: kinds[solid..].iter().map(|kind| kind.range(0, 0)).collect(),
        solid,
        scene_object,
        world_bounds,
        mesh_order,
    }
}

/// The order in which the vertices of meshes lie: those that skeletons bend behind all others.
fn mesh_order(scene: &Scene) -> Vec<usize> {
    let mut bent = vec![false; scene.meshes.len()];
    scene.skinned.iter().for_each(|skinned| bent[scene.objects[skinned.object as usize].mesh as usize] = true);
    let mut order: Vec<usize> = (0..bent.len()).collect();
    order.sort_by_key(|mesh| bent[*mesh]);
    order
}

fn geometry(meshes: &[Mesh], order: &[usize]) -> (Vec<ObjectsVertex>, Vec<u32>, Vec<MeshRange>) {
    let (mut vertices, mut indices, mut ranges) = (Vec::new(), Vec::new(), vec![MeshRange::default(); meshes.len()]);
    for (mesh, range) in order.iter().map(|mesh| (&meshes[*mesh], *mesh)) {
        ranges[range] = MeshRange {
            first_index: indices.len() as u32,
            index_count: mesh.indices.len() as u32,
            vertex_offset: vertices.len() as i32,
        };
        let vertex = |(position, normal): (&Vec3, &Vec3)| ObjectsVertex {
            position: position.to_array(),
            normal_snorm16: octahedron(*normal),
        };
        vertices.extend(mesh.positions.iter().zip(&mesh.normals).map(vertex));
        indices.extend_from_slice(&mesh.indices);
    }
    (vertices, indices, ranges)
}

fn ranges(kinds: &[Kind]) -> Vec<Range> {
    let mut ranges: Vec<Range> = Vec::new();
    for (index, kind) in kinds.iter().enumerate() {
        match ranges.last_mut() {
            Some(last) if *last == kind.range(last.first, last.count) => last.count += 1,
            _ => ranges.push(kind.range(index as u32, 1)),
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

impl World {
    /// The box of each mesh in object space, by the numbers of [`World::object_meshes`].
    pub fn local_boxes(&self) -> Vec<LocalBox> {
        let mut boxes = vec![LocalBox::default(); self.host.meshes.len()];
        for (drawn, mesh) in self.host.object_meshes.iter().zip(&self.host.scene_meshes) {
            boxes[*drawn as usize] = local_box(&self.host.bounds.in_object_space(*mesh));
        }
        boxes
    }
}

/// The box of a mesh in object space, rounded outward.
fn local_box(box_: &Aabb) -> LocalBox {
    let centre = box_.centre().as_vec3();
    let half = (box_.max - centre.as_dvec3()).max(centre.as_dvec3() - box_.min);
    LocalBox { centre: centre.to_array(), half_extent: round_up(half).to_array() }
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
pub(super) fn octahedron(normal: Vec3) -> [i16; 2] {
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
    fn ranges_follow_kinds() {
        let kind = |primitives, faces| Kind { primitives, faces, surface: Surface::Opaque };
        let (triangles, points) = (kind(Primitives::Triangles, Faces::Both), kind(Primitives::Points, Faces::Both));
        let found = ranges(&[triangles, triangles, kind(Primitives::Triangles, Faces::Front), points]);
        assert_eq!(found.iter().map(|range| (range.first, range.count)).collect::<Vec<_>>(), [(0, 2), (2, 1), (3, 1)]);
        assert_eq!(found[2].primitives, Primitives::Points);
        assert!(triangles.order() < kind(Primitives::Triangles, Faces::Front).order());
    }
}
