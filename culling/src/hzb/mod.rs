//! `hzb`: two-phase hierarchical-Z culling (Haar & Aaltonen 2015, "GPU-Driven Rendering Pipelines"), the baseline that
//! engines ship today. What the last frame saw is drawn first; its depth hides most of the rest.

pub mod fronts;
pub mod iterative;
mod pyramid;
pub mod twin;

pub use pyramid::{layout, Pyramid};

use crate::pack::DrawList;
use crate::world::Still;
use crate::{Method, OptionInfo, Result, Setup, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use shaders::{hzb, Stage};

/// `skip`, and `texels`: how many texels a footprint may touch in each direction before a coarser level is taken.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    OptionInfo {
        name: "texels",
        default: "4",
        values: "2..=16",
        help: "pyramid texels a footprint may touch in each direction: more is tighter and slower",
    },
];

/// After the camera stops: the frame it stopped in may test against a pyramid that lacks occluders and see too much; the
/// next draws that, and so tests against the full depth; the one after draws just what that test saw, and so do all others.
const SETTLED_AFTER: u32 = 3;

struct Hzb {
    gpu: Gpu,
    /// By object: seen by the last frame, then by this one; they change places.
    seen: [Buffer<u32>; 2],
    newly: Buffer<u32>,
    early: DrawList,
    late: DrawList,
    pyramid: Option<Pyramid>,
    texels: u32,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let seen = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Storage);
    Ok(Box::new(Hzb {
        gpu: gpu.clone(),
        seen: [seen("hzb.seen_even")?, seen("hzb.seen_odd")?],
        newly: Buffer::new(gpu, "hzb.newly", world.len(), Placement::Storage)?,
        early: DrawList::new(gpu, "hzb.early", world)?,
        late: DrawList::new(gpu, "hzb.late", world)?,
        pyramid: None,
        texels: setup.options.number("texels"),
        still: Still::new(setup.options).settled_after(SETTLED_AFTER),
    }))
}

impl Method for Hzb {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        let pyramid = Pyramid::sized(&mut self.pyramid, &self.gpu, target.size, 1, self.texels)?;
        let still = self.still.holds(world, view);
        world.update(f);
        f.clear(target);

        f.part("early");
        if still {
            self.early.skip_packing(f, Still::REASON);
        } else {
            self.early.pack(f, world, self.seen[0].all()); // 1. what the last frame saw, in object order
        }
        world.draw(f, &self.early, view, target); // 2. draw it

        f.part("");
        if still {
            Pyramid::skip(f, Still::REASON);
            World::skip_blocks(f, Still::REASON);
            f.skip(hzb::TestBounds::INFO.name, Still::REASON);
        } else {
            pyramid.reduce(f, target); // 3. farthest depth per tile
            let blocks = world.blocks_in_view(f, view);
            f.fill("hzb/clear_seen", &self.seen[1], 0);
            f.fill("hzb/clear_newly", &self.newly, 0);
            let test = hzb::TestBounds {
                bounds: world.bounds(),
                levels: pyramid.levels(),
                pyramid: pyramid.texels(),
                seen_before: self.seen[0].all(),
                seen: self.seen[1].all(),
                newly: self.newly.all(),
                blocks,
                view: view.cull(),
                object_count: world.len() as u32,
                coarsest_level: pyramid.coarsest_level(),
                constants: hzb::TestBoundsConstants {
                    footprint_texels: self.texels,
                    finest_level: pyramid.finest_level(),
                },
            };
            f.dispatch_indirect(test, blocks); // 4. test all objects that may be in view
            self.seen.swap(0, 1);
        }

        f.part("late");
        if still {
            self.late.skip_packing(f, Still::REASON);
        } else {
            self.late.pack(f, world, self.newly.all()); // 5. what has come into view
        }
        world.draw(f, &self.late, view, target); // 6. draw it
        f.part("");
        Ok(())
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        for seen in &mut self.seen {
            seen.write(&vec![0; seen.len()])?;
        }
        Ok(())
    }
}
