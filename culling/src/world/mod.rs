//! A scene on the GPU: vertices, indices, objects, bounds, and what moves them.

mod blocks;
mod drawn;
mod order;
mod still;
mod ties;
pub mod twin;
mod upload;
mod view;

pub use blocks::{listed as listed_blocks, unlisted as unlisted_blocks};
pub use drawn::{drawn_objects, Drawn};
pub use still::{Still, DETAIL_OPTION, SKIP_OPTION};
pub use ties::LastToFirst;
pub use upload::bounds as gpu_bounds;
pub use view::{split, View};

use crate::pack::DrawList;
use crate::Result;
use blocks::Blocks;
use engine::{Buffer, Frame, Gpu, IndexedIndirect, Placement, Primitives, Target};
use glam::DAffine3;
use scenes::{Scene, WorldBounds};
use shaders::draw::ObjectsVertex;
use shaders::types::{Bounds, DrawCommand, MeshRange, MovedObject, Object};
use shaders::{draw, frustum, world, BufferRef, ResourceId, Stage};

/// Objects that lie side by side and are drawn with the same kind of primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range {
    /// First object.
    pub first: u32,
    /// Objects, > 0.
    pub count: u32,
    /// Their primitives.
    pub primitives: Primitives,
}

/// A scene on the GPU. Triangles come before lines and lines before points, what moves after what stays; beyond that objects keep the
/// scene's order, unless that puts far from each other what lies near each other: then they lie along a curve through space.
pub struct World {
    vertices: Buffer<ObjectsVertex>,
    indices: Buffer<u32>,
    meshes: Buffer<MeshRange>,
    objects: Buffer<Object>,
    bounds: Buffer<Bounds>,
    object_meshes: Buffer<u32>,
    all_commands: Buffer<DrawCommand>,
    moves: Option<Buffer<MovedObject>>,
    blocks: Blocks,
    ranges: Vec<Range>,
    host: Host,
}

/// What the host keeps of the scene.
struct Host {
    scene_object: Vec<u32>,
    object_of_scene: Vec<u32>,
    bounds: WorldBounds,
    boxes: Vec<scenes::Aabb>,
    object_meshes: Vec<u32>,
    meshes: Vec<MeshRange>,
    indices: Vec<u32>,
    static_objects: Vec<Object>,
    flags: Vec<u32>,
    transforms: Vec<(u32, DAffine3)>,
    move_count: u32,
    seconds: Option<f64>,
    revision: u64,
    triangles: u64,
}

impl World {
    /// Uploads a scene at time 0.
    ///
    /// # Errors
    /// A scene that is broken or too large, or a device without room for it.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self> {
        scene.check()?;
        let flat = upload::flatten(scene);
        let storage = Placement::Storage;
        let moving = scene.motion.dynamic_objects().len();
        let object_of_scene = upload::inverse(&flat.scene_object);
        let moving_objects: Vec<u32> =
            scene.motion.dynamic_objects().iter().map(|object| object_of_scene[*object as usize]).collect();
        let moves = if moving == 0 { None } else { Some(Buffer::new(gpu, "world.moves", moving, Placement::Upload)?) };
        let mut transforms = Vec::new();
        scene.motion.transforms_at(0.0, &mut transforms);
        Ok(World {
            vertices: Buffer::with_data(gpu, "world.vertices", &flat.vertices, Placement::Geometry)?,
            indices: Buffer::with_data(gpu, "world.indices", &flat.indices, Placement::Geometry)?,
            meshes: Buffer::with_data(gpu, "world.meshes", &flat.meshes, storage)?,
            objects: Buffer::with_data(gpu, "world.objects", &flat.objects, storage)?,
            bounds: Buffer::with_data(gpu, "world.bounds", &flat.bounds, storage)?,
            object_meshes: Buffer::with_data(gpu, "world.object_meshes", &flat.object_meshes, storage)?,
            all_commands: Buffer::with_data(gpu, "world.all_commands", &flat.commands, storage)?,
            moves,
            blocks: Blocks::new(gpu, &flat.bounds, &moving_objects)?,
            ranges: flat.ranges,
            host: Host {
                object_of_scene,
                scene_object: flat.scene_object,
                bounds: flat.world_bounds,
                boxes: flat.boxes,
                object_meshes: flat.object_meshes,
                meshes: flat.meshes,
                indices: flat.indices,
                flags: flat.bounds.iter().map(|bounds| bounds.flags).collect(),
                static_objects: if moving == 0 { Vec::new() } else { flat.objects },
                transforms,
                move_count: 0,
                seconds: None,
                revision: 0,
                triangles: scene.triangles(),
            },
        })
    }

    /// Objects.
    pub fn len(&self) -> usize {
        self.host.scene_object.len()
    }

    /// True if there is nothing to draw.
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

    /// Puts moving objects where they are at a time in the scene; the next frames upload it. Cheap if nothing moves.
    pub fn set_time(&mut self, scene: &Scene, seconds: f64) -> Result<()> {
        let Some(moves) = &mut self.moves else { return Ok(()) };
        if self.host.seconds == Some(seconds) {
            return Ok(());
        }
        let host = &mut self.host;
        scene.motion.transforms_at(seconds, &mut host.transforms);
        let moved: Vec<MovedObject> = host
            .transforms
            .iter()
            .map(|(scene_object, transform)| {
                let index = host.object_of_scene[*scene_object as usize];
                let mesh = host.object_meshes[index as usize];
                let still = host.static_objects[index as usize];
                let object = Object { colour: still.colour, ..upload::object(transform, still.colour) };
                host.boxes[index as usize] = host.bounds.of(mesh, transform);
                let bounds = upload::bounds(&host.boxes[index as usize], transform, host.flags[index as usize]);
                MovedObject { index, object, bounds }
            })
            .collect();
        moves.write(&moved)?;
        host.move_count = moved.len() as u32;
        host.seconds = Some(seconds);
        host.revision += 1;
        Ok(())
    }

    /// First step of every frame: moving objects take their places.
    pub fn update(&self, f: &mut Frame) {
        let Some(moves) = &self.moves else {
            f.skip(world::MoveObjects::INFO.name, "no dynamic objects");
            return;
        };
        let stage = world::MoveObjects {
            moves: moves.all(),
            objects: self.objects.all(),
            bounds: self.bounds.all(),
            move_count: self.host.move_count,
        };
        f.dispatch(stage, self.host.move_count);
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

    /// Draws what a list holds.
    pub fn draw(&self, f: &mut Frame, list: &DrawList, view: &View, target: &Target) {
        for draw in list.draws(self) {
            self.draw_indirect(f, draw, view, target);
        }
    }

    /// Draws the depth of what a list holds and nothing else, ahead of the draws that show it.
    pub fn draw_depth(&self, f: &mut Frame, list: &DrawList, view: &View, target: &Target) {
        for indirect in list.draws(self) {
            let stage = draw::Depth { view: view.gpu() };
            f.draw_unshown(stage, indirect, &target.depth_only());
        }
    }

    /// Draws what a list holds, and sets the flag of each object of which a fragment passes the early tests: colour, depth
    /// and visibility in one pass (EOVC thesis III.2).
    pub fn draw_flagged(&self, f: &mut Frame, list: &DrawList, visible: BufferRef<u32>, view: &View, target: &Target) {
        for draw in list.draws(self) {
            self.draw_indirect_flagged(f, draw, visible, view, target);
        }
    }

    /// Draws every object.
    pub fn draw_all(&self, f: &mut Frame, view: &View, target: &Target) {
        self.draw_commands(f, self.all_commands.all(), view, target);
    }

    /// Draws from a command for each object, in object order; a command of no instances draws nothing.
    pub fn draw_commands(&self, f: &mut Frame, commands: BufferRef<DrawCommand>, view: &View, target: &Target) {
        if self.is_empty() {
            f.skip(draw::Objects::INFO.name, "no objects");
        }
        for range in &self.ranges {
            let draw = IndexedIndirect {
                vertices: self.vertices.all().into(),
                instances: self.objects.all().into(),
                indices: self.indices.all().into(),
                commands: commands.from(range.first as usize).into(),
                count: None,
                max_draws: range.count,
                primitives: range.primitives,
            };
            self.draw_indirect(f, draw, view, target);
        }
    }

    /// Draws the lists of a finished frame once more, in the same order. They must still be as they were.
    pub fn draw_again(&self, f: &mut Frame, draws: &[IndexedIndirect], view: &View, target: &Target) {
        for draw in draws {
            self.draw_indirect(f, *draw, view, target);
        }
    }

    pub(crate) fn draw_indirect(&self, f: &mut Frame, draw: IndexedIndirect, view: &View, target: &Target) {
        let view = view.gpu();
        // A target that holds counts is an overdraw picture: the same draws, counted instead of shaded.
        if matches!(target.colour, Some((_, engine::Format::Heat))) {
            f.draw(draw::Overdraw { view }, draw, target);
        } else if target.item.is_some() {
            f.draw(draw::ObjectsAndItems { view }, draw, target);
        } else {
            f.draw(draw::Objects { view }, draw, target);
        }
    }

    pub(crate) fn draw_indirect_flagged(
        &self,
        f: &mut Frame,
        draw: IndexedIndirect,
        visible: BufferRef<u32>,
        view: &View,
        target: &Target,
    ) {
        let view = view.gpu();
        if target.item.is_some() {
            f.draw(draw::ObjectsItemsAndFlags { visible, view }, draw, target);
        } else {
            f.draw(draw::ObjectsAndFlags { visible, view }, draw, target);
        }
    }

    /// World bounds by object.
    pub fn bounds(&self) -> BufferRef<Bounds> {
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

    /// Objects by kind of primitive.
    pub fn ranges(&self) -> &[Range] {
        &self.ranges
    }

    /// Bounds in the world of every object, in f64, where they are now.
    pub fn host_bounds(&self) -> &[scenes::Aabb] {
        &self.host.boxes
    }

    /// Bounds as they are on the GPU now; for tests.
    pub fn read_bounds(&self) -> Result<Vec<Bounds>> {
        Ok(self.bounds.read()?)
    }

    /// Objects that can move, and where the last call of [`World::set_time`] put them, in an order that never changes.
    pub fn moving(&self) -> impl ExactSizeIterator<Item = (u32, DAffine3)> + '_ {
        let object = |scene_object: u32| self.host.object_of_scene[scene_object as usize];
        self.host.transforms.iter().map(move |(scene_object, transform)| (object(*scene_object), *transform))
    }

    /// A command for every object; for tests and the ideal method.
    pub fn read_all_commands(&self) -> Result<Vec<DrawCommand>> {
        Ok(self.all_commands.read()?)
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
