//! Blocks of objects that lie side by side in the scene's order, with bounds in common: scenes mostly list near each other what
//! lies near each other, so that most blocks are outside the view volume as a whole.

use super::{gpu_bounds, World};
use crate::{Result, View};
use engine::{Buffer, Frame, Gpu, Placement};
use glam::{DAffine3, DVec3, Vec3};
use scenes::Aabb;
use shaders::types::{Bounds, BLOCK_OBJECTS, MOST_BLOCKS_ACROSS, OBJECT_ALWAYS_KEPT, OBJECT_WIDE_RASTER};
use shaders::{frustum, BufferRef};

/// Grid and length of a list, as blocks.glsl says.
const HEADER_WORDS: usize = 4;

/// Bounds of blocks, and the list of those in view.
pub(super) struct Blocks {
    bounds: Buffer<Bounds>,
    list: Buffer<u32>,
    empty: Buffer<u32>,
    /// Why no block need be tested: all of them are listed then.
    useless: Option<&'static str>,
}

impl Blocks {
    /// Blocks of objects with these bounds. Whoever holds one of the `moving` objects is in view always.
    pub(super) fn new(gpu: &Gpu, objects: &[Bounds], moving: &[u32]) -> Result<Self> {
        let bounds = blocks(objects, moving);
        let useless = match bounds.iter().filter(|block| block.flags & OBJECT_ALWAYS_KEPT == 0).count() {
            0 => Some("something moves, or has no bounds, in every block"),
            _ if bounds.len() == 1 => Some("a single block"),
            _ => None,
        };
        Ok(Blocks {
            list: Buffer::with_data(gpu, "world.blocks_in_view", &listed(bounds.len() as u32), Placement::Storage)?,
            empty: Buffer::with_data(gpu, "world.no_blocks", &[0, 1, 1, 0], Placement::Storage)?,
            bounds: Buffer::with_data(gpu, "world.block_bounds", &bounds, Placement::Storage)?,
            useless,
        })
    }

    /// Bounds by block.
    pub(super) fn bounds(&self) -> &Buffer<Bounds> {
        &self.bounds
    }

    /// True if blocks are tested at all.
    pub(super) fn tested(&self) -> bool {
        self.useless.is_none()
    }

    pub(super) fn in_view(&self, f: &mut Frame, view: &View) -> BufferRef<u32> {
        let (blocks, block_count) = (self.list.all(), self.bounds.len() as u32);
        match self.useless {
            Some(reason) => World::skip_blocks(f, reason),
            None => {
                f.copy("frustum/clear_blocks", self.empty.all(), blocks);
                let test = frustum::TestBlocks { bounds: self.bounds.all(), blocks, view: view.cull(), block_count };
                f.dispatch(test, block_count);
            }
        }
        blocks
    }
}

/// The list of all blocks, for stages that look at those in view.
pub fn listed(block_count: u32) -> Vec<u32> {
    let across = block_count.min(MOST_BLOCKS_ACROSS);
    let down = block_count.div_ceil(MOST_BLOCKS_ACROSS).max(1);
    [across, down, 1, block_count].into_iter().chain(0..block_count).collect()
}

/// The blocks that a list holds.
pub fn unlisted(list: &[u32]) -> &[u32] {
    &list[HEADER_WORDS..][..list[HEADER_WORDS - 1] as usize]
}

/// The bounds of each block, which hold those of its objects.
fn blocks(objects: &[Bounds], moving: &[u32]) -> Vec<Bounds> {
    let mut blocks: Vec<Bounds> = objects.chunks(BLOCK_OBJECTS as usize).map(block).collect();
    for object in moving {
        blocks[(object / BLOCK_OBJECTS) as usize].flags |= OBJECT_ALWAYS_KEPT;
    }
    blocks
}

fn block(objects: &[Bounds]) -> Bounds {
    let flags =
        objects.iter().fold(0, |flags, bounds| flags | bounds.flags & (OBJECT_WIDE_RASTER | OBJECT_ALWAYS_KEPT));
    let ends = objects.iter().map(|bounds| {
        let centre = Vec3::from(bounds.centre_high).as_dvec3() + Vec3::from(bounds.centre_low).as_dvec3();
        let half = Vec3::from(bounds.half_extent).as_dvec3();
        Aabb { min: centre - half, max: centre + half }
    });
    let nothing = Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
    let all = ends.fold(nothing, |all, one| Aabb { min: all.min.min(one.min), max: all.max.max(one.max) });
    gpu_bounds(&all, &DAffine3::IDENTITY, flags)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bounds(at: [f64; 3], half: [f64; 3], flags: u32) -> Bounds {
        let (centre, half) = (DVec3::from(at), DVec3::from(half).abs());
        gpu_bounds(&Aabb { min: centre - half, max: centre + half }, &DAffine3::IDENTITY, flags)
    }

    fn ends(bounds: &Bounds, axis: usize) -> [f64; 2] {
        let centre = f64::from(bounds.centre_high[axis]) + f64::from(bounds.centre_low[axis]);
        let half = f64::from(bounds.half_extent[axis]);
        [centre - half, centre + half]
    }

    proptest! {
        #[test]
        fn a_block_holds_its_objects(
            objects in prop::collection::vec((prop::array::uniform3(-1e9..1e9f64), prop::array::uniform3(0.0..1e3f64), 0..2u32), 1..200)
        ) {
            let objects: Vec<Bounds> = objects.into_iter().map(|(at, half, flags)| bounds(at, half, flags)).collect();
            let blocks = blocks(&objects, &[]);
            prop_assert_eq!(blocks.len(), objects.len().div_ceil(BLOCK_OBJECTS as usize));
            for (object, bounds) in objects.iter().enumerate() {
                let block = &blocks[object / BLOCK_OBJECTS as usize];
                prop_assert_eq!(bounds.flags & !block.flags & OBJECT_WIDE_RASTER, 0);
                for axis in 0..3 {
                    let ([low, high], [block_low, block_high]) = (ends(bounds, axis), ends(block, axis));
                    prop_assert!(block_low <= low && high <= block_high, "object {object}, axis {axis}");
                }
            }
        }
    }

    #[test]
    fn a_block_with_what_moves_or_has_no_bounds_is_always_kept() {
        let mut objects = vec![bounds([0.0; 3], [1.0; 3], 0); 3 * BLOCK_OBJECTS as usize];
        objects[2 * BLOCK_OBJECTS as usize + 7] = bounds([f64::NAN; 3], [1.0; 3], 0);
        let kept: Vec<bool> =
            blocks(&objects, &[BLOCK_OBJECTS]).iter().map(|block| block.flags & OBJECT_ALWAYS_KEPT != 0).collect();
        assert_eq!(kept, [false, true, true]);
    }
}
