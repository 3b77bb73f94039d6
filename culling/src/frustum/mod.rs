//! `frustum`: view-frustum culling on the GPU (Zachmann, VFC; GPU Gems 29.6.4): by world boxes, the spheres around them, oriented boxes,
//! or spheres first and boxes where these cannot tell.

pub mod bvh;
pub mod twin;

use crate::pack::DrawList;
use crate::world::Still;
use crate::{Method, OptionInfo, Options, Result, Setup, View, Work, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use shaders::types::{LocalBox, SHAPE_BOX, SHAPE_ORIENTED, SHAPE_SPHERE, SHAPE_SPHERE_BOX};
use shaders::{frustum, BufferRef, Stage};

/// What is left out, and by what objects are tested.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    OptionInfo {
        name: "test",
        default: "box",
        values: "sphere|box|obb|sphere-box",
        help: "what of an object is tested: the sphere around its world box, that box (n/p-vertex), the box of its mesh as the \
               object turns it, or the sphere and then the box",
    },
];

struct Frustum {
    shape: u32,
    kept: Buffer<u32>,
    list: DrawList,
    still: Still,
    /// Boxes of meshes in object space; one of none where they are not tested.
    local_boxes: Buffer<LocalBox>,
    planes: Buffer<u32>,
    counting: bool,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let shape = shape(setup.options);
    Ok(Box::new(Frustum {
        shape,
        kept: Buffer::new(setup.gpu, "frustum.kept", setup.world.len(), Placement::Storage)?,
        list: DrawList::new(setup.gpu, "frustum.list", setup.world)?,
        still: Still::new(setup.options),
        local_boxes: local_boxes(setup.gpu, setup.world, shape)?,
        planes: Buffer::with_data(setup.gpu, "frustum.planes", &[0], Placement::Storage)?,
        counting: false,
    }))
}

fn shape(options: &Options) -> u32 {
    match options.text("test") {
        "sphere" => SHAPE_SPHERE,
        "obb" => SHAPE_ORIENTED,
        "sphere-box" => SHAPE_SPHERE_BOX,
        _ => SHAPE_BOX,
    }
}

fn local_boxes(gpu: &Gpu, world: &World, shape: u32) -> Result<Buffer<LocalBox>> {
    let boxes = if shape == SHAPE_ORIENTED { world.local_boxes() } else { vec![LocalBox::default()] };
    Ok(Buffer::with_data(gpu, "frustum.local_boxes", &boxes, Placement::Storage)?)
}

impl Method for Frustum {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.counting {
            f.fill("frustum/clear_planes", &self.planes, 0);
        }
        if self.still.holds(world, view) {
            World::skip_blocks(f, Still::REASON);
            f.skip(self.stage_name(), Still::REASON);
            self.list.skip_packing(f, Still::REASON);
        } else {
            let blocks = world.blocks_in_view(f, view); // 1. which blocks of objects are not outside
            f.fill("frustum/clear_kept", &self.kept, 0);
            self.test(f, world, view, blocks); // 2. and of those, which objects
            self.count(f, world, view, blocks);
            self.list.pack(f, world, self.kept.all()); // 3. they, in object order
        }
        world.draw(f, &self.list, view, target); // 4. draw them
        Ok(())
    }

    fn count_work(&mut self, on: bool) {
        self.counting = on;
    }

    fn work(&self) -> Result<Work> {
        Ok(Work { plane_tests: u64::from(self.planes.read()?[0]), ..Work::default() })
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        Ok(())
    }
}

impl Frustum {
    fn stage_name(&self) -> &'static str {
        if self.shape == SHAPE_BOX {
            frustum::TestBounds::INFO.name
        } else {
            frustum::TestShapes::INFO.name
        }
    }

    fn test(&self, f: &mut Frame, world: &World, view: &View, blocks: BufferRef<u32>) {
        let (bounds, kept, view, object_count) = (world.bounds(), self.kept.all(), view.cull(), world.len() as u32);
        if self.shape == SHAPE_BOX {
            f.dispatch_indirect(frustum::TestBounds { bounds, blocks, kept, view, object_count }, blocks);
            return;
        }
        let test = frustum::TestShapes {
            bounds,
            kept,
            blocks,
            objects: world.objects(),
            object_meshes: world.object_meshes(),
            local_boxes: self.local_boxes.all(),
            view,
            object_count,
            constants: frustum::TestShapesConstants { shape: self.shape },
        };
        f.dispatch_indirect(test, blocks);
    }

    /// Counts plane tests, of blocks too, in frames that are asked to.
    fn count(&self, f: &mut Frame, world: &World, view: &View, blocks: BufferRef<u32>) {
        if !self.counting {
            return;
        }
        let of = |bounds, count, constants| frustum::CountPlanes {
            bounds,
            blocks,
            objects: world.objects(),
            object_meshes: world.object_meshes(),
            local_boxes: self.local_boxes.all(),
            planes: self.planes.all(),
            view: view.cull(),
            count,
            constants,
        };
        if world.tests_blocks() {
            let constants = frustum::CountPlanesConstants { shape: SHAPE_BOX, all: true };
            f.dispatch(of(world.block_bounds(), world.block_count(), constants), world.block_count());
        }
        let constants = frustum::CountPlanesConstants { shape: self.shape, all: false };
        f.dispatch_indirect(of(world.bounds(), world.len() as u32, constants), blocks);
    }
}
