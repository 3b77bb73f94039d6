//! A scene on the GPU: vertices, indices, objects, bounds, and what moves them.

mod blocks;
mod detail;
mod drawn;
mod draws;
mod moving;
mod order;
mod read;
mod several;
mod skins;
mod solids;
mod still;
mod ties;
mod turning;
pub mod twin;
mod upload;
mod variants;
mod view;

pub use blocks::{listed as listed_blocks, unlisted as unlisted_blocks};
pub use drawn::{draw_lists, drawn_by, drawn_objects, Drawn};
pub use several::BoxesOfMeshes;
pub use solids::Solid;
pub use still::{Still, DETAIL_OPTION, SKIP_OPTION};
pub use ties::LastToFirst;
pub use upload::bounds as gpu_bounds;
pub use view::{split, View};

use crate::Result;
use blocks::Blocks;
use detail::Detail;
use engine::{Buffer, Faces, Frame, Gpu, Placement, Primitives, Surface};
use glam::DAffine3;
use moving::Moving;
use scenes::{Cells, MovingBounds, Scene, WorldBounds};
use shaders::draw::ObjectsVertex;
use shaders::types::{Bounds, DrawCommand, MeshRange, Object};
use shaders::{draw, frustum, BufferRef, ResourceId, Stage};
use skins::Deformation;
use turning::Turning;

/// What of a scene's materials is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// Each object in one colour, Lambert-shaded. What is masked is there as a whole, or not at all: by its colour's alpha.
    Lambert,
    /// Base colour textures and vertex colours too.
    Textured,
}

impl Shading {
    /// What a scene has.
    pub fn of(scene: &Scene) -> Self {
        if scene.has_textures() {
            Shading::Textured
        } else {
            Shading::Lambert
        }
    }

    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Shading::Lambert => "lambert",
            Shading::Textured => "textured",
        }
    }
}

/// Objects that lie side by side and are drawn in the same way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range {
    /// First object.
    pub first: u32,
    /// Objects, > 0.
    pub count: u32,
    /// Their primitives.
    pub primitives: Primitives,
    /// Which sides of them show.
    pub faces: Faces,
    /// What they do to what lies behind them.
    pub surface: Surface,
}

/// A scene on the GPU. Translucent objects come last, after all that methods cull; see [`crate::translucent`]. Triangles come before lines and lines before points, masked ones after opaque
/// ones, those with one side after those with two, what moves after what stays; beyond that objects keep the
/// scene's order, unless that puts far from each other what lies near each other: then they lie along a curve through space.
pub struct World {
    vertices: Buffer<ObjectsVertex>,
    indices: Buffer<u32>,
    meshes: Buffer<MeshRange>,
    objects: Buffer<Object>,
    bounds: Buffer<Bounds>,
    object_meshes: Buffer<u32>,
    all_commands: Buffer<DrawCommand>,
    moving: Option<Moving>,
    /// None if no mesh is deformed.
    deformation: Option<Deformation>,
    /// None if no object can turn inside out.
    turning: Option<Turning>,
    blocks: Blocks,
    ranges: Vec<Range>,
    /// Materials; none if each object has one colour.
    detail: Option<Detail>,
    host: Host,
}

/// What the host keeps of the scene.
struct Host {
    scene_object: Vec<u32>,
    object_of_scene: Vec<u32>,
    bounds: WorldBounds,
    boxes: Vec<scenes::Aabb>,
    object_meshes: Vec<u32>,
    /// What is solid of buildings.
    solids: Vec<Solid>,
    several: several::Several,
    cells: Option<Cells>,
    /// By object: its mesh in the scene.
    scene_meshes: Vec<u32>,
    /// The scene's mesh behind each mesh that objects are drawn from.
    mesh_sources: Vec<Option<u32>>,
    /// Objects before the translucent ones.
    solid: usize,
    /// How each of the translucent ones is drawn.
    translucent_kinds: Vec<Range>,
    /// Those of `transforms` that move objects before the translucent ones.
    solid_moves: Vec<usize>,
    meshes: Vec<MeshRange>,
    indices: Vec<u32>,
    objects: Vec<Object>,
    flags: Vec<u32>,
    transforms: Vec<(u32, DAffine3)>,
    seconds: Option<f64>,
    revision: u64,
    bounds_revision: u64,
    triangles: u64,
}

impl World {
    /// Uploads a scene at time 0, to be shaded as what it has.
    ///
    /// # Errors
    /// A scene that is broken or too large, or a device without room for it.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self> {
        Self::shaded(gpu, scene, Shading::of(scene))
    }

    /// Uploads a scene at time 0, to be shaded in a way of one's choice.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn shaded(gpu: &Gpu, scene: &Scene, shading: Shading) -> Result<Self> {
        Self::with_bounds(gpu, scene, shading, MovingBounds::default())
    }

    /// The same, with the bounds of what moves had in a way of one's choice.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn with_bounds(gpu: &Gpu, scene: &Scene, shading: Shading, of_moving: MovingBounds) -> Result<Self> {
        scene.check()?;
        let mut flat = upload::flatten(scene, shading);
        let storage = Placement::Storage;
        let object_of_scene = upload::inverse(&flat.scene_object);
        let moving_objects: Vec<u32> =
            scene.motion.dynamic_objects().iter().map(|object| object_of_scene[*object as usize]).collect();
        let solid = flat.solid;
        let detail = match shading {
            Shading::Lambert => None,
            Shading::Textured => Some(Detail::new(gpu, scene, &flat)?),
        };
        let still_or_solid = |object: &&u32| (**object as usize) < solid;
        let solid_moving: Vec<u32> = moving_objects.iter().filter(still_or_solid).copied().collect();
        let mut transforms = Vec::new();
        scene.motion.transforms_at(0.0, &mut transforms);
        let moving = Moving::new(gpu, scene, (&mut flat, &object_of_scene), of_moving, &transforms)?;
        let deformation = Deformation::new(gpu, scene, &flat, &object_of_scene)?;
        Ok(World {
            vertices: Buffer::with_data(gpu, "world.vertices", &flat.vertices, Placement::Geometry)?,
            indices: Buffer::with_data(gpu, "world.indices", &flat.indices, Placement::Geometry)?,
            meshes: Buffer::with_data(gpu, "world.meshes", &flat.meshes, storage)?,
            objects: Buffer::with_data(gpu, "world.objects", &flat.objects, storage)?,
            bounds: Buffer::with_data(gpu, "world.bounds", &flat.bounds, storage)?,
            object_meshes: Buffer::with_data(gpu, "world.object_meshes", &flat.object_meshes, storage)?,
            all_commands: Buffer::with_data(gpu, "world.all_commands", &flat.commands, storage)?,
            moving,
            deformation,
            turning: Turning::new(gpu, flat.windings, flat.turning)?,
            blocks: Blocks::new(gpu, &flat.bounds[..solid], &solid_moving)?,
            detail,
            ranges: flat.ranges,
            host: Host {
                scene_object: flat.scene_object,
                bounds: flat.world_bounds,
                boxes: flat.boxes,
                object_meshes: flat.object_meshes,
                scene_meshes: flat.scene_meshes,
                mesh_sources: flat.mesh_sources,
                solid,
                translucent_kinds: flat.translucent_kinds,
                solid_moves: (0..transforms.len())
                    .filter(|at| (object_of_scene[transforms[*at].0 as usize] as usize) < solid)
                    .collect(),
                solids: solids::solids(scene, &object_of_scene),
                several: several::Several::of(scene),
                cells: scene.cells.clone(),
                object_of_scene,
                meshes: flat.meshes,
                indices: flat.indices,
                flags: flat.bounds.iter().map(|bounds| bounds.flags).collect(),
                objects: flat.objects,
                transforms,
                seconds: None,
                revision: 0,
                bounds_revision: 0,
                triangles: scene.triangles(),
            },
        })
    }

    /// Objects that culling methods see: all but the translucent ones, which hide nothing and are drawn last.
    pub fn len(&self) -> usize {
        self.host.solid
    }

    /// All objects, translucent ones too, which come last.
    pub fn total(&self) -> usize {
        self.host.scene_object.len()
    }

    /// True if there is nothing for culling methods to see.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Tells worlds of one device apart: what belongs to one world must not be used with another.
    pub fn id(&self) -> ResourceId {
        self.objects.all().id
    }

    /// Triangles of all objects, instances counted apart.
    pub fn triangles(&self) -> u64 {
        self.host.triangles
    }

    /// Indices of an object's mesh: three a triangle, two a line, one a point.
    pub fn index_count(&self, object: u32) -> u32 {
        self.host.meshes[self.host.object_meshes[object as usize] as usize].index_count
    }

    /// The scene's object behind each of the world's, which differ where lines and points are mixed in.
    pub fn scene_object(&self, object: usize) -> usize {
        self.host.scene_object[object] as usize
    }

    /// Changes whenever an object moves: equal revisions mean equal objects.
    pub fn revision(&self) -> u64 {
        self.host.revision
    }

    /// Changes whenever bounds do: equal ones mean equal bounds.
    pub fn bounds_revision(&self) -> u64 {
        self.host.bounds_revision
    }

    /// The list of blocks of [`BLOCK_OBJECTS`](shaders::types::BLOCK_OBJECTS) objects that are not outside the view volume, as
    /// blocks.glsl lays it out; it begins with the grid to look at them with. Records the stage that finds out, unless that would
    /// find out nothing.
    pub fn blocks_in_view(&self, f: &mut Frame, view: &View) -> BufferRef<u32> {
        self.blocks.in_view(f, view)
    }

    /// Bounds of blocks of [`BLOCK_OBJECTS`](shaders::types::BLOCK_OBJECTS) objects that lie side by side. A block in which something
    /// moves is flagged to be kept always.
    pub fn block_bounds(&self) -> BufferRef<Bounds> {
        self.blocks.bounds().all()
    }

    /// Blocks.
    pub fn block_count(&self) -> u32 {
        self.blocks.bounds().len() as u32
    }

    /// Notes that blocks need not be tested.
    pub fn skip_blocks(f: &mut Frame, reason: &'static str) {
        f.skip(frustum::TestBlocks::INFO.name, reason);
    }

    /// World bounds by object, of those that culling methods see.
    pub fn bounds(&self) -> BufferRef<Bounds> {
        let all = self.bounds.all();
        // Nothing cannot be bound.
        let size = (self.len().max(1) * size_of::<Bounds>()) as u64;
        BufferRef { size: all.size.min(size), ..all }
    }

    /// World bounds of all objects.
    pub fn all_bounds(&self) -> BufferRef<Bounds> {
        self.bounds.all()
    }

    /// Transforms and colours by object.
    pub fn objects(&self) -> BufferRef<Object> {
        self.objects.all()
    }

    /// The mesh of each object.
    pub fn object_meshes(&self) -> BufferRef<u32> {
        self.object_meshes.all()
    }

    /// True if [`World::blocks_in_view`] tests blocks, and does not list all of them.
    pub fn tests_blocks(&self) -> bool {
        self.blocks.tested()
    }

    /// Where each mesh lies.
    pub fn meshes(&self) -> BufferRef<MeshRange> {
        self.meshes.all()
    }

    /// Vertices of all meshes.
    pub fn vertices(&self) -> BufferRef<ObjectsVertex> {
        self.vertices.all()
    }

    /// Indices of all meshes, relative to each mesh's first vertex.
    pub fn indices(&self) -> BufferRef<u32> {
        self.indices.all()
    }

    /// Objects by how they are drawn; translucent ones are not among them.
    pub fn ranges(&self) -> &[Range] {
        &self.ranges
    }

    /// Bounds in the world of the objects that culling methods see, in f64, where they are now.
    pub fn host_bounds(&self) -> &[scenes::Aabb] {
        &self.host.boxes[..self.host.solid]
    }

    /// The same of all objects.
    pub fn all_host_bounds(&self) -> &[scenes::Aabb] {
        &self.host.boxes
    }

    /// True if it has objects with holes.
    pub fn has_masked(&self) -> bool {
        self.ranges.iter().any(|range| range.surface == Surface::Masked)
    }

    /// How a translucent object is drawn, as a range of none.
    pub(crate) fn translucent_kind(&self, object: u32) -> Range {
        self.host.translucent_kinds[object as usize - self.host.solid]
    }

    /// Transforms and colours by object, as they are on the device once [`World::update`] has run.
    pub fn host_objects(&self) -> &[Object] {
        &self.host.objects
    }

    /// The mesh of each object.
    pub fn host_object_meshes(&self) -> &[u32] {
        &self.host.object_meshes
    }
}

// Objects are bound as what goes on once an instance.
const _: () = {
    use std::mem::offset_of;
    assert!(size_of::<Object>() == size_of::<draw::ObjectsInstance>());
    assert!(offset_of!(Object, column_y) == offset_of!(draw::ObjectsInstance, column_y));
    assert!(offset_of!(Object, column_z) == offset_of!(draw::ObjectsInstance, column_z));
    assert!(offset_of!(Object, origin_high) == offset_of!(draw::ObjectsInstance, origin_high));
    assert!(offset_of!(Object, origin_low) == offset_of!(draw::ObjectsInstance, origin_low));
    assert!(offset_of!(Object, colour) == offset_of!(draw::ObjectsInstance, colour));
};
