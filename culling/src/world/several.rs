//! Several boxes for an object (GPU Gems 29.5.1), made when a method asks for them.

use super::{upload, World};
use crate::Result;
use glam::{DAffine3, DMat3, Vec3};
use scenes::{Aabb, MeshBoxes, Scene, Topology};
use shaders::types::{Bounds, Object};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The boxes of each mesh of the scene; none for those that must keep their one box.
pub type BoxesOfMeshes = Arc<Vec<Option<MeshBoxes>>>;

/// What is known of them.
pub(super) struct Several {
    /// By mesh of the scene.
    topologies: Vec<Topology>,
    /// A mesh that declares a larger box than it needs has that one: whoever declares it may move vertices within, as what a skeleton bends
    /// does.
    declared: Vec<bool>,
    /// By how many boxes were asked for.
    made: Mutex<BTreeMap<u32, BoxesOfMeshes>>,
}

impl Several {
    pub(super) fn of(scene: &Scene) -> Self {
        Several {
            topologies: scene.meshes.iter().map(|mesh| mesh.topology).collect(),
            declared: scene.meshes.iter().map(|mesh| mesh.honoured_bounds().is_some()).collect(),
            made: Mutex::default(),
        }
    }
}

impl World {
    /// The meshes of the scene in at most `most` boxes each. Reads their vertices back and walks over all triangles, once for a world and
    /// number; the device must be idle.
    pub fn boxes_of_meshes(&self, most: u32) -> Result<BoxesOfMeshes> {
        let several = &self.host.several;
        let mut made = several.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(boxes) = made.get(&most) {
            return Ok(boxes.clone());
        }
        let (ranges, indices, vertices) = self.read_meshes()?;
        let one = |(mesh, topology): (usize, &Topology)| {
            let range = &ranges[mesh];
            let indices = &indices[range.first_index as usize..][..range.index_count as usize];
            let position = |index: u32| Vec3::from(vertices[range.vertex_offset as usize + index as usize].position);
            (!several.declared[mesh]).then(|| MeshBoxes::around(scenes::primitives(indices, *topology, position), most))
        };
        let boxes: BoxesOfMeshes = Arc::new(several.topologies.iter().enumerate().map(one).collect());
        made.insert(most, boxes.clone());
        Ok(boxes)
    }

    /// An object's boxes where it is now, in f64: together they hold all of it, as its one box does, within which they lie.
    pub fn boxes_of_object<'a>(
        &'a self,
        object: u32,
        meshes: &'a [Option<MeshBoxes>],
    ) -> impl ExactSizeIterator<Item = Aabb> + 'a {
        let own = self.host.boxes[object as usize];
        let boxes = meshes[self.host.scene_meshes[object as usize] as usize].as_ref();
        let transform = world_from_object(&self.host.objects[object as usize]);
        let count = boxes.map_or(1, MeshBoxes::len);
        let in_world = boxes.map(|boxes| boxes.in_world(transform));
        let mut in_world = in_world.into_iter().flatten();
        (0..count).map(move |_| in_world.next().map_or(own, |box_| within(box_, own)))
    }

    /// The same as the device takes them.
    pub fn gpu_boxes_of_object<'a>(
        &'a self,
        object: u32,
        meshes: &'a [Option<MeshBoxes>],
    ) -> impl ExactSizeIterator<Item = Bounds> + 'a {
        let transform = world_from_object(&self.host.objects[object as usize]);
        let flags = self.host.flags[object as usize];
        self.boxes_of_object(object, meshes).map(move |box_| upload::bounds(&box_, &transform, flags))
    }
}

/// The transform that the device has.
fn world_from_object(object: &Object) -> DAffine3 {
    let column = |column: [f32; 3]| Vec3::from(column).as_dvec3();
    DAffine3 {
        matrix3: DMat3::from_cols(column(object.column_x), column(object.column_y), column(object.column_z)),
        translation: column(object.origin_high) + column(object.origin_low),
    }
}

/// What two boxes share, of which both hold the same. The first, where the second is no box.
fn within(box_: Aabb, own: Aabb) -> Aabb {
    let shared = Aabb { min: box_.min.max(own.min), max: box_.max.min(own.max) };
    if own.is_valid() && shared.is_valid() {
        shared
    } else {
        box_
    }
}
