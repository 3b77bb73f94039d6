//! Indirect commands packed from visibility flags, in object order, by a prefix sum (EOVC thesis III.6.1, figure 11).
//!
//! Order matters: commands appended by atomics change places from frame to frame, and objects of equal depth flicker.

pub mod twin;

use crate::world::World;
use crate::Result;
use engine::{Buffer, Frame, Gpu, IndexedIndirect, Placement};
use shaders::types::{DrawCommand, PACK_CHUNK};
use shaders::{pack, BufferRef, ResourceId, Stage};

/// A list of indirect commands on the GPU, with room for every object of a world, so that it cannot overflow.
pub struct DrawList {
    commands: Buffer<DrawCommand>,
    counts: Buffer<u32>,
    starts: Buffer<u32>,
    totals: Vec<Buffer<u32>>,
    subgroup_size: u32,
    world: ResourceId,
}

impl DrawList {
    /// An empty list with room for all objects of `world`.
    pub fn new(gpu: &Gpu, name: &str, world: &World) -> Result<Self> {
        let chunks = world.len().div_ceil(PACK_CHUNK as usize);
        let total = |index: usize| Buffer::new(gpu, &format!("{name}.total{index}"), 1, Placement::Storage);
        Ok(DrawList {
            commands: Buffer::new(gpu, &format!("{name}.commands"), world.len(), Placement::Storage)?,
            counts: Buffer::new(gpu, &format!("{name}.counts"), chunks, Placement::Storage)?,
            starts: Buffer::new(gpu, &format!("{name}.starts"), chunks, Placement::Storage)?,
            totals: (0..world.ranges().len()).map(total).collect::<std::result::Result<_, _>>()?,
            subgroup_size: gpu.subgroup_size(),
            world: world.id(),
        })
    }

    /// Packs a command for every object whose flag is not 0.
    ///
    /// # Panics
    /// If the list was made for another world: it would not have the room.
    pub fn pack(&self, f: &mut Frame, world: &World, flags: BufferRef<u32>) {
        assert_eq!(self.world, world.id(), "this list was made for another world: make the method again");
        for (range, total) in world.ranges().iter().zip(&self.totals) {
            let chunks = range.count.div_ceil(PACK_CHUNK);
            let (first_object, object_count) = (range.first, range.count);
            f.dispatch(pack::CountFlags { flags, counts: self.counts.all(), first_object, object_count }, chunks);
            let constants = pack::ScanCountsConstants { subgroup_size: self.subgroup_size };
            let (counts, starts, total) = (self.counts.all(), self.starts.all(), total.all());
            f.dispatch_groups(pack::ScanCounts { counts, starts, total, chunk_count: chunks, constants }, 1);
            let write = pack::WriteCommands {
                flags,
                starts,
                object_meshes: world.object_meshes(),
                meshes: world.meshes(),
                commands: self.commands.all(),
                first_object,
                object_count,
            };
            f.dispatch(write, chunks);
        }
    }

    /// Notes that the list is used as it is.
    pub fn skip_packing(&self, f: &mut Frame, reason: &'static str) {
        for stage in [pack::CountFlags::INFO, pack::ScanCounts::INFO, pack::WriteCommands::INFO] {
            f.skip(stage.name, reason);
        }
    }

    /// The multi-draws of this list, one a kind of primitive.
    pub(crate) fn draws<'a>(&'a self, world: &'a World) -> impl Iterator<Item = IndexedIndirect> + 'a {
        assert_eq!(self.world, world.id(), "this list was made for another world: make the method again");
        world.ranges().iter().zip(&self.totals).map(|(range, total)| IndexedIndirect {
            vertices: world.vertices().into(),
            indices: world.indices().into(),
            commands: self.commands.all().from(range.first as usize).into(),
            count: Some(total.all()),
            max_draws: range.count,
            primitives: range.primitives,
        })
    }
}
