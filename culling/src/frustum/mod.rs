//! `frustum`: view-frustum culling of world boxes on the GPU (Zachmann, VFC; GPU Gems 29.6.4).

pub mod bvh;
pub mod twin;

use crate::pack::DrawList;
use crate::world::Still;
use crate::{Method, OptionInfo, Result, Setup, View, World};
use engine::{Buffer, Frame, Placement, Target};
use shaders::{frustum, Stage};

/// `skip`: leave out what cannot change the result.
pub const OPTIONS: &[OptionInfo] = &[crate::world::SKIP_OPTION, crate::world::DETAIL_OPTION];

struct Frustum {
    kept: Buffer<u32>,
    list: DrawList,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    Ok(Box::new(Frustum {
        kept: Buffer::new(setup.gpu, "frustum.kept", setup.world.len(), Placement::Storage)?,
        list: DrawList::new(setup.gpu, "frustum.list", setup.world)?,
        still: Still::new(setup.options),
    }))
}

impl Method for Frustum {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.still.holds(world, view) {
            World::skip_blocks(f, Still::REASON);
            f.skip(frustum::TestBounds::INFO.name, Still::REASON);
            self.list.skip_packing(f, Still::REASON);
        } else {
            let blocks = world.blocks_in_view(f, view); // 1. which blocks of objects are not outside
            let test = frustum::TestBounds {
                bounds: world.bounds(),
                blocks,
                kept: self.kept.all(),
                view: view.cull(),
                object_count: world.len() as u32,
            };
            f.fill("frustum/clear_kept", &self.kept, 0);
            f.dispatch_indirect(test, blocks); // 2. and of those, which objects
            self.list.pack(f, world, self.kept.all()); // 3. they, in object order
        }
        world.draw(f, &self.list, view, target); // 4. draw them
        Ok(())
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        Ok(())
    }
}
