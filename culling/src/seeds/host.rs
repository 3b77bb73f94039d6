//! Rays cast by the host, on all its cores, and what they meet handed to the device.

use super::shape::Shapes;
use super::twin::{all_tiles, cast_rays, Cast, Level, Targets};
use super::{COARSEST_PX, LEVELS};
use crate::world::World;
use crate::Result;
use engine::{Buffer, Frame, Gpu, Placement};
use glam::UVec2;
use shaders::types::{SeedNode, SeedView, SEED_MOST_TILES};
use shaders::{seeds, BufferRef};

/// More objects than this are not handed over; those that the coarsest rays have met come first.
const MOST_MET: usize = 65_536;
/// Rays that are worth a thread.
const THREAD_RAYS: usize = 256;

pub(super) struct HostRays {
    nodes: Vec<SeedNode>,
    shapes: Shapes,
    met: Buffer<u32>,
    /// By object: 1 for what the cast has met.
    known: Vec<u32>,
}

impl HostRays {
    pub fn new(gpu: &Gpu, world: &World, nodes: Vec<SeedNode>, shapes: Shapes) -> Result<Self> {
        let met = Buffer::new(gpu, "seeds.met", world.len().min(MOST_MET), Placement::Upload)?;
        Ok(HostRays { nodes, shapes, met, known: vec![0; world.len()] })
    }

    pub fn follow(&mut self, nodes: Vec<SeedNode>) {
        self.nodes = nodes;
    }

    pub fn cast(&mut self, f: &mut Frame, world: &World, view: &SeedView, seen: BufferRef<u32>) -> Result<()> {
        let met = f.on_host("frame/cast_rays", || self.meet(world, view));
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
        self.known.fill(0);
        let mut met = Vec::new();
        let mut tiles = all_tiles(view, COARSEST_PX);
        for number in 0..LEVELS {
            let level = Level { number, tile_px: COARSEST_PX >> number };
            let known = &self.known;
            let cast = on_all_cores(&tiles, |tiles| cast_rays(&targets, view, tiles, level, known));
            for object in cast.met {
                let known = std::mem::replace(&mut self.known[object as usize], 1);
                if known == 0 && met.len() < MOST_MET {
                    met.push(object);
                }
            }
            tiles = cast.finer;
            if tiles.len() > SEED_MOST_TILES as usize {
                break;
            }
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
