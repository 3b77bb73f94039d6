//! From a scene's data to the GPU's: order, compression, outward rounding.

use super::order::{order, Placed};
use super::variants::Variants;
use super::{split, Range, Shading, World};
use engine::{Faces, Primitives, Surface};
use glam::{DAffine3, DVec3, Vec3};
use scenes::{Aabb, Mesh, Scene, Topology, Windings, WorldBounds};
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
    /// One-sided objects that can turn inside out.
    pub(super) turning: Vec<Turnable>,
    /// The winding of each object over time.
    pub(super) windings: Windings,
    /// The scene's mesh behind each mesh that objects are drawn from. None for a mesh without triangles.
    pub(super) mesh_sources: Vec<Option<u32>>,
}

/// A one-sided object that can turn inside out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turnable {
    /// Its number in the world.
    pub(super) object: u32,
    /// Its number in the scene.
    pub(super) scene_object: u32,
    /// The mesh that it is drawn from: as it is in the scene, and with its triangles the other way round, for when it is mirrored.
    pub(super) meshes: [u32; 2],
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

/// True if the object is masked and leaves no fragment: its alpha is too low everywhere. `most_alpha` is the largest alpha of its mesh's vertices.
fn is_absent(object: &scenes::Object, mesh: &Mesh, most_alpha: f32, shading: Shading) -> bool {
    // Products that a file means to equal the cutoff differ by the rounding of f32.
    const MEANT_EQUAL: f64 = 1.0 / (1u32 << 22) as f64;
    let (alpha, cutoff) = (f64::from(object.colour[3]), f64::from(object.surface.cutoff));
    let too_low = match is_cut_out(object, mesh, shading) {
        // A texel has alpha 1 at most.
        true => alpha * f64::from(most_alpha) < cutoff * (1.0 - MEANT_EQUAL),
        false => alpha < cutoff,
    };
    object.masked && !object.translucent && too_low
}

/// The largest alpha of each mesh's vertices.
fn most_alpha(meshes: &[Mesh]) -> Vec<f32> {
    let most = |mesh: &Mesh| mesh.colours.iter().map(|colour| colour[3]).reduce(f32::max).unwrap_or(1.0);
    meshes.iter().map(most).collect()
}

pub(super) fn flatten(scene: &Scene, shading: Shading) -> Flat {
    let mesh_order = mesh_order(scene);
    let (vertices, indices, meshes) = geometry(&scene.meshes, &mesh_order);
    let mut variants = Variants::of(meshes, indices);
    let (windings, joints) = (Windings::new(scene), scene.joints_at(0.0));
    let mut turning = Vec::new();
    let most_alpha = most_alpha(&scene.meshes);
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
        let absent = is_absent(from, &scene.meshes[from.mesh as usize], most_alpha[from.mesh as usize], shading);
        // There are at most 2^24 objects.
        let index = index as u32;
        let drawn_mesh = if absent {
            variants.empty()
        } else if kind_of(from).faces == Faces::Both {
            from.mesh
        } else {
            let mirrored = windings.is_mirrored(*scene_index, &from.world_from_object, &joints);
            let turns = windings.turning().binary_search(scene_index).is_ok();
            let other = if mirrored || turns { variants.turned(from.mesh) } else { from.mesh };
            let meshes = [from.mesh, other];
            if turns {
                turning.push(Turnable { object: index, scene_object: *scene_index, meshes });
            }
            meshes[usize::from(mirrored)]
        };
        object_meshes.push(drawn_mesh);
        scene_meshes.push(from.mesh);
        commands.push(command(variants.meshes[drawn_mesh as usize], index));
    }
    let kinds: Vec<Kind> = scene_object.iter().map(|object| kind_of(&scene.objects[*object as usize])).collect();
    let solid = kinds.iter().filter(|kind| kind.surface != Surface::Translucent).count();
    let Variants { meshes, indices, sources: mesh_sources, .. } = variants;
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
        turning,
        windings,
        mesh_sources,
    }
}

/// The command that draws an object from a mesh.
pub(super) fn command(mesh: MeshRange, object: u32) -> DrawCommand {
    DrawCommand {
        index_count: mesh.index_count,
        instance_count: 1,
        first_index: mesh.first_index,
        vertex_offset: mesh.vertex_offset,
        first_instance: object,
    }
}

/// The order in which the vertices of meshes lie: deformed meshes come behind all others.
fn mesh_order(scene: &Scene) -> Vec<usize> {
    let mut bent = vec![false; scene.meshes.len()];
    scene.deformed.iter().for_each(|deformed| bent[deformed.mesh as usize] = true);
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
        let of = |source: &Option<u32>| {
            source.map_or_else(LocalBox::default, |mesh| local_box(&self.host.bounds.in_object_space(mesh)))
        };
        self.host.mesh_sources.iter().map(of).collect()
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
