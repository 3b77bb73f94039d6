//! Indirect commands packed from visibility flags, in object order, by a prefix sum (EOVC thesis III.6.1, figure 11).
//!
//! Order matters: commands appended by atomics change places from frame to frame, and objects of equal depth flicker.

mod draw;
pub mod twin;

use crate::world::World;
use crate::Result;
use engine::{Buffer, Frame, Gpu, IndexedIndirect, Placement};
use shaders::types::{DrawCommand, PACK_CHUNK};
use shaders::{pack, BufferRef, ResourceId, Stage};

/// How the commands of a list lie (EOVC thesis III.6.1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Commands {
    /// One after the other in object order; their number lies on the GPU.
    #[default]
    Packed,
    /// One for each object; those of objects that are not drawn have no instance.
    ZeroInstance,
    /// The same, at places by chance that never change, so that what is drawn is spread evenly over each range (Kim 2015, IV.3).
    Shuffled,
}

/// A list of indirect commands on the GPU, with room for every object of a world, so that it cannot overflow.
pub struct DrawList {
    commands: Buffer<DrawCommand>,
    counts: Buffer<u32>,
    starts: Buffer<u32>,
    totals: Vec<Buffer<u32>>,
    everything: Vec<Buffer<u32>>,
    places: Buffer<u32>,
    style: Commands,
    /// What a read-back has found: how many commands of each range to draw.
    exact: Option<Vec<u32>>,
    subgroup_size: u32,
    world: ResourceId,
}

/// By object: a place within its range, by chance but always the same (Fisher-Yates over SplitMix64).
pub fn scattered(ranges: &[crate::world::Range]) -> Vec<u32> {
    let mut state = 0u64;
    let mut random = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    };
    let mut places = Vec::new();
    for range in ranges {
        let mut own: Vec<u32> = (0..range.count).collect();
        (1..own.len()).rev().for_each(|last| own.swap(last, (random() % (last as u64 + 1)) as usize));
        places.extend(own);
    }
    places
}

impl DrawList {
    /// An empty list with room for all objects of `world`.
    pub fn new(gpu: &Gpu, name: &str, world: &World) -> Result<Self> {
        Self::styled(gpu, name, world, Commands::Packed)
    }

    /// An empty list whose commands lie as asked for.
    pub fn styled(gpu: &Gpu, name: &str, world: &World, style: Commands) -> Result<Self> {
        let chunks = world.len().div_ceil(PACK_CHUNK as usize);
        let ranges = world.ranges().iter().enumerate();
        let one = |(index, _): (usize, &crate::world::Range)| {
            Buffer::new(gpu, &format!("{name}.total{index}"), 1, Placement::Storage)
        };
        let totals = ranges.clone().map(one).collect::<std::result::Result<_, _>>()?;
        let all = |(index, range): (usize, &crate::world::Range)| {
            Buffer::with_data(gpu, &format!("{name}.all{index}"), &[range.count], Placement::Storage)
        };
        let everything = if style != Commands::Packed {
            ranges.map(all).collect::<std::result::Result<_, _>>()?
        } else {
            Vec::new()
        };
        let places = if style == Commands::Shuffled { scattered(world.ranges()) } else { vec![0] };
        Ok(DrawList {
            commands: Buffer::new(gpu, &format!("{name}.commands"), world.len(), Placement::Storage)?,
            counts: Buffer::new(gpu, &format!("{name}.counts"), chunks, Placement::Storage)?,
            starts: Buffer::new(gpu, &format!("{name}.starts"), chunks, Placement::Storage)?,
            totals,
            everything,
            places: Buffer::with_data(gpu, &format!("{name}.places"), &places, Placement::Storage)?,
            style,
            exact: None,
            subgroup_size: gpu.subgroup_size(),
            world: world.id(),
        })
    }

    /// Writes a command for every object whose flag is not 0.
    ///
    /// # Panics
    /// If the list was made for another world: it would not have the room.
    pub fn pack(&self, f: &mut Frame, world: &World, flags: BufferRef<u32>) {
        assert_eq!(self.world, world.id(), "this list was made for another world: make the method again");
        for (range, total) in world.ranges().iter().zip(&self.totals) {
            match self.style {
                Commands::Packed => self.pack_range(f, world, flags, range, total),
                Commands::ZeroInstance | Commands::Shuffled => self.write_range(f, world, flags, range, total),
            }
        }
    }

    fn pack_range(
        &self,
        f: &mut Frame,
        world: &World,
        flags: BufferRef<u32>,
        range: &crate::world::Range,
        total: &Buffer<u32>,
    ) {
        let chunks = range.count.div_ceil(PACK_CHUNK);
        let (first_object, object_count) = (range.first, range.count);
        f.dispatch(pack::CountFlags { flags, counts: self.counts.all(), first_object, object_count }, chunks);
        let constants = pack::ScanCountsConstants { subgroup_size: self.subgroup_size };
        let (counts, starts, total) = (self.counts.all(), self.starts.all(), total.all());
        f.dispatch_groups(pack::ScanCounts { counts, starts, total, chunk_count: chunks, constants }, 1);
        let write = pack::WriteCommands {
            flags,
            counts,
            starts,
            object_meshes: world.object_meshes(),
            meshes: world.meshes(),
            commands: self.commands.all(),
            first_object,
            object_count,
        };
        f.dispatch(write, chunks);
    }

    fn write_range(
        &self,
        f: &mut Frame,
        world: &World,
        flags: BufferRef<u32>,
        range: &crate::world::Range,
        end: &Buffer<u32>,
    ) {
        f.fill("pack/clear_end", end, 0);
        let write = pack::WriteInstances {
            flags,
            object_meshes: world.object_meshes(),
            meshes: world.meshes(),
            commands: self.commands.all(),
            end: end.all(),
            places: self.places.all(),
            first_object: range.first,
            object_count: range.count,
            constants: pack::WriteInstancesConstants { scattered: self.style == Commands::Shuffled },
        };
        f.dispatch(write, range.count);
    }

    /// Waits for the frame so far and reads how many commands there are, so that exactly those are drawn: counter read-back
    /// (EOVC thesis III.6.1). Once a list is read back it must be each time it is packed.
    pub fn read_back(&mut self, f: &mut Frame) -> Result<()> {
        let counts = self.totals.iter().map(|total| Ok(f.read(total)?.first().copied().unwrap_or(0)));
        self.exact = Some(counts.collect::<Result<_>>()?);
        Ok(())
    }

    /// Notes that the list is used as it is.
    pub fn skip_packing(&self, f: &mut Frame, reason: &'static str) {
        let stages: &[_] = match self.style {
            Commands::Packed => &[pack::CountFlags::INFO, pack::ScanCounts::INFO, pack::WriteCommands::INFO],
            Commands::ZeroInstance | Commands::Shuffled => &[pack::WriteInstances::INFO],
        };
        stages.iter().for_each(|stage| f.skip(stage.name, reason));
    }

    /// The commands of this list, of all kinds of primitive.
    pub(crate) fn commands(&self) -> BufferRef<DrawCommand> {
        self.commands.all()
    }

    /// Of each kind of primitive: its first command, and how many of them count; those without an instance draw nothing.
    pub(crate) fn counts<'a>(&'a self, world: &'a World) -> impl Iterator<Item = (u32, BufferRef<u32>)> + 'a {
        assert_eq!(self.world, world.id(), "this list was made for another world: make the method again");
        world.ranges().iter().enumerate().map(|(index, range)| {
            let count = self.everything.get(index).unwrap_or(&self.totals[index]);
            (range.first, count.all())
        })
    }

    /// The multi-draws of this list, one a kind of primitive.
    pub(crate) fn draws<'a>(&'a self, world: &'a World) -> impl Iterator<Item = IndexedIndirect> + 'a {
        assert_eq!(self.world, world.id(), "this list was made for another world: make the method again");
        world.ranges().iter().enumerate().map(|(index, range)| {
            let exact = self.exact.as_ref().map(|counts| counts[index]);
            // A count that never changes where all commands are drawn, because draws with and without one must not be mixed
            // (see `IndexedIndirect`).
            let count = self.everything.get(index).unwrap_or(&self.totals[index]);
            let commands = self.commands.all().from(range.first as usize);
            let draw = world.multi_draw(range, commands, if exact.is_some() { None } else { Some(count.all()) });
            IndexedIndirect { max_draws: exact.unwrap_or(range.count), ..draw }
        })
    }
}
