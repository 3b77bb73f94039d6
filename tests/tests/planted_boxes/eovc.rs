//! `eovc` with one defect: the thesis' own groups, not coherent, so that rays are cast.

use super::{caught, caught_at_a_size, caught_by, coarse, edit, laws, worlds, Case, Make};
use culling::boxes::{box_view, BoxList};
use culling::eovc::{mark_invocations, Tree};
use culling::{DrawList, Method, Setup, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use scenes::bvh::{Split, NO_NODE};
use shaders::eovc;
use shaders::types::{BoxView, DrawCommand, TreeNode, CULL_LEVELS, FIRST_CULL_LIST, GRID_WORDS};

/// What is wrong with the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    Nothing,
    RaysBackwards,
    /// Rays go a tenth of the picture beside their pixel.
    RaysBeside,
    /// Groups are of half the size, for the raster and for rays: one binding serves both.
    ShrunkGroups,
    /// Single objects' boxes are of half the size.
    ShrunkSingles,
    /// All is said to be hit before the first ray.
    FullFromTheStart,
    /// What was hit in earlier frames still stops rays.
    FullNotCleared,
    DroppedHit,
    DroppedGroup,
    DroppedSingle,
    /// What lies beside an occluder's path is taken for visible, so it is in no group.
    PathTooWide,
    MarksNotCleared,
    /// Leaves that reach the near plane are rasterised instead of hit.
    NearCrossingTested,
    NoLateDraw,
    /// What has come into view is not remembered.
    NewlyForgotten,
}

/// What the extraction writes: a list of nodes, drawn as boxes.
struct Listed {
    boxes: BoxList,
    /// Goes over the list's command where a defect shortens it.
    shortened: Buffer<DrawCommand>,
}

struct Broken {
    defect: Defect,
    gpu: Gpu,
    tree: Tree,
    shrunk: Buffer<TreeNode>,
    visible: [Buffer<u32>; 2],
    marked: Buffer<u32>,
    full: Buffer<u32>,
    hits: Buffer<u32>,
    unbounded: Buffer<u32>,
    newly: Buffer<u32>,
    counters: Buffer<u32>,
    touched: Buffer<u32>,
    marked_nodes: Buffer<u32>,
    starts: [Buffer<u32>; 2],
    grids: Buffer<u32>,
    no_grids: Buffer<u32>,
    no_groups: Buffer<DrawCommand>,
    open_groups: Buffer<u32>,
    open_boxes: BoxList,
    groups: Listed,
    singles: Listed,
    views: Buffer<BoxView>,
    lists: [DrawList; 2],
    frame: u32,
    now: usize,
}

fn make(setup: &Setup<'_>, defect: Defect) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let tree = Tree::new(gpu, world, Split::Sah)?;
    let objects = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Storage);
    let nodes = |name: &str| Buffer::new(gpu, name, tree.len(), Placement::Storage);
    let listed = |name: &str, len: usize| -> culling::Result<Listed> {
        Ok(Listed { boxes: BoxList::new(gpu, name, len)?, shortened: BoxList::empty_command(gpu)? })
    };
    let mut shrunk = tree.read_nodes()?;
    let mut no_grids = [0, 1, 1, 0].repeat(24);
    no_grids[0] = 1;
    shrunk
        .iter_mut()
        .for_each(|node| node.bounds.half_extent = node.bounds.half_extent.map(|half| coarse(gpu, 0.2) * 0.5 * half));
    Ok(Box::new(Broken {
        defect,
        gpu: gpu.clone(),
        shrunk: Buffer::with_data(gpu, "broken.shrunk", &shrunk, Placement::Storage)?,
        visible: [objects("broken.visible_even")?, objects("broken.visible_odd")?],
        marked: nodes("broken.marked")?,
        full: nodes("broken.full")?,
        hits: objects("broken.hits")?,
        unbounded: Buffer::with_data(gpu, "broken.unbounded", tree.unbounded(), Placement::Storage)?,
        newly: objects("broken.newly")?,
        counters: Buffer::new(gpu, "broken.counters", 3, Placement::Storage)?,
        marked_nodes: nodes("broken.marked_nodes")?,
        starts: [nodes("broken.starts_even")?, nodes("broken.starts_odd")?],
        grids: Buffer::new(gpu, "broken.grids", no_grids.len(), Placement::Storage)?,
        no_grids: Buffer::with_data(gpu, "broken.no_grids", &no_grids, Placement::Storage)?,
        open_groups: nodes("broken.open_groups")?,
        open_boxes: BoxList::new(gpu, "broken.open_boxes", 0)?,
        touched: nodes("broken.touched")?,
        no_groups: BoxList::empty_command(gpu)?,
        groups: listed("broken.groups", tree.len())?,
        singles: listed("broken.singles", tree.len())?,
        views: Buffer::new(gpu, "broken.views", 1, Placement::Upload)?,
        lists: [DrawList::new(gpu, "broken.early", world)?, DrawList::new(gpu, "broken.late", world)?],
        frame: 2,
        now: 0,
        tree,
    }))
}

/// `culling::eovc` as it is, but for the defect.
impl Method for Broken {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        self.tree.follow(world)?;
        self.views.write(&[self.looks(view)])?;
        self.now = 1 - self.now;
        self.frame += 1;
        f.fill("eovc/clear_flags", &self.visible[self.now], 0);
        self.lists[0].pack(f, world, self.visible[1 - self.now].all());
        world.draw_flagged(f, &self.lists[0], self.visible[self.now].all(), view, target);
        self.clear(f);
        if !self.tree.is_empty() {
            self.mark(f, world)?;
            self.extract(f, view)?;
            self.query(f, target)?;
        }
        self.draw_late(f, world, view, target)
    }

    fn forget(&mut self) -> culling::Result<()> {
        self.visible.iter_mut().try_for_each(|flags| Ok(flags.write(&vec![0; flags.len()])?))
    }
}

impl Broken {
    fn looks(&self, view: &View) -> BoxView {
        let mut looks = box_view(view);
        let [along, across, _] = looks.direction;
        match self.defect {
            Defect::RaysBackwards => looks.direction = looks.direction.map(|part| part.map(|part| -part)),
            Defect::RaysBeside => looks.direction[0] = [0, 1, 2].map(|axis| along[axis] + 0.2 * across[axis]),
            _ => (),
        }
        looks
    }

    fn clear(&self, f: &mut Frame) {
        if self.defect == Defect::FullFromTheStart {
            f.fill("broken/fill_full", &self.full, self.frame);
        }
        f.copy("eovc/clear_hits", self.unbounded.all(), self.hits.all());
        f.copy("eovc/clear_lists", self.no_grids.all(), self.grids.all());
        self.groups.boxes.clear(f, "eovc/clear_groups", &self.no_groups);
        self.singles.boxes.clear(f, "eovc/clear_groups", &self.no_groups);
        self.open_boxes.clear(f, "eovc/clear_open", &self.no_groups);
    }

    /// The frame's number as marks have it.
    fn mark_of_frame(&self) -> u32 {
        if self.defect == Defect::MarksNotCleared {
            3
        } else {
            self.frame
        }
    }

    fn mark(&mut self, f: &mut Frame, world: &World) -> culling::Result<()> {
        let mark = eovc::MarkPaths {
            occluders: self.visible[self.now].all(),
            leaves: self.tree.leaves(),
            nodes: self.tree.nodes(),
            marked: self.marked.all(),
            visible: self.marked_nodes.all(),
            grids: self.grids.all(),
            object_count: world.len() as u32,
            frame: self.mark_of_frame(),
        };
        f.dispatch(mark, mark_invocations(world.len() as u32));
        if self.defect == Defect::PathTooWide {
            let (parents, frame) = (self.tree.host().parents(), self.frame);
            edit(f, &mut self.marked, |marked| {
                let right = marked.to_vec();
                for node in (1..marked.len()).filter(|node| parents[*node] != NO_NODE) {
                    if right[parents[node] as usize] == frame {
                        marked[node] = frame;
                    }
                }
            })?;
        }
        Ok(())
    }

    fn extract(&mut self, f: &mut Frame, view: &View) -> culling::Result<()> {
        let (nodes, grids) = (self.tree.nodes(), self.grids.all());
        let extract = eovc::ExtractGroups {
            nodes,
            marked: self.marked.all(),
            visible: self.marked_nodes.all(),
            groups: self.starts[0].all(),
            grids,
            frame: self.mark_of_frame(),
        };
        f.dispatch_indirect(extract, grids);
        for pass in 0..self.tree.depth() / CULL_LEVELS + 1 {
            let list = FIRST_CULL_LIST + pass;
            let cull = eovc::CullGroups {
                nodes,
                starts: self.starts[pass as usize % 2].all(),
                unfinished: self.starts[1 - pass as usize % 2].all(),
                grids,
                groups: self.groups.boxes.listed(),
                group_command: self.groups.boxes.command(),
                singles: self.singles.boxes.listed(),
                single_command: self.singles.boxes.command(),
                hits: self.hits.all(),
                touched: self.touched.all(),
                view: view.cull(),
                frame: self.frame,
                list,
                constants: eovc::CullGroupsConstants { coherent: false },
            };
            f.dispatch_indirect(cull, grids.from((list * GRID_WORDS) as usize));
        }
        match self.defect {
            Defect::DroppedGroup => self.groups.drop_last(&self.gpu, f),
            Defect::DroppedSingle => self.singles.drop_last(&self.gpu, f),
            Defect::NearCrossingTested => self.list_hits(f),
            _ => Ok(()),
        }
    }

    /// Hits become singles.
    fn list_hits(&mut self, f: &mut Frame) -> culling::Result<()> {
        let hits = f.read(&self.hits)?;
        edit(f, &mut self.hits, |hits| hits.fill(0))?;
        let mut listed = self.gpu.read_bound::<u32>(&self.singles.boxes.listed().into())?;
        let mut command = self.gpu.read_bound::<DrawCommand>(&self.singles.boxes.command().into())?;
        for object in (0..hits.len()).filter(|object| hits[*object] != 0) {
            listed[command[0].instance_count as usize] = self.tree.host().leaf_of_object()[object];
            command[0].instance_count += 1;
        }
        let listed = Buffer::with_data(&self.gpu, "broken.listed", &listed, Placement::Storage)?;
        self.singles.shortened.write(&command)?;
        f.copy("broken/list", listed.all(), self.singles.boxes.listed());
        f.copy("broken/list", self.singles.shortened.all(), self.singles.boxes.command());
        f.submit_and_wait()?;
        Ok(())
    }

    fn query(&mut self, f: &mut Frame, target: &Target) -> culling::Result<()> {
        let shrunk_if = |defect: Defect| if self.defect == defect { self.shrunk.all() } else { self.tree.nodes() };
        let query = eovc::QueryGroups {
            nodes: shrunk_if(Defect::ShrunkGroups),
            groups: self.groups.boxes.listed(),
            views: self.views.all(),
            touched: self.touched.all(),
            open_groups: self.open_groups.all(),
            open_command: self.open_boxes.command(),
            frame: self.frame,
        };
        f.test_boxes(query, self.groups.boxes.draw(), &target.test_only());
        let cast = eovc::CastRays {
            nodes: shrunk_if(Defect::ShrunkGroups),
            open_groups: self.open_groups.all(),
            views: self.views.all(),
            full: self.full.all(),
            hits: self.hits.all(),
            counters: self.counters.all(),
            depth: target.depth,
            touched: self.touched.all(),
            frame: if self.defect == Defect::FullNotCleared { 3 } else { self.frame },
            constants: eovc::CastRaysConstants::default(),
        };
        f.test_boxes(cast, self.open_boxes.draw(), &target.test_only());
        let test = eovc::TestSingles {
            nodes: shrunk_if(Defect::ShrunkSingles),
            singles: self.singles.boxes.listed(),
            views: self.views.all(),
            hits: self.hits.all(),
            touched: self.touched.all(),
            frame: self.frame,
        };
        f.test_boxes(test, self.singles.boxes.draw(), &target.test_only());
        if self.defect == Defect::DroppedHit {
            edit(f, &mut self.hits, |hits| hits.iter_mut().filter(|hit| **hit != 0).take(1).for_each(|hit| *hit = 0))?;
        }
        Ok(())
    }

    fn draw_late(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        let select = eovc::SelectOccludees {
            hits: self.hits.all(),
            drawn: self.visible[1 - self.now].all(),
            newly: self.newly.all(),
            object_count: world.len() as u32,
        };
        f.dispatch(select, world.len() as u32);
        self.lists[1].pack(f, world, self.newly.all());
        match self.defect {
            Defect::NoLateDraw => (),
            Defect::NewlyForgotten => world.draw(f, &self.lists[1], view, target),
            _ => world.draw_flagged(f, &self.lists[1], self.visible[self.now].all(), view, target),
        }
        Ok(())
    }
}

impl Listed {
    /// Takes the last off the list, if there is one.
    fn drop_last(&mut self, gpu: &Gpu, f: &mut Frame) -> culling::Result<()> {
        f.submit_and_wait()?;
        let mut command = gpu.read_bound::<DrawCommand>(&self.boxes.command().into())?;
        command[0].instance_count = command[0].instance_count.saturating_sub(1);
        self.shortened.write(&command)?;
        f.copy("broken/list", self.shortened.all(), self.boxes.command());
        Ok(())
    }
}

/// A small picture: each pixel of an open group casts a ray.
fn small() -> Case {
    worlds::walled(150).sized([80, 49])
}

const SOUND: Make = |setup| make(setup, Defect::Nothing);

#[test]
fn rays_that_go_backwards_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::RaysBackwards)], &small());
}

#[test]
fn rays_beside_their_pixel_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::RaysBeside)], &small());
}

#[test]
fn groups_that_are_too_small_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::ShrunkGroups)], &small());
}

#[test]
fn boxes_of_single_objects_that_are_too_small_are_noticed() {
    let sizes = [[80, 49], [161, 97], [640, 386]];
    caught_at_a_size([SOUND, |setup| make(setup, Defect::ShrunkSingles)], &worlds::special::creeping(), sizes);
}

#[test]
fn rays_that_stop_too_early_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::FullFromTheStart)], &small());
    caught([SOUND, |setup| make(setup, Defect::FullNotCleared)], &small());
}

#[test]
fn a_dropped_hit_is_noticed() {
    caught([SOUND, |setup| make(setup, Defect::DroppedHit)], &small());
}

#[test]
fn a_group_left_out_is_noticed() {
    caught([SOUND, |setup| make(setup, Defect::DroppedGroup)], &small());
    caught([SOUND, |setup| make(setup, Defect::DroppedSingle)], &small());
}

#[test]
fn paths_marked_too_wide_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::PathTooWide)], &small());
}

#[test]
fn marks_of_earlier_frames_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::MarksNotCleared)], &small());
}

#[test]
fn boxes_at_the_near_plane_that_are_not_kept_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::NearCrossingTested)], &worlds::special::stepping_into_boxes());
}

#[test]
fn a_missing_late_draw_is_noticed() {
    caught([SOUND, |setup| make(setup, Defect::NoLateDraw)], &small());
}

#[test]
fn forgetting_what_came_into_view_is_noticed() {
    let makes: [Make; 2] = [SOUND, |setup| make(setup, Defect::NewlyForgotten)];
    caught_by(laws::what_a_wall_hides_is_culled, makes, &worlds::walled(400).sized([80, 49]), "too many");
}
