//! Each decision of `horizon` is taken wrongly once, and the law must say so.

use super::{cities, city, gate};
use culling::eovc::Tree;
use culling::frustum::bvh::{walk, Spared};
use culling::horizon::solids::{contents, Content, Prism};
use culling::horizon::{eye, prisms, sweep, Sight};
use culling::{DrawList, Method, Setup, View, World};
use engine::{Buffer, Frame, Placement, Target};
use harness::{assert_caught, assert_none, gpu, laws, Subject};
use scenes::bvh::Split;

/// What is wrong.
#[derive(Clone, Copy, PartialEq)]
enum Defect {
    Nothing,
    /// Buildings hide what is in front of them.
    NotNearToFar,
    /// Buildings hide what shows below their feet.
    Footless,
    /// More is solid than there is.
    Larger,
    /// Buildings hide what is above them.
    Higher,
    /// Buildings that the near plane cuts open hide what is in them.
    CutOpen,
    /// What touches a building is in it.
    Touching,
}

struct Broken {
    defect: Defect,
    tree: Tree,
    contents: Vec<Option<Content>>,
    kept: Buffer<u32>,
    list: DrawList,
}

fn make(setup: &Setup<'_>, defect: Defect) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let tree = Tree::new(gpu, world, Split::Sah)?;
    let mut contents = contents(world, tree.host());
    if defect == Defect::Touching {
        for (object, content) in contents.iter_mut().enumerate() {
            let at = world.host_bounds()[object].centre();
            let near = |(building, solid): (usize, &culling::world::Solid)| {
                let reach = solid.axes.iter().map(|axis| axis.length()).fold(0.0, f64::max);
                let touches = solid.object as usize != object && (at - solid.centre).length() < 1.5 * reach;
                touches.then_some(Content { building: building as u32, depth: f64::INFINITY })
            };
            *content = content.or_else(|| world.solids().iter().enumerate().find_map(near));
        }
    }
    Ok(Box::new(Broken {
        defect,
        tree,
        contents,
        kept: Buffer::new(gpu, "broken.kept", world.len(), Placement::Upload)?,
        list: DrawList::new(gpu, "broken.list", world)?,
    }))
}

impl Broken {
    fn prisms(&self, world: &World, view: &View, flags: &[u32], eye: glam::DVec3) -> Vec<Option<Prism>> {
        let mut prisms = prisms(world, flags, &view.cull(), eye);
        if self.defect == Defect::CutOpen {
            let all = world.solids().iter().map(|solid| Some(Prism::shrunk(solid, 0.01, eye)));
            prisms = all.collect();
        }
        for (prism, solid) in prisms.iter_mut().zip(world.solids()) {
            let Some(prism) = prism else { continue };
            match self.defect {
                Defect::NotNearToFar => prism.from = 0.0,
                Defect::Footless => prism.heights[0] = -1e9,
                Defect::Larger => *prism = Prism::shrunk(solid, -2.5, eye),
                Defect::Higher => prism.heights[1] += 15.0,
                _ => {}
            }
        }
        prisms
    }
}

impl Method for Broken {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        self.tree.follow(world)?;
        let mut flags = self.tree.unbounded().to_vec();
        let mut failed = vec![0; self.tree.len()];
        let spared = Spared { masking: true, coherence: false };
        walk(self.tree.host_nodes(), &view.cull(), spared, &mut failed, &mut flags);
        if let Some(eye) = eye(view) {
            let prisms = self.prisms(world, view, &flags, eye);
            for (flag, content) in flags.iter_mut().zip(&self.contents) {
                let prism =
                    content.and_then(|content| prisms[content.building as usize].as_ref().map(|p| (content, p)));
                if prism.is_some_and(|(content, prism)| content.depth >= prism.shrunk) {
                    *flag = 0;
                }
            }
            let wide = vec![false; flags.len()];
            sweep(
                world,
                view,
                &Sight { eye, prisms: &prisms, wide: &wide, unbounded: self.tree.unbounded() },
                &mut flags,
            );
        }
        self.kept.write(&flags)?;
        self.list.pack(f, world, self.kept.all());
        world.draw(f, &self.list, view, target);
        Ok(())
    }
}

fn faults(make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>, case: &harness::Case) -> Vec<String> {
    let subject = Subject { options: culling::find("horizon").unwrap().default_options(), make };
    laws::no_visible_object_is_culled(&gpu(), &subject, case)
}

#[test]
fn each_wrong_decision_is_noticed() {
    let case = city("city-block", 0.02);
    for case in cities() {
        assert_none(&faults(|setup| make(setup, Defect::Nothing), &case));
    }
    assert_caught(&faults(|setup| make(setup, Defect::NotNearToFar), &case), "false negatives");
    // In a city that stands on the ground nothing shows below a foot.
    assert_caught(&faults(|setup| make(setup, Defect::Footless), &gate()), "false negatives");
    assert_caught(&faults(|setup| make(setup, Defect::Larger), &case), "false negatives");
    assert_caught(&faults(|setup| make(setup, Defect::Higher), &case), "false negatives");
    assert_caught(&faults(|setup| make(setup, Defect::CutOpen), &case), "false negatives");
    assert_caught(&faults(|setup| make(setup, Defect::Touching), &case), "false negatives");
}
