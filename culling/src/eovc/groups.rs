//! Occludee group extraction (EOVC thesis III.3), on the GPU.

use super::Tree;
use crate::boxes::BoxList;
use crate::{Result, Setup, View};
use engine::{Buffer, Frame, Placement};
use shaders::types::{DrawCommand, CULL_LEVELS, FIRST_CULL_LIST, GRID_WORDS, MARK_CHUNK};
use shaders::{eovc, BufferRef};

/// Invocations of `eovc/mark_paths` that look at so many objects.
pub fn mark_invocations(object_count: u32) -> u32 {
    object_count.div_ceil(MARK_CHUNK)
}

/// The groups of a frame, and what earlier frames know of the hierarchy's nodes. Marks are the numbers of frames, so that
/// nothing need be cleared.
pub(super) struct Groups {
    /// Groups of several objects, as nodes.
    pub groups: BoxList,
    /// Groups of one object, as nodes.
    pub singles: BoxList,
    /// The last frame in which a pixel saw into each node.
    pub touched: Buffer<u32>,
    marked: Buffer<u32>,
    visible: Buffer<u32>,
    starts: [Buffer<u32>; 2],
    grids: Buffer<u32>,
    no_grids: Buffer<u32>,
    no_boxes: Buffer<DrawCommand>,
    /// Opens groups by what recent frames saw; false is the thesis.
    coherent: bool,
}

/// Lists that are enough for every tree: a pass more than a tree of the greatest depth takes.
const LISTS: usize = (FIRST_CULL_LIST + scenes::bvh::DEPTH_LIMIT / CULL_LEVELS + 2) as usize;

impl Groups {
    pub fn new(setup: &Setup<'_>, tree: &Tree) -> Result<Self> {
        let gpu = setup.gpu;
        let nodes = |name: &str| Buffer::new(gpu, name, tree.len(), Placement::Storage);
        // Empty, but the first pass over marked nodes runs once even so: without one the root is the group.
        let mut no_grids = [0, 1, 1, 0].repeat(LISTS);
        no_grids[0] = 1;
        Ok(Groups {
            groups: super::box_list(setup, "eovc.groups", tree.len())?,
            singles: super::box_list(setup, "eovc.singles", tree.len())?,
            touched: nodes("eovc.touched")?,
            marked: nodes("eovc.marked")?,
            visible: nodes("eovc.visible_nodes")?,
            starts: [nodes("eovc.starts_even")?, nodes("eovc.starts_odd")?],
            grids: Buffer::new(gpu, "eovc.grids", no_grids.len(), Placement::Storage)?,
            no_grids: Buffer::with_data(gpu, "eovc.no_grids", &no_grids, Placement::Storage)?,
            no_boxes: BoxList::empty_command(gpu)?,
            coherent: setup.options.flag("coherent"),
        })
    }

    /// Climbs from each effective occluder to the root; what lies beside the way is a group; those in the view volume are
    /// listed, opened where that saves rays. Objects that cannot be rasterised are hit.
    pub fn extract(
        &self,
        f: &mut Frame,
        tree: &Tree,
        occluders: BufferRef<u32>,
        hits: BufferRef<u32>,
        view: &View,
        frame: u32,
    ) {
        let (nodes, marked, visible, grids) = (tree.nodes(), self.marked.all(), self.visible.all(), self.grids.all());
        let object_count = tree.unbounded().len() as u32;
        f.copy("eovc/clear_lists", self.no_grids.all(), grids);
        self.groups.clear(f, "eovc/clear_groups", &self.no_boxes);
        self.singles.clear(f, "eovc/clear_groups", &self.no_boxes);
        let mark =
            eovc::MarkPaths { occluders, leaves: tree.leaves(), nodes, marked, visible, grids, object_count, frame };
        f.dispatch(mark, mark_invocations(object_count));
        let extract = eovc::ExtractGroups { nodes, marked, visible, groups: self.starts[0].all(), grids, frame };
        f.dispatch_indirect(extract, grids);
        // The deepest nodes of a pass that opens all are CULL_LEVELS below those of the pass before.
        for pass in 0..tree.depth() / CULL_LEVELS + 1 {
            let list = FIRST_CULL_LIST + pass;
            let cull = eovc::CullGroups {
                nodes,
                starts: self.starts[pass as usize % 2].all(),
                unfinished: self.starts[1 - pass as usize % 2].all(),
                grids,
                groups: self.groups.listed(),
                group_command: self.groups.command(),
                singles: self.singles.listed(),
                single_command: self.singles.command(),
                hits,
                touched: self.touched.all(),
                view: view.cull(),
                frame,
                list,
                constants: eovc::CullGroupsConstants { coherent: self.coherent },
            };
            f.dispatch_indirect(cull, grids.from((list * GRID_WORDS) as usize));
        }
    }
}
