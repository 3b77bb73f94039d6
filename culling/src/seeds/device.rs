//! Rays cast by the device.

use super::shape::Shapes;
use super::{COARSEST_PX, FINEST_PX, LEVELS};
use crate::world::World;
use crate::Result;
use engine::{Buffer, Frame, Gpu, Placement};
use shaders::types::{MeshShape, SeedNode, SeedView, SEED_GRID_WORDS};
use shaders::{seeds, BufferRef};

pub(super) struct DeviceRays {
    gpu: Gpu,
    nodes: Buffer<SeedNode>,
    shapes: Buffer<MeshShape>,
    filled: Buffer<u32>,
    view: Buffer<SeedView>,
    /// Corners of tiles, of one level and of the next.
    tiles: Option<[Buffer<u32>; 2]>,
    grids: Buffer<u32>,
    no_grids: Buffer<u32>,
}

impl DeviceRays {
    pub fn new(gpu: &Gpu, nodes: &[SeedNode], shapes: &Shapes, followed: Placement) -> Result<Self> {
        // The last level leaves a list behind that none looks at.
        let no_grids = [0, 1, 1, 0].repeat(LEVELS as usize + 1);
        Ok(DeviceRays {
            gpu: gpu.clone(),
            nodes: Buffer::with_data(gpu, "seeds.nodes", nodes, followed)?,
            shapes: Buffer::with_data(gpu, "seeds.shapes", &shapes.meshes, Placement::Storage)?,
            filled: Buffer::with_data(gpu, "seeds.filled", &shapes.filled, Placement::Storage)?,
            view: Buffer::new(gpu, "seeds.view", 1, Placement::Upload)?,
            tiles: None,
            grids: Buffer::new(gpu, "seeds.grids", no_grids.len(), Placement::Storage)?,
            no_grids: Buffer::with_data(gpu, "seeds.no_grids", &no_grids, Placement::Storage)?,
        })
    }

    pub fn follow(&mut self, nodes: &[SeedNode]) -> Result<()> {
        Ok(self.nodes.write(nodes)?)
    }

    pub fn cast(&mut self, f: &mut Frame, world: &World, view: &SeedView, seen: BufferRef<u32>) -> Result<()> {
        self.view.write(&[*view])?;
        let tiles_at = |tile_px: u32| view.width_px.div_ceil(tile_px) * view.height_px.div_ceil(tile_px);
        let most = tiles_at(FINEST_PX) as usize;
        let tiles = match self.tiles.take() {
            Some(tiles) if tiles[0].len() >= most => tiles,
            _ => {
                let tiles = |name: &str| Buffer::new(&self.gpu, name, most, Placement::Storage);
                [tiles("seeds.tiles_even")?, tiles("seeds.tiles_odd")?]
            }
        };
        f.copy("seeds/clear_grids", self.no_grids.all(), self.grids.all());
        for level in 0..LEVELS {
            let tile_px = COARSEST_PX >> level;
            let cast = seeds::CastRays {
                nodes: self.nodes.all(),
                shapes: self.shapes.all(),
                object_meshes: world.object_meshes(),
                objects: world.objects(),
                views: self.view.all(),
                seen,
                tiles: tiles[level as usize % 2].all(),
                finer: tiles[1 - level as usize % 2].all(),
                grids: self.grids.all(),
                filled: self.filled.all(),
                level,
                tile_px,
            };
            match level {
                0 => f.dispatch(cast, tiles_at(tile_px)),
                _ => f.dispatch_indirect(cast, self.grids.all().from((level * SEED_GRID_WORDS) as usize)),
            }
        }
        self.tiles = Some(tiles);
        Ok(())
    }
}
