//! `hom` made of its parts with one defect: the laws must say so, although the prepass gives the picture its true depth.

use culling::farthest::{FarthestMap, MapKind, Structure};
use culling::{DrawList, Method, OptionInfo, Options, Setup, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use harness::{assert_caught, assert_none, gpu, laws, worlds, Subject};

/// What is wrong with a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    Nothing,
    /// The map holds the last frame's depth, as if it were warped to this one.
    DepthOfTheLastFrame,
}

const KIND: MapKind = MapKind { structure: Structure::YMap(2), reduction: 0 };
const OPTIONS: &[OptionInfo] = &[];

struct Broken {
    defect: Defect,
    gpu: Gpu,
    flags: [Buffer<u32>; 2],
    lists: [DrawList; 2],
    map: Option<FarthestMap>,
    frames: u32,
}

fn make(setup: &Setup<'_>, defect: Defect) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let flags = |name| Buffer::new(gpu, name, world.len(), Placement::Storage);
    Ok(Box::new(Broken {
        defect,
        gpu: gpu.clone(),
        flags: [flags("broken.kept")?, flags("broken.visible")?],
        lists: [DrawList::new(gpu, "broken.in_view", world)?, DrawList::new(gpu, "broken.list", world)?],
        map: None,
        frames: 0,
    }))
}

impl Method for Broken {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        let map = FarthestMap::sized(&mut self.map, &self.gpu, target.size, KIND)?;
        let object_count = world.len() as u32;
        let [kept, visible] = self.flags.each_ref().map(Buffer::all);
        let [in_view, list] = &self.lists;
        let later = self.frames > 0;
        self.frames += 1;
        world.update(f);
        if self.defect == Defect::DepthOfTheLastFrame && later {
            map.fill_from_depth(f, target);
        }
        f.clear(target);
        let bounds = world.bounds();
        let blocks = world.blocks_in_view(f, view);
        f.dispatch(
            shaders::frustum::TestBounds { bounds, blocks, kept, view: view.cull(), object_count },
            object_count,
        );
        in_view.pack(f, world, kept);
        world.draw_depth(f, in_view, view, target);
        if self.defect != Defect::DepthOfTheLastFrame || !later {
            map.fill_from_depth(f, target);
        }
        map.build(f);
        map.test(f, world, view, (kept, blocks), visible);
        list.pack(f, world, visible);
        world.draw(f, list, view, target);
        Ok(())
    }
}

fn faults(make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>) -> Vec<String> {
    let subject = Subject { options: Options::new("broken", OPTIONS), make };
    laws::no_visible_object_is_culled(&gpu(), &subject, &worlds::walled(300))
}

#[test]
fn hom_of_its_parts_is_exact() {
    assert_none(&faults(|setup| make(setup, Defect::Nothing)));
}

#[test]
fn the_depth_of_the_last_frame_is_noticed() {
    assert_caught(&faults(|setup| make(setup, Defect::DepthOfTheLastFrame)), "false negatives");
}
