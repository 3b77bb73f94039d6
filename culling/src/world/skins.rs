//! What skeletons bend: vertices at rest, and where joints put them, to where the device bends them.
//!
//! Each bent object has a mesh of its own, whose vertices `world/skin_vertices` writes before anything is drawn: what draws, and all that tests
//! what was drawn, need not know. Bounds come from the joints, on the host (`scenes::MovingBoxes`).

use super::upload::Flat;
use super::{Detail, World};
use crate::Result;
use engine::{Buffer, Frame, Gpu, Placement};
use scenes::{JointPlaces, Scene};
use shaders::draw::ObjectsVertex;
use shaders::types::{JointPlace, RestVertex};
use shaders::{world, BufferRef, Stage};
use std::marker::PhantomData;
use std::sync::atomic::{AtomicBool, Ordering};

/// Every device can bind a buffer from multiples of this on.
const OFFSET_ALIGNMENT: u64 = 256;

/// The bent objects of a world.
pub(super) struct Skins {
    rest: Buffer<RestVertex>,
    places: Buffer<JointPlace>,
    /// The first bent vertex: they lie behind all others.
    first: usize,
    /// Those vertices at time 0, as the host has them.
    at_start: Vec<ObjectsVertex>,
    /// By object: a skeleton bends it.
    bent: Vec<bool>,
    joints: JointPlaces,
    /// Joints have moved since vertices were last bent.
    moved: bool,
    /// A frame has bent vertices by what `joints` says.
    brought: AtomicBool,
    revision: u64,
}

impl Skins {
    /// None if nothing is bent.
    pub(super) fn new(gpu: &Gpu, scene: &Scene, flat: &Flat, object_of_scene: &[u32]) -> Result<Option<Self>> {
        if scene.skinned.is_empty() {
            return Ok(None);
        }
        let joints = scene.joints_at(0.0);
        let mut rest = Vec::new();
        let mut bent = vec![false; scene.objects.len()];
        // In the order of meshes, as vertices lie.
        let mut skinned: Vec<_> = scene.skinned.iter().collect();
        skinned.sort_by_key(|skinned| scene.objects[skinned.object as usize].mesh);
        for skinned in skinned {
            // Places are at most 2^22 a skin; what has more in all is refused with the buffer's name.
            let first = joints.first(skinned.skin) as u32;
            rest.extend(skinned.rest.iter().map(|vertex| at_rest(vertex, first)));
            bent[object_of_scene[skinned.object as usize] as usize] = true;
        }
        let first = flat.vertices.len() - rest.len();
        let mut places = Buffer::new(gpu, "world.joint_places", joints.all().len(), Placement::Upload)?;
        places.write(&on_device(&joints))?;
        Ok(Some(Skins {
            rest: Buffer::with_data(gpu, "world.rest_vertices", &rest, Placement::Storage)?,
            places,
            first,
            at_start: flat.vertices[first..].to_vec(),
            bent,
            joints,
            // What the device rounds is not what the host does.
            moved: true,
            brought: AtomicBool::new(false),
            revision: 0,
        }))
    }

    /// Joints go where they are at a time.
    pub(super) fn set_time(&mut self, scene: &Scene, seconds: f64) -> Result<()> {
        let joints = scene.joints_at(seconds);
        let moves = joints != self.joints;
        if self.brought.swap(false, Ordering::Relaxed) {
            self.moved = false;
        }
        if moves {
            self.places.write(&on_device(&joints))?;
            (self.joints, self.moved) = (joints, true);
            self.revision += 1;
        }
        Ok(())
    }

    /// Where joints are.
    pub(super) fn joints(&self) -> &JointPlaces {
        &self.joints
    }

    fn update(&self, f: &mut Frame, vertices: &Buffer<ObjectsVertex>, detail: Option<&Detail>) {
        self.brought.store(true, Ordering::Relaxed);
        if !self.moved {
            f.skip(world::SkinVertices::INFO.name, "no joint has moved");
            return;
        }
        self.bend(f, vertices.all());
        if let Some(detail) = detail {
            self.bend(f, detail.vertices());
        }
    }

    /// Writes the vertices of a buffer that has all of a world's.
    fn bend<T>(&self, f: &mut Frame, vertices: BufferRef<T>) {
        let vertex_count = self.rest.len() as u32;
        let begin = (self.first * size_of::<T>()) as u64;
        let skipped = begin / OFFSET_ALIGNMENT * OFFSET_ALIGNMENT;
        let BufferRef { id, raw, offset, size, .. } = vertices;
        let words = BufferRef { id, raw, offset: offset + skipped, size: size - skipped, element: PhantomData };
        let (first_word, stride_words) = ((begin - skipped) as u32 / 4, size_of::<T>() as u32 / 4);
        let (rest, places) = (self.rest.all(), self.places.all());
        f.dispatch(
            world::SkinVertices { rest, places, vertices: words, vertex_count, first_word, stride_words },
            vertex_count,
        );
    }
}

fn at_rest(vertex: &scenes::RestVertex, first: u32) -> RestVertex {
    RestVertex {
        position: vertex.position.to_array(),
        normal: vertex.normal.to_array(),
        joints: vertex.joints.map(|joint| first + joint),
        weights: vertex.weights,
    }
}

fn on_device(joints: &JointPlaces) -> Vec<JointPlace> {
    let place = |place: &glam::DAffine3| {
        let linear = place.matrix3;
        JointPlace {
            column_x: linear.x_axis.as_vec3().to_array(),
            column_y: linear.y_axis.as_vec3().to_array(),
            column_z: linear.z_axis.as_vec3().to_array(),
            shift: place.translation.as_vec3().to_array(),
        }
    };
    joints.all().iter().map(place).collect()
}

impl World {
    /// Vertices that joints carry go where these are.
    pub(super) fn bend(&self, f: &mut Frame) {
        match &self.skins {
            Some(skins) => skins.update(f, &self.vertices, self.detail.as_ref()),
            None => f.skip(world::SkinVertices::INFO.name, "no skins"),
        }
    }

    /// A skeleton bends this object: it does not only move.
    pub fn is_bent(&self, object: u32) -> bool {
        self.skins.as_ref().is_some_and(|skins| skins.bent[object as usize])
    }

    /// Changes whenever joints move within their objects: equal ones mean that all objects have the same shapes.
    pub fn shape_revision(&self) -> u64 {
        self.skins.as_ref().map_or(0, |skins| skins.revision)
    }

    /// What the device bends vertices from, and where it puts the first; none if it bends nothing. For tests.
    pub fn bent_vertices(&self) -> Result<Option<BentVertices>> {
        let Some(skins) = &self.skins else { return Ok(None) };
        Ok(Some(BentVertices { rest: skins.rest.read()?, places: skins.places.read()?, first: skins.first }))
    }

    /// Puts the shapes of time 0 over those that the device has now.
    pub(super) fn as_at_start(&self, vertices: &mut [ObjectsVertex]) {
        if let Some(skins) = &self.skins {
            vertices[skins.first..].copy_from_slice(&skins.at_start);
        }
    }
}

/// See [`World::bent_vertices`].
pub struct BentVertices {
    /// Vertices at rest.
    pub rest: Vec<RestVertex>,
    /// Joints.
    pub places: Vec<JointPlace>,
    /// The place of the first among all vertices.
    pub first: usize,
}
