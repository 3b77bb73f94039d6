//! `hom`: hierarchical occlusion mapping with the precise depth buffer (Lee et al. 2018, figure 14c). The depth of this
//! frame's own objects is drawn first, so that the test of warping-based culling meets a map without warping errors: what it
//! still draws too much is the test's doing.

use super::{FarthestMap, MapKind, Structure};
use crate::pack::DrawList;
use crate::world::Still;
use crate::{Method, OptionInfo, Options, Result, Setup, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use shaders::{draw, farthest, frustum, Stage};

/// `skip`, and what the map is made of.
pub const OPTIONS: &[OptionInfo] =
    &[crate::world::SKIP_OPTION, crate::world::DETAIL_OPTION, STRUCTURE_OPTION, LEVELS_OPTION, SIZE_OPTION];

/// How the map keeps the farthest depths of large regions.
pub const STRUCTURE_OPTION: OptionInfo = OptionInfo {
    name: "structure",
    default: "y-map",
    values: "n-buffer|y-map|mip",
    help: "farthest depths of regions: exact, exact in units of the last mip level, or a pyramid",
};

/// How many mip levels a Y-map has.
pub const LEVELS_OPTION: OptionInfo = OptionInfo {
    name: "levels",
    default: "2",
    values: "0..=8",
    help: "mip levels of a y-map before it goes on as an n-buffer: more is cheaper and coarser",
};

/// How much smaller the map is than the picture.
pub const SIZE_OPTION: OptionInfo = OptionInfo {
    name: "size",
    default: "1",
    values: "1|2|4",
    help: "pixels a side that a texel of the map stands for: more is cheaper and coarser",
};

/// The kind of map that the options ask for.
pub fn map_kind(options: &Options) -> MapKind {
    let structure = match options.text(STRUCTURE_OPTION.name) {
        "n-buffer" => Structure::NBuffer,
        "mip" => Structure::Mip,
        _ => Structure::YMap(options.number(LEVELS_OPTION.name)),
    };
    MapKind { structure, reduction: options.number(SIZE_OPTION.name).max(1).ilog2() }
}

struct Hom {
    gpu: Gpu,
    kept: Buffer<u32>,
    visible: Buffer<u32>,
    in_view: DrawList,
    list: DrawList,
    kind: MapKind,
    map: Option<FarthestMap>,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    Ok(Box::new(Hom {
        gpu: gpu.clone(),
        kept: Buffer::new(gpu, "hom.kept", world.len(), Placement::Storage)?,
        visible: Buffer::new(gpu, "hom.visible", world.len(), Placement::Storage)?,
        in_view: DrawList::new(gpu, "hom.in_view", world)?,
        list: DrawList::new(gpu, "hom.list", world)?,
        kind: map_kind(setup.options),
        map: None,
        still: Still::new(setup.options),
    }))
}

impl Method for Hom {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.still.holds(world, view) {
            self.skip(f);
        } else {
            self.cull(f, world, view, target)?;
        }
        // Of a prepass nothing is left to do but shading: a fragment as near as the depth that is there passes, and of
        // several the last stays, as without culling.
        world.draw(f, &self.list, view, target); // 6. draw the others
        Ok(())
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        Ok(())
    }
}

impl Hom {
    fn cull(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        let map = FarthestMap::sized(&mut self.map, &self.gpu, target.size, self.kind)?;
        let object_count = world.len() as u32;
        let (kept, visible) = (self.kept.all(), self.visible.all());

        f.part("prepass");
        let blocks = world.blocks_in_view(f, view);
        let frustum = frustum::TestBounds { bounds: world.bounds(), blocks, kept, view: view.cull(), object_count };
        f.fill("frustum/clear_kept", &self.kept, 0);
        f.dispatch_indirect(frustum, blocks); // 1. view-frustum culling
        self.in_view.pack(f, world, kept);
        world.draw_depth(f, &self.in_view, view, target); // 2. this frame's depth

        f.part("");
        map.fill_from_depth(f, target);
        map.build(f); // 3. the farthest depth of any region
        map.test(f, world, view, (kept, blocks), visible); // 4. who lies behind it everywhere
        self.list.pack(f, world, visible); // 5. the others, in object order
        Ok(())
    }

    /// Camera and objects unchanged: the last frame's list holds, and draws all of the depth itself.
    fn skip(&self, f: &mut Frame) {
        f.part("prepass");
        World::skip_blocks(f, Still::REASON);
        f.skip(frustum::TestBounds::INFO.name, Still::REASON);
        self.in_view.skip_packing(f, Still::REASON);
        f.skip(draw::Depth::INFO.name, Still::REASON);
        f.part("");
        f.skip(farthest::FillFromDepth::INFO.name, Still::REASON);
        FarthestMap::skip(f, self.kind, Still::REASON);
        self.list.skip_packing(f, Still::REASON);
    }
}
