//! `woc`: warping-based occlusion culling (Kim 2015, "Efficient occlusion culling with depth warping"; Lee et al. 2018,
//! section 5), and its kin: `awoc`, which fills the holes of the warp, and `woc-exact`, which repairs what the warp got wrong.
//!
//! All that the last frame saw is an occluder of this one, as the depth it left, warped to the new view: none is chosen, and
//! none is drawn.

mod hybrid;
mod map;
mod options;
mod rapid;
pub mod twin;

pub use options::OPTIONS;

use crate::farthest::hom;
use crate::pack::DrawList;
use crate::warp::Settings;
use crate::world::Still;
use crate::{Method, OptionInfo, Options, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use hybrid::Hybrid;
use map::{OcclusionMap, Recipe};
use rapid::Rapid;
use shaders::{frustum, woc, BufferRef, Stage};

/// Why `woc` may miss objects.
pub const WARPED: &str =
    "occluders are the last frame's depth, warped: where that is wrong, objects appear a frame late";
/// Why `awoc` may miss objects.
pub const FILLED: &str =
    "as woc, and what the last frame did not see is taken to be as near as what moves most like it";

/// What a method does about what the last frame did not see, and about what the warp got wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Holes are far: they hide nothing.
    Conservative,
    /// Holes are filled.
    Approximate,
    /// Holes are far, and what was culled is tested again against the depth of what was drawn.
    Exact,
}

/// The costly objects, whose boxes are tested too.
fn costly(world: &World, options: &Options) -> Vec<u32> {
    let number = |option: OptionInfo| options.number(option.name);
    hybrid::candidates(world, number(options::HYBRID), number(options::HYBRID_TRIANGLES))
}

/// True if there are any.
pub(crate) fn tests_boxes(world: &World, options: &Options) -> bool {
    !costly(world, options).is_empty()
}

/// After the camera stops: the frame it stopped in may have missed objects. The next is tested against its depth, in which
/// they hide nothing, and draws all that shows; the one after is tested against the full depth, and so are all others.
const SETTLED_AFTER: u32 = 3;

pub(crate) struct Woc {
    gpu: Gpu,
    kind: Kind,
    recipe: Recipe,
    map: Option<OcclusionMap>,
    kept: Buffer<u32>,
    visible: Buffer<u32>,
    rejected: Buffer<u32>,
    newly: Buffer<u32>,
    rapid: Option<Rapid>,
    hybrid: Option<Hybrid>,
    list: DrawList,
    late: DrawList,
    still: Still,
    /// The last frame's repair has said which of the culled objects the depth of what was drawn does not hide.
    repaired: bool,
}

/// Makes `woc-exact`, of which [`Woc::check`] makes `woc` in frames.
pub(crate) fn make_checked(setup: &Setup<'_>) -> Result<Woc> {
    Woc::new(setup, Kind::Exact)
}

/// Makes `woc`.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    Ok(Box::new(Woc::new(setup, Kind::Conservative)?))
}

/// Makes `awoc`.
pub fn make_approximate(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    Ok(Box::new(Woc::new(setup, Kind::Approximate)?))
}

/// Makes `woc-exact`.
pub fn make_exact(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    Ok(Box::new(Woc::new(setup, Kind::Exact)?))
}

impl Method for Woc {
    fn needs_items(&self, world: &World, _view: &View) -> bool {
        world.moving().len() > 0
    }

    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        let map = OcclusionMap::sized(&mut self.map, &self.gpu, world, target.size, self.recipe)?;
        world.update(f);
        f.clear(target);
        self.repaired = false;
        if self.still.holds(world, view) {
            self.same_again(f, world, view, target);
            return Ok(());
        }
        let object_count = world.len() as u32;
        let (kept, visible) = (self.kept.all(), self.visible.all());
        let blocks = world.blocks_in_view(f, view);
        let frustum = frustum::TestBounds { bounds: world.bounds(), blocks, kept, view: view.cull(), object_count };
        f.fill("frustum/clear_kept", &self.kept, 0);
        f.dispatch_indirect(frustum, blocks); // 1. view-frustum culling

        let mut drawn = None;
        match &mut self.rapid {
            // 2. what moved too fast to be warped
            Some(rapid) => {
                let lists = [Some(&self.list), self.hybrid.as_ref().map(Hybrid::list)];
                let lists: Vec<&DrawList> = lists.into_iter().flatten().collect();
                drawn = Some(rapid.draw_first(f, &self.gpu, world, view, target, (kept, &lists))?);
            }
            None => Rapid::skip(f, "not asked for"),
        }
        let predicted = map.has_seen();
        let mut shown = kept;
        if predicted {
            map.predict(f, world, view, drawn)?; // 3. the depth that the last frame says this one will have
            map.test(f, world, view, (kept, blocks), visible); // 4. who lies behind it everywhere
            shown = visible;
        } else {
            map.skip_first(f);
        }
        if let Some(rapid) = &self.rapid {
            shown = rapid.leave(f, world, shown);
        }
        match &mut self.hybrid {
            Some(hybrid) => shown = hybrid.hold(f, world, view, shown)?, // 5. whose boxes are tested too
            None => Hybrid::skip(f, "no object is costly enough"),
        }
        self.list.pack(f, world, shown); // 6. the others, in object order
        world.draw(f, &self.list, view, target); // 7. draw them
        if let Some(hybrid) = &self.hybrid {
            hybrid.draw_shown(f, world, view, target); // 8. and the costly ones whose boxes show
        }
        if self.kind == Kind::Exact {
            self.repaired = predicted;
            self.repair(f, predicted.then_some(blocks), world, view, target); // 9. and what was culled by mistake
        }
        if let Some(map) = &mut self.map {
            map.keep(f, world, view, target); // 10. this is the next one's last frame
        }
        if let Some(rapid) = &mut self.rapid {
            rapid.keep(f, world, view);
        }
        Ok(())
    }

    fn work(&self) -> Result<Work> {
        let boxes = match &self.hybrid {
            Some(hybrid) => hybrid.read_boxes()?.len() as u64,
            None => 0,
        };
        Ok(Work { boxes, ..Work::default() })
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        let Some(hybrid) = &self.hybrid else { return Ok(None) };
        let boxes = world.host_bounds();
        let singles = hybrid.read_boxes()?.into_iter().map(|object| boxes[object as usize]).collect();
        Ok(Some(TestedBoxes { groups: Vec::new(), singles }))
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        if let Some(map) = &mut self.map {
            map.forget();
        }
        if let Some(rapid) = &mut self.rapid {
            rapid.forget();
        }
        Ok(())
    }
}

impl Woc {
    fn new(setup: &Setup<'_>, kind: Kind) -> Result<Self> {
        let (gpu, world) = (setup.gpu, setup.world);
        let flags = |name: &str| Buffer::new(gpu, &format!("woc.{name}"), world.len(), Placement::Storage);
        let fastest = setup.options.text(options::RAPID.name).parse().unwrap_or(0.0);
        let eroded_by = |what: &str| setup.options.text(options::ERODE.name) == what;
        let (footprint, erode) = (eroded_by("footprint"), eroded_by("neighbours"));
        let close = setup.options.flag(options::CLOSE.name);
        let fill = kind == Kind::Approximate;
        let settings = Settings { fill, fastest, footprint, ..Settings::of(setup.options) };
        let costly = costly(world, setup.options);
        let hybrid = if costly.is_empty() { None } else { Some(Hybrid::new(gpu, world, &costly)?) };
        let list = |name: &str| DrawList::styled(gpu, name, world, options::commands(setup.options));
        Ok(Woc {
            gpu: gpu.clone(),
            kind,
            recipe: Recipe { settings, kind: hom::map_kind(setup.options), erode, close },
            map: None,
            kept: flags("kept")?,
            visible: flags("visible")?,
            rejected: flags("rejected")?,
            newly: flags("newly")?,
            rapid: (fastest > 0.0).then(|| Rapid::new(gpu, world, fastest)).transpose()?,
            hybrid,
            list: list("woc.list")?,
            late: list("woc.late")?,
            still: Still::new(setup.options).settled_after(SETTLED_AFTER),
            repaired: false,
        })
    }

    /// The next frames repair what was culled by mistake, as `woc-exact` does, or do not, as `woc` does.
    pub(crate) fn check(&mut self, on: bool) {
        let kind = if on { Kind::Exact } else { Kind::Conservative };
        if self.kind != kind {
            // The lists of the other kind do not hold for this one.
            self.still.forget();
            self.kind = kind;
        }
    }

    /// Objects that the last frame repaired, in percent of those that its prediction let through: at least as many as it would have missed.
    /// None if it repaired nothing that was predicted. Call between frames.
    pub(crate) fn repaired_percent(&self) -> Result<Option<f64>> {
        if !self.repaired {
            return Ok(None);
        }
        let count =
            |flags: &Buffer<u32>| Ok::<_, crate::Error>(flags.read()?.iter().filter(|flag| **flag != 0).count());
        let (repaired, shown) = (count(&self.newly)?, count(&self.visible)?);
        Ok(Some(100.0 * repaired as f64 / shown.max(1) as f64))
    }

    /// What the predicted depth hid, of the blocks in view, is tested once more, against the real depth of what was drawn, and drawn if
    /// that does not hide it: no visible object is missing then, however wrong the warp was.
    fn repair(&self, f: &mut Frame, predicted: Option<BufferRef<u32>>, world: &World, view: &View, target: &Target) {
        f.part("repair");
        match (&self.map, predicted) {
            (Some(map), Some(blocks)) => {
                let (rejected, object_count) = (self.rejected.all(), world.len() as u32);
                let (objects, excluded) = (self.kept.all(), self.visible.all());
                f.dispatch(woc::ExcludeObjects { objects, excluded, remaining: rejected, object_count }, object_count);
                map.observe(f, target);
                map.test(f, world, view, (rejected, blocks), self.newly.all());
                self.late.pack(f, world, self.newly.all());
                world.draw(f, &self.late, view, target);
            }
            _ => self.skip_repair(f, "nothing was rejected"),
        }
        f.part("");
    }

    /// Camera and objects unchanged: the last frame's lists hold, and so does the depth kept of it.
    fn same_again(&self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        World::skip_blocks(f, Still::REASON);
        f.skip(frustum::TestBounds::INFO.name, Still::REASON);
        if let Some(rapid) = &self.rapid {
            rapid.same_again(f, world, view, target);
        }
        if let Some(map) = &self.map {
            map.skip(f, Still::REASON);
        }
        self.list.skip_packing(f, Still::REASON);
        world.draw(f, &self.list, view, target);
        if let Some(hybrid) = &self.hybrid {
            hybrid.same_again(f, world, view, target);
        }
        if self.kind == Kind::Exact {
            f.part("repair");
            self.skip_repair(f, Still::REASON);
            world.draw(f, &self.late, view, target);
            f.part("");
        }
        OcclusionMap::skip_keeping(f, Still::REASON);
    }

    fn skip_repair(&self, f: &mut Frame, reason: &'static str) {
        f.skip(woc::ExcludeObjects::INFO.name, reason);
        if let Some(map) = &self.map {
            map.skip_observing(f, reason);
        }
        self.late.skip_packing(f, reason);
    }
}
