//! `eovc`: efficient object visibility culling with screen-space ray casting (EOVC thesis III). What the last frame saw is
//! drawn first; the hierarchy's nodes beside what still shows are occludee groups; their boxes are rasterised, and where one is
//! open a ray finds which objects in it may show.

mod tree;
pub mod twin;

pub use tree::Tree;

use crate::boxes::BoxList;
use crate::pack::DrawList;
use crate::world::Still;
use crate::{Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Buffer, Frame, Placement, Target};
use scenes::bvh::Split;
use shaders::types::DrawCommand;
use shaders::{eovc, Stage};

/// How the hierarchy is split, and which groups are opened before they are rasterised.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    OptionInfo {
        name: "bvh",
        default: "sah",
        values: "sah|middle|equal",
        help: "how the hierarchy is split (thesis, table 4)",
    },
    OptionInfo {
        name: "coherent",
        default: "true",
        values: "true|false",
        help: "open groups that the last frame saw into, instead of casting rays there again; false is the thesis",
    },
    OptionInfo {
        name: "pixels",
        default: "16",
        values: "1..=67108864",
        help: "pixels that a group may cover of which nothing is known (16 times more if it was hidden); larger ones are opened",
    },
];

/// Frames of an unchanged view after which the lists hold: what is hidden leaves the early list one frame after it is drawn,
/// and what it had let through may leave in the next two.
const SETTLED_AFTER: u32 = 4;

struct Eovc {
    tree: Tree,
    visible: [Buffer<u32>; 2],
    marked: Buffer<u32>,
    full: Buffer<u32>,
    hits: Buffer<u32>,
    unbounded: Buffer<u32>,
    newly: Buffer<u32>,
    counters: Buffer<u32>,
    no_groups: Buffer<DrawCommand>,
    groups: BoxList,
    singles: BoxList,
    early: DrawList,
    late: DrawList,
    tested: Buffer<u32>,
    touched: Buffer<u32>,
    coherent: bool,
    most_pixels: u32,
    frame: u32,
    counting: bool,
    now: usize,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let split = match setup.options.text("bvh") {
        "middle" => Split::Middle,
        "equal" => Split::EqualCount,
        _ => Split::Sah,
    };
    let tree = Tree::new(gpu, world, split)?;
    let objects = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Storage);
    let nodes = |name: &str| Buffer::new(gpu, name, tree.len(), Placement::Storage);
    Ok(Box::new(Eovc {
        visible: [objects("eovc.visible_even")?, objects("eovc.visible_odd")?],
        marked: nodes("eovc.marked")?,
        full: nodes("eovc.full")?,
        hits: objects("eovc.hits")?,
        unbounded: Buffer::with_data(gpu, "eovc.unbounded", tree.unbounded(), Placement::Storage)?,
        newly: objects("eovc.newly")?,
        counters: Buffer::new(gpu, "eovc.counters", 2, Placement::Storage)?,
        no_groups: BoxList::empty_command(gpu)?,
        groups: BoxList::new(gpu, "eovc.groups", tree.len())?,
        singles: BoxList::new(gpu, "eovc.singles", world.len())?,
        early: DrawList::new(gpu, "eovc.early", world)?,
        late: DrawList::new(gpu, "eovc.late", world)?,
        tested: nodes("eovc.tested")?,
        touched: nodes("eovc.touched")?,
        coherent: setup.options.flag("coherent"),
        most_pixels: setup.options.number("pixels"),
        frame: 2,
        counting: false,
        now: 0,
        still: Still::new(setup.options).settled_after(SETTLED_AFTER),
        tree,
    }))
}

impl Method for Eovc {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.still.holds(world, view) {
            return self.same_again(f, world, view, target);
        }
        self.tree.follow(world)?;
        self.groups.look(view)?;
        self.singles.look(view)?;
        self.now = 1 - self.now;
        self.frame += 1;
        self.map_occluders(f, world, view, target); // 1. occlusion mapping
        self.extract_groups(f, world, view); // 2. occludee group extraction
        self.query_groups(f, target); // 3. batch occlusion query
        self.render_occludees(f, world, view, target); // 4. occludee rendering
        f.part("");
        Ok(()) // 5. what was flagged in 1 and 4 are the next frame's occluders
    }

    fn count_work(&mut self, on: bool) {
        self.counting = on;
    }

    fn work(&self) -> Result<Work> {
        let counted = self.counters.read()?;
        let boxes = u64::from(self.groups.read_len()?) + u64::from(self.singles.read_len()?);
        Ok(Work { boxes, rays: counted[0].into(), node_visits: counted[1].into(), queries: 0 })
    }

    fn tested_boxes(&self, _world: &World) -> Result<Option<TestedBoxes>> {
        let of = |list: &BoxList| -> Result<Vec<scenes::Aabb>> {
            Ok(list.read_listed()?.into_iter().map(|node| self.tree.host().nodes()[node as usize].bounds).collect())
        };
        Ok(Some(TestedBoxes { groups: of(&self.groups)?, singles: of(&self.singles)? }))
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        self.frame += 1; // what was tested and touched before is older than the last frame
        self.visible.iter_mut().try_for_each(|flags| Ok(flags.write(&vec![0; flags.len()])?))
    }
}

impl Eovc {
    /// Draws what the last frame saw, and flags what still shows: the effective occluders (III.2).
    fn map_occluders(&self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        f.part("mapping");
        let (potential, effective) = (&self.visible[1 - self.now], &self.visible[self.now]);
        f.fill("eovc/clear_flags", effective, 0);
        self.early.pack(f, world, potential.all());
        world.draw_flagged(f, &self.early, effective.all(), view, target);
    }

    /// Climbs from each effective occluder to the root; what lies beside the way is a group (III.3).
    fn extract_groups(&self, f: &mut Frame, world: &World, view: &View) {
        f.part("groups");
        f.fill("eovc/clear_marks", &self.marked, 0);
        f.fill("eovc/clear_full", &self.full, 0);
        f.copy("eovc/clear_hits", self.unbounded.all(), self.hits.all());
        self.groups.clear(f, "eovc/clear_groups", &self.no_groups);
        self.singles.clear(f, "eovc/clear_groups", &self.no_groups);
        if self.tree.is_empty() {
            return;
        }
        let object_count = world.len() as u32;
        let mark = eovc::MarkPaths {
            occluders: self.visible[self.now].all(),
            leaves: self.tree.leaves(),
            nodes: self.tree.nodes(),
            marked: self.marked.all(),
            object_count,
        };
        f.dispatch(mark, object_count);
        let extract = eovc::ExtractGroups {
            nodes: self.tree.nodes(),
            marked: self.marked.all(),
            groups: self.groups.listed(),
            group_command: self.groups.command(),
            singles: self.singles.listed(),
            single_command: self.singles.command(),
            hits: self.hits.all(),
            view: view.cull(),
            node_count: self.tree.len() as u32,
            tested: self.tested.all(),
            touched: self.touched.all(),
            frame: self.frame,
            most_pixels: self.most_pixels,
            constants: eovc::ExtractGroupsConstants { coherent: self.coherent },
        };
        f.dispatch(extract, self.tree.len() as u32);
    }

    /// Rasterises the groups' boxes against the occluders' depth; a ray from each open pixel flags what it meets (III.4).
    fn query_groups(&self, f: &mut Frame, target: &Target) {
        f.part("query");
        if self.counting {
            f.fill("eovc/clear_counters", &self.counters, 0);
        }
        let query = eovc::QueryGroups {
            nodes: self.tree.nodes(),
            groups: self.groups.listed(),
            views: self.groups.view(),
            full: self.full.all(),
            hits: self.hits.all(),
            counters: self.counters.all(),
            depth: target.depth,
            touched: self.touched.all(),
            frame: self.frame,
            constants: eovc::QueryGroupsConstants { count: self.counting },
        };
        f.test_boxes(query, self.groups.draw(), &target.test_only());
        let test = eovc::TestSingles {
            nodes: self.tree.nodes(),
            singles: self.singles.listed(),
            views: self.singles.view(),
            hits: self.hits.all(),
            touched: self.touched.all(),
            frame: self.frame,
        };
        f.test_boxes(test, self.singles.draw(), &target.test_only());
        if self.coherent {
            let (nodes, touched, node_count) = (self.tree.nodes(), self.touched.all(), self.tree.len() as u32);
            f.dispatch(eovc::TouchPaths { nodes, touched, node_count, frame: self.frame }, node_count);
        } else {
            f.skip(eovc::TouchPaths::INFO.name, "not coherent");
        }
    }

    /// Draws the objects that rays have met, and flags what shows (III.5).
    fn render_occludees(&self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        f.part("occludees");
        let select = eovc::SelectOccludees {
            hits: self.hits.all(),
            drawn: self.visible[1 - self.now].all(),
            newly: self.newly.all(),
            object_count: world.len() as u32,
        };
        f.dispatch(select, world.len() as u32);
        self.late.pack(f, world, self.newly.all());
        world.draw_flagged(f, &self.late, self.visible[self.now].all(), view, target);
    }

    /// Camera and objects unchanged: the last frame's lists hold.
    fn same_again(&self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        for (part, list) in [("mapping", &self.early), ("occludees", &self.late)] {
            f.part(part);
            list.skip_packing(f, Still::REASON);
            world.draw(f, list, view, target);
        }
        f.part("groups");
        f.skip(eovc::MarkPaths::INFO.name, Still::REASON);
        f.skip(eovc::ExtractGroups::INFO.name, Still::REASON);
        f.part("query");
        for stage in [eovc::QueryGroups::INFO, eovc::TestSingles::INFO, eovc::TouchPaths::INFO] {
            f.skip(stage.name, Still::REASON);
        }
        f.part("");
        Ok(())
    }
}
