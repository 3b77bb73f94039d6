//! Drawing after others without taking what is as near from them.
//!
//! Depth is compared by "as near or nearer", so that of equal depths the last one drawn stays: of two objects the later in
//! order, of two triangles of one object the later in its mesh. Occluder filtering (EOVC thesis III.6.2) draws an object that
//! was not seen after those that were, whatever their order. If it took pixels that are as near, both would take turns as
//! occluders, and the picture would flicker. So it is drawn with "nearer", and its triangles last to first: then the later of
//! its own still stays.

use crate::world::World;
use crate::Result;
use engine::{Buffer, Gpu, IndexedIndirect, Placement, Primitives};
use shaders::types::MeshRange;

/// The indices of a world with each mesh's primitives last to first.
pub struct LastToFirst {
    indices: Buffer<u32>,
}

impl LastToFirst {
    /// Turns the primitives of every mesh round.
    pub fn new(gpu: &Gpu, world: &World) -> Result<Self> {
        let mut indices = world.host.indices.clone();
        let meshes = &world.host.meshes;
        let mut turned = vec![false; meshes.len()];
        for range in world.ranges() {
            let objects = range.first..range.first + range.count;
            let now = objects.clone().map(|object| world.host.object_meshes[object as usize]);
            let others = world.turning.iter().flat_map(|turning| turning.other_meshes());
            let others = others.filter(|(object, _)| objects.contains(object)).map(|(_, mesh)| mesh);
            for mesh in now.chain(others).map(|mesh| mesh as usize) {
                if !std::mem::replace(&mut turned[mesh], true) {
                    turn_round(&mut indices, meshes[mesh], range.primitives);
                }
            }
        }
        Ok(LastToFirst {
            indices: Buffer::with_data(gpu, "world.indices_last_to_first", &indices, Placement::Geometry)?,
        })
    }
}

impl LastToFirst {
    /// A draw with each mesh's primitives last to first.
    pub(crate) fn turned(&self, draw: IndexedIndirect) -> IndexedIndirect {
        IndexedIndirect { indices: self.indices.all().into(), ..draw }
    }
}

fn turn_round(indices: &mut [u32], mesh: MeshRange, primitives: Primitives) {
    let corners = match primitives {
        Primitives::Triangles => 3,
        Primitives::Lines => 2,
        Primitives::Points => 1,
    };
    let mesh = &mut indices[mesh.first_index as usize..(mesh.first_index + mesh.index_count) as usize];
    // All indices round, then the corners of each primitive back: a triangle of other corners is another triangle.
    mesh.reverse();
    mesh.chunks_mut(corners).for_each(<[u32]>::reverse);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn primitives_turn_round_and_keep_their_corners() {
        let mut indices: Vec<u32> = (0..12).collect();
        let mesh = |first_index, index_count| MeshRange { first_index, index_count, vertex_offset: 0 };
        turn_round(&mut indices, mesh(0, 6), Primitives::Triangles);
        turn_round(&mut indices, mesh(6, 4), Primitives::Lines);
        turn_round(&mut indices, mesh(10, 2), Primitives::Points);
        assert_eq!(indices, [3, 4, 5, 0, 1, 2, 8, 9, 6, 7, 11, 10]);
    }
}
