//! `eovc`: efficient object visibility culling with screen-space ray casting (EOVC thesis III). What the last frame saw is
//! drawn first; the hierarchy's nodes beside what still shows are occludee groups; their boxes are rasterised, and where one is
//! open a ray finds which objects in it may show.
//!
//! Where this is not the thesis, and why:
//! - Boxes are rasterised by a stage that only says which groups are open, and once more, for those alone, by the stage that
//!   casts rays. On a CPU device a fragment that is stopped early costs as much as the shader it might have run is long; on a
//!   GPU it is a small draw more.
//! - A group that a recent frame saw into is opened before it is rasterised (`coherent`): in 94,000 objects 20 rays a frame
//!   instead of 129,000, and 680 boxes instead of 547. A GPU, where rays cost less and boxes more, may gain from `coherent=false`.
//! - Occluders are filtered every fourth frame (`every`), as writing and reading the item buffer costs a fifth of the drawing.
//! - Groups of one object need no ray: an open fragment of the box says as much.
//! - Without any occluder depth is empty, and all in the view volume is drawn instead of hit by rays.

mod groups;
mod options;
pub mod twin;

pub use crate::tree::Tree;
pub use groups::mark_invocations;
pub use options::OPTIONS;

use crate::boxes::BoxList;
use crate::pack::DrawList;
use crate::world::{LastToFirst, Still};
use crate::{Error, Method, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Buffer, Frame, Placement, Target};
use groups::Groups;
use shaders::types::{DrawCommand, FILTER_STRIP, OPEN_FRAMES};
use shaders::{eovc, BufferRef, ImageRef, Stage};

/// Frames of an unchanged view after which the lists hold: what is hidden leaves the early list one frame after it is drawn,
/// and what it had let through may leave in the next two.
const SETTLED_AFTER: u32 = 4;

/// The number of a frame before the first: what was seen in frame 0 is no longer remembered.
const FIRST_FRAME: u32 = 2 * OPEN_FRAMES;

struct Eovc {
    tree: Tree,
    groups: Groups,
    /// Objects that an earlier frame saw, and those that this one sees: potential and next occluders.
    visible: [Buffer<u32>; 2],
    full: Buffer<u32>,
    hits: Buffer<u32>,
    unbounded: Buffer<u32>,
    newly: Buffer<u32>,
    counters: Buffer<u32>,
    open_groups: Buffer<u32>,
    open_boxes: BoxList,
    no_boxes: Buffer<DrawCommand>,
    early: DrawList,
    late: DrawList,
    /// There if occluders are filtered.
    order: Option<LastToFirst>,
    /// Frames from one filtering to the next, and frames until the next one.
    every: u32,
    until_filtering: u32,
    filters_now: bool,
    read_back: bool,
    frame: u32,
    counting: bool,
    leaves_out_details: bool,
    standard_depth: bool,
    now: usize,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world, options) = (setup.gpu, setup.world, setup.options);
    let tree = Tree::new(gpu, world, crate::tree::split(options))?;
    let objects = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Storage);
    let nodes = |name: &str| Buffer::new(gpu, name, tree.len(), Placement::Storage);
    Ok(Box::new(Eovc {
        groups: Groups::new(setup, &tree)?,
        visible: [objects("eovc.visible_even")?, objects("eovc.visible_odd")?],
        full: nodes("eovc.full")?,
        hits: objects("eovc.hits")?,
        unbounded: Buffer::with_data(gpu, "eovc.unbounded", tree.unbounded(), Placement::Storage)?,
        newly: objects("eovc.newly")?,
        counters: Buffer::new(gpu, "eovc.counters", 3, Placement::Storage)?,
        open_groups: nodes("eovc.open_groups")?,
        open_boxes: box_list(setup, "eovc.open_boxes", 0)?,
        no_boxes: BoxList::empty_command(gpu)?,
        early: DrawList::styled(gpu, "eovc.early", world, options::commands(options))?,
        late: DrawList::styled(gpu, "eovc.late", world, options::commands(options))?,
        order: if options.flag("of") { Some(LastToFirst::new(gpu, world)?) } else { None },
        every: options.number("every"),
        until_filtering: 0,
        filters_now: false,
        read_back: options.flag("cr"),
        frame: FIRST_FRAME,
        counting: false,
        leaves_out_details: false,
        standard_depth: gpu.depth().is_standard(),
        now: 0,
        still: Still::new(options).settled_after(SETTLED_AFTER),
        tree,
    }))
}

/// Box draws of frames that read counters back have no count on the GPU, as their other draws have none.
fn box_list(setup: &Setup<'_>, name: &str, len: usize) -> Result<BoxList> {
    let list = BoxList::new(setup.gpu, name, len)?;
    Ok(if setup.options.flag("cr") { list.without_count() } else { list })
}

impl Method for Eovc {
    fn needs_items(&self, world: &World, view: &View) -> bool {
        self.is_filtering_due(world, view) && !self.still.would_hold(world, view)
    }

    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        self.filters_now = self.is_filtering_due(world, view);
        if self.still.holds(world, view) {
            self.tree.rest();
            return self.same_again(f, world, view, target);
        }
        self.tree.follow(world)?;
        self.groups.groups.look(view)?;
        self.leaves_out_details = view.detail_px() > 0.0;
        self.now = 1 - self.now;
        self.frame += 1;
        self.map_occluders(f, world, view, target)?; // 1. occlusion mapping
        self.extract_groups(f, view); // 2. occludee group extraction
        self.query_groups(f, target)?; // 3. batch occlusion query
        self.render_occludees(f, world, view, target)?; // 4. occludee rendering
        self.choose_occluders(f, target)?; // 5. the next frame's occluders
        self.until_filtering = if self.filters_now { self.every - 1 } else { self.until_filtering.saturating_sub(1) };
        Ok(())
    }

    fn count_work(&mut self, on: bool) {
        self.counting = on;
    }

    fn work(&self) -> Result<Work> {
        let counted = self.counters.read()?;
        let boxes = u64::from(self.groups.groups.read_len()?) + u64::from(self.groups.singles.read_len()?);
        let [rays, node_visits, early_stops] = [0, 1, 2].map(|counter| u64::from(counted[counter]));
        Ok(Work { boxes, rays, node_visits, early_stops, refits: self.tree.refitted(), ..Work::default() })
    }

    fn tested_boxes(&self, _world: &World) -> Result<Option<TestedBoxes>> {
        let of = |list: &BoxList| -> Result<Vec<scenes::Aabb>> {
            Ok(list.read_listed()?.into_iter().map(|node| self.tree.host().nodes()[node as usize].bounds).collect())
        };
        Ok(Some(TestedBoxes { groups: of(&self.groups.groups)?, singles: of(&self.groups.singles)? }))
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        self.until_filtering = 0;
        self.frame += FIRST_FRAME; // what was seen before is long ago
        self.visible.iter_mut().try_for_each(|flags| Ok(flags.write(&vec![0; flags.len()])?))
    }
}

impl Eovc {
    /// Occluders are filtered, in this frame or others.
    fn filters(&self) -> bool {
        self.order.is_some()
    }

    /// Every few frames, and while nothing changes: then how long that lasts does not show in what follows.
    fn is_filtering_due(&self, world: &World, view: &View) -> bool {
        self.filters() && (self.until_filtering == 0 || self.still.same(world, view))
    }

    /// Draws what the last frame saw: the potential occluders. Those of which a fragment passes the early tests are effective
    /// (III.2). With occluder filtering all are taken for effective: each owned a pixel not long ago.
    fn map_occluders(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        f.part("mapping");
        let (potential, seen) = (self.visible[1 - self.now].all(), self.visible[self.now].all());
        if self.filters() && !self.filters_now {
            f.copy("eovc/keep_occluders", potential, seen);
        } else {
            f.fill("eovc/clear_flags", &self.visible[self.now], 0);
        }
        self.early.pack(f, world, potential);
        if self.read_back {
            self.early.read_back(f)?;
        }
        if self.filters() {
            world.draw(f, &self.early, view, target);
        } else {
            world.draw_flagged(f, &self.early, seen, view, target);
        }
        Ok(())
    }

    /// Climbs from each effective occluder to the root; what lies beside the way is a group (III.3).
    fn extract_groups(&self, f: &mut Frame, view: &View) {
        f.part("groups");
        f.copy("eovc/clear_hits", self.unbounded.all(), self.hits.all());
        if self.tree.is_empty() {
            f.skip(eovc::ExtractGroups::INFO.name, NO_OBJECTS);
            return;
        }
        let effective = if self.filters() { &self.visible[1 - self.now] } else { &self.visible[self.now] };
        self.groups.extract(f, &self.tree, effective.all(), self.hits.all(), view, self.frame);
    }

    /// Rasterises the groups' boxes against the occluders' depth; a ray from each open pixel flags what it meets (III.4).
    fn query_groups(&self, f: &mut Frame, target: &Target) -> Result<()> {
        f.part("query");
        if self.counting {
            f.fill("eovc/clear_counters", &self.counters, 0);
        }
        if self.tree.is_empty() {
            f.skip(eovc::QueryGroups::INFO.name, NO_OBJECTS);
            return Ok(());
        }
        let [groups, singles] = [&self.groups.groups, &self.groups.singles];
        // Without a read-back only the GPU knows, and draws no instance.
        let [groups, singles] = if self.read_back { [groups.read_back(f)?, singles.read_back(f)?] } else { [1, 1] };
        if groups > 0 {
            self.query(f, target);
            self.cast_rays(f, target);
        } else {
            f.skip(eovc::QueryGroups::INFO.name, NO_GROUPS);
            f.skip(eovc::CastRays::INFO.name, NO_GROUPS);
        }
        if singles > 0 {
            self.test_singles(f, target);
        } else {
            f.skip(eovc::TestSingles::INFO.name, NO_GROUPS);
        }
        Ok(())
    }

    fn query(&self, f: &mut Frame, target: &Target) {
        self.open_boxes.clear(f, "eovc/clear_open", &self.no_boxes);
        let query = eovc::QueryGroups {
            nodes: self.tree.nodes(),
            groups: self.groups.groups.listed(),
            views: self.groups.groups.view(),
            touched: self.groups.touched.all(),
            open_groups: self.open_groups.all(),
            open_command: self.open_boxes.command(),
            frame: self.frame,
        };
        f.test_boxes(query, self.groups.groups.draw(), &target.test_only());
    }

    fn cast_rays(&self, f: &mut Frame, target: &Target) {
        let cast = eovc::CastRays {
            nodes: self.tree.nodes(),
            open_groups: self.open_groups.all(),
            views: self.groups.groups.view(),
            full: self.full.all(),
            hits: self.hits.all(),
            counters: self.counters.all(),
            depth: target.depth,
            touched: self.groups.touched.all(),
            frame: self.frame,
            constants: eovc::CastRaysConstants {
                count: self.counting,
                detail: self.leaves_out_details,
                standard_depth: self.standard_depth,
            },
        };
        f.test_boxes(cast, self.open_boxes.draw(), &target.test_only());
    }

    fn test_singles(&self, f: &mut Frame, target: &Target) {
        let test = eovc::TestSingles {
            nodes: self.tree.nodes(),
            singles: self.groups.singles.listed(),
            views: self.groups.groups.view(),
            hits: self.hits.all(),
            touched: self.groups.touched.all(),
            frame: self.frame,
        };
        f.test_boxes(test, self.groups.singles.draw(), &target.test_only());
    }

    /// Draws the objects that rays have met, and flags what shows (III.5).
    fn render_occludees(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        f.part("occludees");
        let select = eovc::SelectOccludees {
            hits: self.hits.all(),
            drawn: self.visible[1 - self.now].all(),
            newly: self.newly.all(),
            object_count: world.len() as u32,
        };
        f.dispatch(select, world.len() as u32);
        self.late.pack(f, world, self.newly.all());
        if self.read_back {
            self.late.read_back(f)?;
        }
        let seen = self.visible[self.now].all();
        match &self.order {
            // Of two that are as near the owner of the last frame stays: otherwise they would take turns as occluders.
            Some(order) => {
                let flags = if self.filters_now { None } else { Some(seen) };
                world.draw_behind(f, &self.late, order, flags, view, target);
            }
            None => world.draw_flagged(f, &self.late, seen, view, target),
        }
        Ok(())
    }

    /// The next frame's potential occluders are those flagged while drawing, or, filtered, those in front (III.6.2). Between
    /// two filterings occluders stay and what shows is added: most frames then need no item buffer.
    fn choose_occluders(&self, f: &mut Frame, target: &Target) -> Result<()> {
        f.part("filtering");
        if self.filters_now {
            let Some(owners) = target.item else {
                let needs = "the item buffer for occluder filtering; bind it, or set eovc.of=false".into();
                return Err(Error::Missing { method: "eovc", needs });
            };
            filter_occluders(f, owners, target.size, self.visible[self.now].all());
        } else {
            let reason = if self.filters() { "filtered a few frames ago" } else { "occluder filtering is off" };
            f.skip(eovc::FilterOccluders::INFO.name, reason);
        }
        f.part("");
        Ok(())
    }

    /// Camera and objects unchanged: the last frame's lists hold.
    fn same_again(&self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        for (part, list) in [("mapping", &self.early), ("occludees", &self.late)] {
            f.part(part);
            list.skip_packing(f, Still::REASON);
            match &self.order {
                Some(order) if part == "occludees" => world.draw_behind(f, list, order, None, view, target),
                _ => world.draw(f, list, view, target),
            }
        }
        let stages = [
            ("groups", eovc::MarkPaths::INFO),
            ("groups", eovc::ExtractGroups::INFO),
            ("groups", eovc::CullGroups::INFO),
            ("query", eovc::QueryGroups::INFO),
            ("query", eovc::CastRays::INFO),
            ("query", eovc::TestSingles::INFO),
            ("filtering", eovc::FilterOccluders::INFO),
        ];
        for (part, stage) in stages {
            f.part(part);
            f.skip(stage.name, Still::REASON);
        }
        f.part("");
        Ok(())
    }
}

const NO_OBJECTS: &str = "no objects";
const NO_GROUPS: &str = "no groups";

/// Flags whoever owns a pixel of an item buffer of this size (EOVC thesis III.6.2).
pub(crate) fn filter_occluders(f: &mut Frame, owners: ImageRef, size_px: [u32; 2], occluders: BufferRef<u32>) {
    let strips = [size_px[0].div_ceil(2), size_px[1].div_ceil(FILTER_STRIP)];
    f.dispatch(eovc::FilterOccluders { owners, occluders, size_px, strips }, strips[0] * strips[1]);
}
