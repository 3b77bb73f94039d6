//! The geometry-level hierarchy on the GPU (EOVC thesis III.1).

use crate::world::{gpu_bounds, World};
use crate::{Error, OptionInfo, Options, Result};
use engine::{Buffer, Gpu};
use glam::DAffine3;
use scenes::bvh::{BadBounds, Bvh, BvhOptions, Split, NO_NODE, REBUILD_FACTOR};
use shaders::types::{Bounds, TreeNode, OBJECT_ALWAYS_KEPT, OBJECT_DYNAMIC};
use shaders::BufferRef;

/// How the hierarchy is split.
pub const SPLIT_OPTION: OptionInfo = OptionInfo {
    name: "bvh",
    default: "sah",
    values: "sah|middle|equal",
    help: "how the hierarchy is split (EOVC thesis, table 4)",
};

/// The split that a method's option `bvh` asks for.
pub fn split(options: &Options) -> Split {
    match options.text(SPLIT_OPTION.name) {
        "middle" => Split::Middle,
        "equal" => Split::EqualCount,
        _ => Split::Sah,
    }
}

/// A hierarchy over a world's objects, kept in step with them.
pub struct Tree {
    bvh: Bvh,
    options: BvhOptions,
    flags: Vec<u32>,
    nodes: Buffer<TreeNode>,
    leaves: Buffer<u32>,
    unbounded: Vec<u32>,
    flat: Vec<TreeNode>,
    builds: u32,
    refitted: u64,
    revision: u64,
}

impl Tree {
    /// Builds the hierarchy of a world. Objects whose bounds are no box are set aside: they count as visible.
    pub fn new(gpu: &Gpu, world: &World, split: Split) -> Result<Self> {
        let options = BvhOptions { split, bad_bounds: BadBounds::SetAside };
        let bvh = build(world, options)?;
        let flags: Vec<u32> = world.read_bounds()?.iter().map(|bounds| bounds.flags).collect();
        let mut unbounded = vec![0; world.len()];
        let without_leaf = bvh.leaf_of_object().iter().enumerate().filter(|(_, leaf)| **leaf == NO_NODE);
        without_leaf.for_each(|(object, _)| unbounded[object] = 1);
        // Bounds that f32 cannot hold are in the f64 tree, but the GPU keeps them by their flag: so does this list.
        flags
            .iter()
            .enumerate()
            .filter(|(_, flags)| **flags & OBJECT_ALWAYS_KEPT != 0)
            .for_each(|(object, _)| unbounded[object] = 1);
        let nodes = flatten(&bvh, &flags);
        let placement = world.followed_placement();
        Ok(Tree {
            nodes: Buffer::with_data(gpu, "eovc.nodes", &nodes, placement)?,
            leaves: Buffer::with_data(gpu, "eovc.leaves", bvh.leaf_of_object(), placement)?,
            bvh,
            options,
            flags,
            unbounded,
            flat: nodes,
            builds: 1,
            refitted: 0,
            revision: world.bounds_revision(),
        })
    }

    /// Follows objects that have moved: refitted, and built anew once refitting has made it too costly to traverse.
    pub fn follow(&mut self, world: &World) -> Result<()> {
        self.refitted = 0;
        if self.revision == world.bounds_revision() {
            return Ok(());
        }
        self.revision = world.bounds_revision();
        self.refitted = self.bvh.nodes().len() as u64;
        let refitted = self.bvh.refit(world.host_bounds());
        if refitted.is_err() || self.bvh.needs_rebuild(REBUILD_FACTOR) {
            let bvh = build(world, self.options)?;
            // The same objects have bounds as before, or the tree would not fit its buffers.
            if bvh.nodes().len() == self.bvh.nodes().len() {
                self.bvh = bvh;
                self.builds += 1;
                self.leaves.write(self.bvh.leaf_of_object())?;
            }
        }
        self.flat = flatten(&self.bvh, &self.flags);
        Ok(self.nodes.write(&self.flat)?)
    }

    /// Notes that a frame has no need of the tree.
    pub fn rest(&mut self) {
        self.refitted = 0;
    }

    /// Nodes that were fitted to bounds that had changed, in the last frame.
    pub fn refitted(&self) -> u64 {
        self.refitted
    }

    /// The hierarchy on the host.
    pub fn host(&self) -> &Bvh {
        &self.bvh
    }

    /// The nodes as the device has them, on the host.
    pub fn host_nodes(&self) -> &[TreeNode] {
        &self.flat
    }

    /// How often the tree was built: nodes keep their numbers until it is built anew.
    pub fn builds(&self) -> u32 {
        self.builds
    }

    /// 1 for each object that is not in the tree and must count as visible.
    pub fn unbounded(&self) -> &[u32] {
        &self.unbounded
    }

    /// Nodes, the root first.
    pub fn nodes(&self) -> BufferRef<TreeNode> {
        self.nodes.all()
    }

    /// Nodes as they are on the GPU now; for tests.
    pub fn read_nodes(&self) -> Result<Vec<TreeNode>> {
        Ok(self.nodes.read()?)
    }

    /// The leaf of each object; `TREE_NONE` for those set aside.
    pub fn leaves(&self) -> BufferRef<u32> {
        self.leaves.all()
    }

    /// Nodes.
    pub fn len(&self) -> usize {
        self.bvh.nodes().len()
    }

    /// Steps from the root to the deepest leaf.
    pub fn depth(&self) -> u32 {
        self.bvh.depth()
    }

    /// True if no object is in the tree.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

fn build(world: &World, options: BvhOptions) -> Result<Bvh> {
    Bvh::build_with(world.host_bounds(), options).map_err(|error| Error::Missing {
        method: "eovc",
        needs: format!("bounds it can build a hierarchy over: {error}"),
    })
}

/// The nodes as the GPU takes them, rounded outward. A node is as wide in the raster as the widest object below. One that reaches
/// farther than f32 can be trusted with is always opened.
fn flatten(bvh: &Bvh, flags: &[u32]) -> Vec<TreeNode> {
    let mut below = vec![0u32; bvh.nodes().len()];
    // Children come after their parents, so this goes from the leaves up.
    for (index, node) in bvh.nodes().iter().enumerate().rev() {
        below[index] = match (node.object(), node.children()) {
            (Some(object), _) => flags[object as usize] & !OBJECT_DYNAMIC,
            (None, Some([first, second])) => below[first as usize] | below[second as usize],
            (None, None) => 0,
        };
    }
    let node = |(index, node): (usize, &scenes::bvh::Node)| TreeNode {
        bounds: Bounds { ..gpu_bounds(&node.bounds, &DAffine3::IDENTITY, below[index] & !OBJECT_ALWAYS_KEPT) },
        first_child: node.first_child_or_object,
        parent: bvh.parents()[index],
        is_leaf: u32::from(node.is_leaf()),
        object_count: node.objects_below,
    };
    bvh.nodes().iter().enumerate().map(node).collect()
}
