//! The meshes that objects are drawn from: those of the scene, and those that mirrored and absent objects need beside them.

use shaders::types::MeshRange;
use std::collections::HashMap;

/// The meshes that objects are drawn from.
pub(super) struct Variants {
    pub(super) meshes: Vec<MeshRange>,
    pub(super) indices: Vec<u32>,
    turned: HashMap<u32, u32>,
    empty: Option<u32>,
    /// The scene's mesh behind each of `meshes`.
    pub(super) sources: Vec<Option<u32>>,
}

impl Variants {
    pub(super) fn of(meshes: Vec<MeshRange>, indices: Vec<u32>) -> Self {
        let sources = (0..meshes.len() as u32).map(Some).collect();
        Variants { meshes, indices, turned: Default::default(), empty: None, sources }
    }

    fn add(&mut self, mesh: MeshRange, source: Option<u32>) -> u32 {
        self.meshes.push(mesh);
        self.sources.push(source);
        // At most three for each of the scene's.
        (self.meshes.len() - 1) as u32
    }

    /// A mesh without triangles.
    pub(super) fn empty(&mut self) -> u32 {
        match self.empty {
            Some(empty) => empty,
            None => {
                let empty = self.add(MeshRange::default(), None);
                *self.empty.insert(empty)
            }
        }
    }

    /// Adds the triangles of a scene's mesh in the other winding, for mirrored objects that show one side: a mirrored transform turns
    /// triangles round on the screen.
    pub(super) fn turned(&mut self, mesh: u32) -> u32 {
        if let Some(turned) = self.turned.get(&mesh) {
            return *turned;
        }
        let range = self.meshes[mesh as usize];
        let first_index = self.indices.len() as u32;
        for corner in (0..range.index_count as usize).step_by(3).map(|first| range.first_index as usize + first) {
            let [a, b, c] = [0, 1, 2].map(|side| self.indices[corner + side]);
            self.indices.extend([a, c, b]);
        }
        let turned = self.add(MeshRange { first_index, ..range }, Some(mesh));
        self.turned.insert(mesh, turned);
        turned
    }
}
