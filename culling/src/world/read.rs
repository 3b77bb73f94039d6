//! What the device has of a world, read back: where no frame waits for it.

use super::World;
use crate::Result;
use shaders::draw::ObjectsVertex;
use shaders::types::{Bounds, MeshRange};

impl World {
    /// Bounds as they are on the GPU now, of the objects that culling methods see.
    pub fn read_bounds(&self) -> Result<Vec<Bounds>> {
        let mut bounds = self.read_all_bounds()?;
        bounds.truncate(self.len());
        Ok(bounds)
    }

    /// The same of all objects, translucent ones too; for tests.
    pub fn read_all_bounds(&self) -> Result<Vec<Bounds>> {
        Ok(self.bounds.read()?)
    }

    /// Meshes as the host knows them: where their vertices and indices are, which are relative to each mesh's first vertex, and the vertices. Those that
    /// a skeleton bends have their shape of time 0.
    pub fn read_meshes(&self) -> Result<(&[MeshRange], &[u32], Vec<ObjectsVertex>)> {
        let mut vertices = self.vertices.read()?;
        self.as_at_start(&mut vertices);
        Ok((&self.host.meshes, &self.host.indices, vertices))
    }

    /// Vertices as they are on the GPU now; for tests.
    pub fn read_vertices(&self) -> Result<Vec<ObjectsVertex>> {
        Ok(self.vertices.read()?)
    }
}
