//! `frustum-bvh`: hierarchical view-frustum culling on the host (Zachmann 2008, VFC). From the root down: what is outside a plane is
//! left with all below it; what is inside one is not tested against it further down (*plane masking*); and each node is tested
//! first against the plane that it failed at last time (*coherence*).

use super::twin::{clip_from_bounds, farthest_along, footprint_widening, planes, too_small, ClipBox};
use crate::pack::DrawList;
use crate::tree::{split, Tree};
use crate::world::Still;
use crate::{Method, OptionInfo, Result, Setup, View, Work, World};
use engine::{Buffer, Frame, Placement, Target};
use shaders::types::{CullView, TreeNode, OBJECT_ALWAYS_KEPT};

/// What spares tests can be turned off.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    OptionInfo {
        name: "masking",
        default: "true",
        values: "true|false",
        help: "plane masking: below a node inside a plane that plane is not tested",
    },
    OptionInfo {
        name: "coherence",
        default: "true",
        values: "true|false",
        help: "test each node first against the plane that it failed at last",
    },
    crate::tree::SPLIT_OPTION,
];

/// The six planes, a bit each.
const ALL_PLANES: u8 = 0b11_1111;

/// Which tests are spared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spared {
    /// Planes that a node above is inside of.
    pub masking: bool,
    /// Planes after the one that a node failed at last.
    pub coherence: bool,
}

struct FrustumBvh {
    tree: Tree,
    builds: u32,
    failed: Vec<u8>,
    spared: Spared,
    flags: Vec<u32>,
    kept: Buffer<u32>,
    list: DrawList,
    plane_tests: u64,
    still: Still,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world, options) = (setup.gpu, setup.world, setup.options);
    let tree = Tree::new(gpu, world, split(options))?;
    Ok(Box::new(FrustumBvh {
        builds: tree.builds(),
        failed: vec![0; tree.len()],
        spared: Spared { masking: options.flag("masking"), coherence: options.flag("coherence") },
        flags: vec![0; world.len()],
        kept: Buffer::new(gpu, "frustum-bvh.kept", world.len(), Placement::Upload)?,
        list: DrawList::new(gpu, "frustum-bvh.list", world)?,
        plane_tests: 0,
        still: Still::new(options),
        tree,
    }))
}

impl Method for FrustumBvh {
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
            self.flags.copy_from_slice(self.tree.unbounded()); // 1. what has no bounds
            let nodes = self.tree.host_nodes();
            self.plane_tests = walk(nodes, &view.cull(), self.spared, &mut self.failed, &mut self.flags); // 2. what is in view
            self.kept.write(&self.flags)?;
            self.list.pack(f, world, self.kept.all()); // 3. in object order
        }
        world.draw(f, &self.list, view, target); // 4. draw it
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

/// Flags the objects in view, and counts how often a box was tested against a plane.
pub fn walk(nodes: &[TreeNode], view: &CullView, spared: Spared, failed: &mut [u8], kept: &mut [u32]) -> u64 {
    let mut tests = 0;
    let mut open = if nodes.is_empty() { Vec::new() } else { vec![(0u32, ALL_PLANES)] };
    while let Some((index, mask)) = open.pop() {
        let node = &nodes[index as usize];
        let clip = clip_from_bounds(&node.bounds, view);
        let untested = node.bounds.flags & OBJECT_ALWAYS_KEPT != 0;
        let first = if spared.coherence { &mut failed[index as usize] } else { &mut 0 };
        let below = if untested { Some(mask) } else { planes_below(node, &clip, view, mask, first, &mut tests) };
        let Some(below) = below.filter(|_| untested || !too_small(&clip, view)) else { continue };
        if node.is_leaf != 0 {
            kept[node.first_child as usize] = 1;
        } else {
            let mask = if spared.masking { below } else { ALL_PLANES };
            open.extend([(node.first_child + 1, mask), (node.first_child, mask)]);
        }
    }
    tests
}

/// The planes that what is below a node must be tested against; none if the node is outside of one, which is noted in `first`.
fn planes_below(
    node: &TreeNode,
    clip: &ClipBox,
    view: &CullView,
    mask: u8,
    first: &mut u8,
    tests: &mut u64,
) -> Option<u8> {
    let (wide, narrow) = (planes(footprint_widening(node.bounds.flags, view)), planes([1.0; 2]));
    let mut below = mask;
    for turn in 0..6 {
        let plane = (*first + turn) % 6;
        if mask & 1 << plane == 0 {
            continue;
        }
        *tests += 1;
        if farthest_along(clip, wide[plane as usize]) < 0.0 {
            *first = plane;
            return None;
        }
        // The farthest along the plane turned round is the nearest along it. Inside the narrow plane is inside the wide one too,
        // whatever lies below.
        if farthest_along(clip, -narrow[plane as usize]) <= 0.0 {
            below &= !(1 << plane);
        }
    }
    Some(below)
}
