//! Deformed meshes: vertices at rest, the morph targets and joints that deform them, and the stage that writes the deformed vertices.
//!
//! Each deformed mesh has vertices of its own. `world/skin_vertices` writes them before anything is drawn, so the stages that draw, and
//! the stages that test drawn objects, need no code for it. Bounds come from weights and joints, on the host (`scenes::MovingBoxes`).
//!
//! Each vertex has a range of influences and a range of displacements. So a mesh pays only for the joints and targets that it has, and
//! there is no limit on either.

use super::twin::Deformers;
use super::upload::Flat;
use super::{Detail, World};
use crate::Result;
use engine::{Buffer, Frame, Gpu, Placement};
use scenes::{Scene, Shapes};
use shaders::draw::ObjectsVertex;
use shaders::types::{Displacement, Influence, JointPlace, RestVertex};
use shaders::{world, BufferRef, Stage};
use std::marker::PhantomData;
use std::sync::atomic::{AtomicBool, Ordering};

/// Every device can bind a buffer from multiples of this on.
const OFFSET_ALIGNMENT: u64 = 256;

/// The deformed meshes of a world.
pub(super) struct Deformation {
    rest: Buffer<RestVertex>,
    influences: Buffer<Influence>,
    displacements: Buffer<Displacement>,
    places: Buffer<JointPlace>,
    weights: Buffer<f32>,
    /// The first vertex of a deformed mesh. Deformed meshes lie behind all others.
    first: usize,
    /// Those vertices at time 0, as the host has them.
    at_start: Vec<ObjectsVertex>,
    /// Indexed by object: its mesh is deformed.
    deformed: Vec<bool>,
    shapes: Shapes,
    /// Shapes have changed since vertices were last written.
    moved: bool,
    /// A frame has written vertices in these shapes.
    brought: AtomicBool,
    revision: u64,
}

impl Deformation {
    /// None if no mesh is deformed.
    pub(super) fn new(gpu: &Gpu, scene: &Scene, flat: &Flat, object_of_scene: &[u32]) -> Result<Option<Self>> {
        if scene.deformed.is_empty() {
            return Ok(None);
        }
        let shapes = scene.shapes_at(0.0);
        let Deformers { rest, influences, displacements, places, weights } = deformers(scene, &shapes);
        let mut deformed = vec![false; scene.objects.len()];
        for (index, object) in scene.objects.iter().enumerate() {
            deformed[object_of_scene[index] as usize] = scene.deformation_of(object.mesh).is_some();
        }
        let first = flat.vertices.len() - rest.len();
        let (storage, upload) = (Placement::Storage, Placement::Upload);
        Ok(Some(Deformation {
            rest: Buffer::with_data(gpu, "world.rest_vertices", &rest, storage)?,
            influences: Buffer::with_data(gpu, "world.influences", &influences, storage)?,
            displacements: Buffer::with_data(gpu, "world.displacements", &displacements, storage)?,
            places: Buffer::with_data(gpu, "world.joint_places", &places, upload)?,
            weights: Buffer::with_data(gpu, "world.morph_weights", &weights, upload)?,
            first,
            at_start: flat.vertices[first..].to_vec(),
            deformed,
            shapes,
            // The device rounds in another way than the host.
            moved: true,
            brought: AtomicBool::new(false),
            revision: 0,
        }))
    }

    /// Takes the joints and weights of a time.
    pub(super) fn set_time(&mut self, scene: &Scene, seconds: f64) -> Result<()> {
        let shapes = scene.shapes_at(seconds);
        if self.brought.swap(false, Ordering::Relaxed) {
            self.moved = false;
        }
        if shapes != self.shapes {
            self.places.write(&joint_places(&shapes))?;
            self.weights.write(&weights(&shapes))?;
            (self.shapes, self.moved) = (shapes, true);
            self.revision += 1;
        }
        Ok(())
    }

    /// The places of joints and the weights of morph targets.
    pub(super) fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    fn update(&self, f: &mut Frame, vertices: &Buffer<ObjectsVertex>, detail: Option<&Detail>) {
        self.brought.store(true, Ordering::Relaxed);
        if !self.moved {
            f.skip(world::SkinVertices::INFO.name, "no joint and no weight has moved");
            return;
        }
        self.write(f, vertices.all());
        if let Some(detail) = detail {
            self.write(f, detail.vertices());
        }
    }

    /// Writes the vertices of a buffer that has all of a world's.
    fn write<T>(&self, f: &mut Frame, vertices: BufferRef<T>) {
        let vertex_count = self.rest.len() as u32;
        let begin = (self.first * size_of::<T>()) as u64;
        let skipped = begin / OFFSET_ALIGNMENT * OFFSET_ALIGNMENT;
        let BufferRef { id, raw, offset, size, .. } = vertices;
        let words = BufferRef { id, raw, offset: offset + skipped, size: size - skipped, element: PhantomData };
        let (first_word, stride_words) = ((begin - skipped) as u32 / 4, size_of::<T>() as u32 / 4);
        let stage = world::SkinVertices {
            rest: self.rest.all(),
            influences: self.influences.all(),
            displacements: self.displacements.all(),
            places: self.places.all(),
            weights: self.weights.all(),
            vertices: words,
            vertex_count,
            first_word,
            stride_words,
        };
        f.dispatch(stage, vertex_count);
    }
}

/// Makes the buffers that `world/skin_vertices` reads. Meshes come in the order in which their vertices lie.
fn deformers(scene: &Scene, shapes: &Shapes) -> Deformers {
    let mut all = Deformers { places: joint_places(shapes), weights: weights(shapes), ..Deformers::default() };
    for deformed in &scene.deformed {
        // Joints are at most 2^22 a skin. More than 2^32 in all have no room on the device either.
        let first_place = deformed.skin.map(|skin| shapes.joints.first(skin) as u32);
        let mut of_vertex: Vec<Vec<Displacement>> = vec![Vec::new(); deformed.rest.len()];
        for target in &deformed.targets {
            for scenes::Displacement { vertex, position, normal } in &target.displacements {
                let (position, normal) = (position.to_array(), normal.to_array());
                of_vertex[*vertex as usize].push(Displacement { weight: target.weight, position, normal });
            }
        }
        for (vertex, displacements) in deformed.rest.iter().zip(of_vertex) {
            let influences = first_place.into_iter().flat_map(|first| {
                vertex.influences().map(move |(joint, share)| Influence { place: first + joint, share })
            });
            let (first_influence, first_displacement) = (all.influences.len(), all.displacements.len());
            all.influences.extend(influences);
            all.displacements.extend(displacements);
            all.rest.push(RestVertex {
                position: vertex.position.to_array(),
                normal: vertex.normal.to_array(),
                first_influence: first_influence as u32,
                influence_count: (all.influences.len() - first_influence) as u32,
                first_displacement: first_displacement as u32,
                displacement_count: (all.displacements.len() - first_displacement) as u32,
            });
        }
    }
    all
}

fn weights(shapes: &Shapes) -> Vec<f32> {
    shapes.weights.iter().map(|weight| *weight as f32).collect()
}

fn joint_places(shapes: &Shapes) -> Vec<JointPlace> {
    let place = |place: &glam::DAffine3| {
        let linear = place.matrix3;
        JointPlace {
            column_x: linear.x_axis.as_vec3().to_array(),
            column_y: linear.y_axis.as_vec3().to_array(),
            column_z: linear.z_axis.as_vec3().to_array(),
            shift: place.translation.as_vec3().to_array(),
        }
    };
    shapes.joints.all().iter().map(place).collect()
}

impl World {
    /// Gives deformed meshes the shapes of the time.
    pub(super) fn deform(&self, f: &mut Frame) {
        match &self.deformation {
            Some(deformation) => deformation.update(f, &self.vertices, self.detail.as_ref()),
            None => f.skip(world::SkinVertices::INFO.name, "no deformed meshes"),
        }
    }

    /// A skeleton or morph targets deform this object: it does not only move.
    pub fn is_deformed(&self, object: u32) -> bool {
        self.deformation.as_ref().is_some_and(|deformation| deformation.deformed[object as usize])
    }

    /// Changes whenever the shape of some object does. Equal revisions mean that all objects have the same shapes.
    pub fn shape_revision(&self) -> u64 {
        self.deformation.as_ref().map_or(0, |deformation| deformation.revision)
    }

    /// Reads the buffers that deform vertices, and the index of the first deformed vertex; none if no mesh is deformed. For tests.
    pub fn deformers(&self) -> Result<Option<(Deformers, usize)>> {
        let Some(deformation) = &self.deformation else { return Ok(None) };
        let deformers = Deformers {
            rest: deformation.rest.read()?,
            influences: deformation.influences.read()?,
            displacements: deformation.displacements.read()?,
            places: deformation.places.read()?,
            weights: deformation.weights.read()?,
        };
        Ok(Some((deformers, deformation.first)))
    }

    /// Replaces the vertices that the device has now by those of time 0.
    pub(super) fn as_at_start(&self, vertices: &mut [ObjectsVertex]) {
        if let Some(deformation) = &self.deformation {
            vertices[deformation.first..].copy_from_slice(&deformation.at_start);
        }
    }
}
