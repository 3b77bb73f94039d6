//! Rays cast by the host, on all its cores, and what they meet handed to the device.

use super::shape::Shapes;
use super::twin::{all_tiles, cast_rays, Cast, Targets};
use super::{COARSEST_PX, LEVELS};
use crate::world::World;
use crate::Result;
use engine::{Buffer, Frame, Gpu, Placement};
use glam::UVec2;
use shaders::types::{SeedNode, SeedView};
use shaders::{seeds, BufferRef};

/// More objects than this are not handed over: those that were met by the coarsest rays go first.
const MOST_MET: usize = 65_536;
/// Rays that are worth a thread.
const THREAD_RAYS: usize = 256;

pub(super) struct HostRays {
    nodes: Vec<SeedNode>,
    shapes: Shapes,
    met: Buffer<u32>,
    /// Number of the last cast that met each object.
    last_met: Vec<u32>,
    casts: u32,
}

impl HostRays {
    pub fn new(gpu: &Gpu, world: &World, nodes: Vec<SeedNode>, shapes: Shapes) -> Result<Self> {
        let met = Buffer::new(gpu, "seeds.met", world.len().min(MOST_MET), Placement::Upload)?;
        Ok(HostRays { nodes, shapes, met, last_met: vec![0; world.len()], casts: 0 })
    }

    pub fn follow(&mut self, nodes: Vec<SeedNode>) {
        self.nodes = nodes;
    }

    pub fn cast(&mut self, f: &mut Frame, world: &World, view: &SeedView, seen: BufferRef<u32>) -> Result<()> {
        let met = self.meet(world, view);
        self.met.write(&met)?;
        let met_count = met.len() as u32;
        f.dispatch(seeds::MarkMet { met: self.met.all(), seen, met_count }, met_count);
        Ok(())
    }

    /// What rays meet, each once, in the order of their tiles.
    fn meet(&mut self, world: &World, view: &SeedView) -> Vec<u32> {
        let targets = Targets {
            nodes: &self.nodes,
            shapes: &self.shapes,
            object_meshes: world.host_object_meshes(),
            objects: world.host_objects(),
        };
        self.casts += 1;
        let mut met = Vec::new();
        let mut tiles = all_tiles(view, COARSEST_PX);
        for level in 0..LEVELS {
            let tile_px = COARSEST_PX >> level;
            let cast = on_all_cores(&tiles, |tiles| cast_rays(&targets, view, tiles, tile_px));
            for object in cast.met {
                let last = std::mem::replace(&mut self.last_met[object as usize], self.casts);
                if last != self.casts && met.len() < MOST_MET {
                    met.push(object);
                }
            }
            tiles = cast.finer;
        }
        met
    }
}

/// Casts in several threads, with the result of one.
fn on_all_cores(tiles: &[UVec2], cast: impl Fn(&[UVec2]) -> Cast + Sync) -> Cast {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = cores.min(tiles.len().div_ceil(THREAD_RAYS)).max(1);
    let mut parts = tiles.chunks(tiles.len().div_ceil(threads).max(1));
    let Some(own) = parts.next() else { return Cast::default() };
    std::thread::scope(|scope| {
        let cast = &cast;
        let others: Vec<_> = parts.map(|part| scope.spawn(move || cast(part))).collect();
        let mut all = cast(own);
        for other in others {
            // A thread that panicked has said why.
            let Cast { met, finer } = other.join().unwrap_or_default();
            all.met.extend(met);
            all.finer.extend(finer);
        }
        all
    })
}
