//! `horizon`: the occlusion horizon of cities (Zachmann 2008, culling; Downs, Moeller & Sequin 2001). On the host, near to far: an object
//! is left out if, in every direction that it shows in, its slopes lie within what nearer buildings fill; a building that is drawn
//! adds what it fills. What is in a building is left out with it.
//!
//! What a building fills is not its bounds but what the scene declares as solid in it ([`scenes::Building`]): a box that its closed mesh
//! encloses. It is made smaller by as much as rasterising the mesh can be off, see [`solids`]; the rest is exact geometry in
//! `f64`, and all that is rounded is rounded towards drawing. The slopes have a lower end as well, at the foot of the
//! buildings: what shows below them, such as the ground behind, is not covered by what stands on it.

pub mod line;
pub mod solids;

use crate::boxes::eye_of;
use crate::frustum::bvh::{walk, Spared};
use crate::pack::DrawList;
use crate::tree::Tree;
use crate::world::Still;
use crate::{Error, Method, OptionInfo, Result, Setup, View, Work, World};
use engine::{Buffer, Frame, Placement, Target};
use glam::DVec3;
use line::{Horizon, Span};
use scenes::bvh::Split;
use shaders::types::{CullView, OBJECT_WIDE_RASTER};
use solids::{contents, Content, Prism};

/// What spares the tests, and what small things are.
pub const OPTIONS: &[OptionInfo] = &[crate::world::SKIP_OPTION, crate::world::DETAIL_OPTION];

/// What a scene lacks that `horizon` refuses.
pub const NEEDS: &str =
    "a city: a scene that declares what of its buildings is solid, such as city-block or radial-city; use frustum here";

const SPARED: Spared = Spared { masking: true, coherence: true };

struct OcclusionHorizon {
    tree: Tree,
    builds: u32,
    failed: Vec<u8>,
    /// Lines and points show around their geometry: they are never hidden.
    wide: Vec<bool>,
    /// By object: the building that it is in.
    contents: Vec<Option<Content>>,
    flags: Vec<u32>,
    kept: Buffer<u32>,
    list: DrawList,
    plane_tests: u64,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    if world.solids().is_empty() {
        return Err(Error::Missing { method: "horizon", needs: NEEDS.to_owned() });
    }
    let tree = Tree::new(gpu, world, Split::Sah)?;
    let wide = world.read_bounds()?.iter().map(|bounds| bounds.flags & OBJECT_WIDE_RASTER != 0).collect();
    Ok(Box::new(OcclusionHorizon {
        builds: tree.builds(),
        failed: vec![0; tree.len()],
        wide,
        contents: contents(world, tree.host()),
        flags: vec![0; world.len()],
        kept: Buffer::new(gpu, "horizon.kept", world.len(), Placement::Upload)?,
        list: DrawList::new(gpu, "horizon.list", world)?,
        plane_tests: 0,
        still: Still::new(setup.options),
        tree,
    }))
}

impl Method for OcclusionHorizon {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.still.holds(world, view) {
            self.plane_tests = 0;
            self.tree.rest();
            self.list.skip_packing(f, Still::REASON);
        } else {
            self.tree.follow(world)?;
            if self.builds != self.tree.builds() {
                self.builds = self.tree.builds();
                self.failed.fill(0);
            }
            self.flags.copy_from_slice(self.tree.unbounded());
            let nodes = self.tree.host_nodes();
            self.plane_tests = walk(nodes, &view.cull(), SPARED, &mut self.failed, &mut self.flags); // 1. what is in view
            if let Some(eye) = eye(view) {
                let prisms = prisms(world, &self.flags, &view.cull(), eye); // 2. which buildings can hide something
                leave_out_contents(&self.contents, &prisms, &mut self.flags); // 3. not what is in them
                let sight = Sight { eye, prisms: &prisms, wide: &self.wide, unbounded: self.tree.unbounded() };
                sweep(world, view, &sight, &mut self.flags); // 4. near to far, under the horizon
            }
            self.kept.write(&self.flags)?;
            self.list.pack(f, world, self.kept.all()); // 5. in object order
        }
        world.draw(f, &self.list, view, target); // 6. draw it
        Ok(())
    }

    fn work(&self) -> Result<Work> {
        Ok(Work { plane_tests: self.plane_tests, refits: self.tree.refitted(), ..Work::default() })
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        self.failed.fill(0);
        Ok(())
    }
}

/// The eye in the world; none for parallel projections, whose rays do not meet: then nothing but the view volume is tested.
pub fn eye(view: &View) -> Option<DVec3> {
    let eye = eye_of(&view.clip_from_relative());
    (eye.w != 0.0 && eye.is_finite()).then(|| view.pose.position + eye.truncate())
}

/// By building: what of it surely hides what lies behind, as seen from the eye.
pub fn prisms(world: &World, in_view: &[u32], view: &CullView, eye: DVec3) -> Vec<Option<Prism>> {
    let prism = |solid: &crate::world::Solid| {
        let drawn = in_view[solid.object as usize] != 0;
        drawn.then(|| Prism::new(solid, &world.host_bounds()[solid.object as usize], view, eye)).flatten()
    };
    world.solids().iter().map(prism).collect()
}

fn leave_out_contents(contents: &[Option<Content>], prisms: &[Option<Prism>], flags: &mut [u32]) {
    for (flag, content) in flags.iter_mut().zip(contents) {
        let Some(content) = content else { continue };
        let hidden = prisms[content.building as usize].as_ref().is_some_and(|prism| content.depth >= prism.shrunk);
        if hidden {
            *flag = 0;
        }
    }
}

/// What a frame looks at.
pub struct Sight<'a> {
    /// Where the eye is.
    pub eye: DVec3,
    /// By building.
    pub prisms: &'a [Option<Prism>],
    /// Objects that are never hidden.
    pub wide: &'a [bool],
    /// 1 for each object whose bounds are none.
    pub unbounded: &'a [u32],
}

/// Takes the flags of objects that the horizon of nearer buildings hides.
pub fn sweep(world: &World, view: &View, sight: &Sight<'_>, flags: &mut [u32]) {
    let filling: Vec<&Prism> = sight.prisms.iter().flatten().filter(|prism| prism.fills()).collect();
    let mut horizon = Horizon::new(view, &filling);
    let mut buildings: Vec<(f64, u32)> =
        (0..filling.len() as u32).map(|index| (filling[index as usize].from, index)).collect();
    buildings.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
    let tested = |object: &usize| flags[*object] != 0 && !sight.wide[*object] && sight.unbounded[*object] == 0;
    let span = |object: usize| Span::of(&world.host_bounds()[object], sight.eye).map(|span| (span, object));
    let mut spans: Vec<(Span, usize)> = (0..flags.len()).filter(tested).filter_map(span).collect();
    spans.sort_unstable_by(|one, other| one.0.from.total_cmp(&other.0.from));
    let mut next = 0;
    for (span, object) in spans {
        while next < buildings.len() && buildings[next].0 < span.from {
            let prism = filling[buildings[next].1 as usize];
            // One that is hidden adds nothing: what it would hide is hidden.
            if flags[prism.object as usize] != 0 {
                horizon.add(prism);
            }
            next += 1;
        }
        if horizon.hides(&span) {
            flags[object] = 0;
        }
    }
}
