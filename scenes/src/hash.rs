//! A fingerprint of everything that can change a picture of a scene, for caches.

use crate::animation::{Motion, Orbit};
use crate::model::{Mesh, Object, Scene, Surface};
use crate::morph::{Deformed, MorphTarget};
use glam::DAffine3;
use sha2::{Digest, Sha256};
use std::fmt::Write;

impl Scene {
    /// SHA-256 over meshes, objects, textures, cameras, motion and walk. Names do not count, the order of objects does.
    /// Two scenes with the same hash give the same pictures along the same path.
    pub fn content_hash(&self) -> [u8; 32] {
        let mut hash = Sha256::new();
        // Each list is preceded by its length, so that no two scenes give the same bytes.
        hash_count(&mut hash, self.meshes.len());
        self.meshes.iter().for_each(|mesh| hash_mesh(&mut hash, mesh));
        hash_objects(&mut hash, &self.objects);
        hash_materials(&mut hash, self);
        match &self.motion {
            Motion::Orbits(orbits) => hash_orbits(&mut hash, orbits),
            // `Debug` prints every number of a track in full, so equal text means equal motion.
            motion => hash_debug(&mut hash, motion),
        }
        hash_count(&mut hash, self.cameras.len());
        for camera in &self.cameras {
            hash_debug(&mut hash, &(camera.pose, camera.projection, camera.node));
        }
        hash_debug(&mut hash, &self.walk);
        hash_deformed(&mut hash, self);
        hash.finalize().into()
    }
}

fn hash_count(hash: &mut Sha256, count: usize) {
    hash.update((count as u64).to_le_bytes());
}

/// Hashes the numbers' bytes, gathered in blocks: a call for each number would take longer than the hash.
fn hash_numbers<const BYTES: usize>(hash: &mut Sha256, numbers: impl Iterator<Item = [u8; BYTES]>) {
    let mut block = Vec::with_capacity(1 << 16);
    for number in numbers {
        block.extend_from_slice(&number);
        if block.len() + BYTES > 1 << 16 {
            hash.update(&block);
            block.clear();
        }
    }
    hash.update(&block);
}

fn hash_mesh(hash: &mut Sha256, mesh: &Mesh) {
    hash.update([mesh.topology as u8]);
    for vectors in [&mesh.positions, &mesh.normals] {
        hash_count(hash, vectors.len());
        hash_numbers(hash, vectors.iter().flat_map(|vector| vector.to_array()).map(f32::to_le_bytes));
    }
    hash_count(hash, mesh.indices.len());
    hash_numbers(hash, mesh.indices.iter().map(|index| index.to_le_bytes()));
    // Paths that are made from a scene's bounds differ with them.
    if let Some(declared) = mesh.honoured_bounds() {
        hash.update(b"declared");
        hash_numbers(
            hash,
            [declared.min, declared.max].iter().flat_map(|corner| corner.to_array()).map(f64::to_le_bytes),
        );
    }
}

/// Only of scenes that have any, so that all others keep the hash that they have always had.
fn hash_materials(hash: &mut Sha256, scene: &Scene) {
    for (index, mesh) in scene.meshes.iter().enumerate() {
        if !mesh.texture_coordinates.is_empty() || !mesh.colours.is_empty() {
            hash.update(b"vertices");
            hash_count(hash, index);
            hash_count(hash, mesh.texture_coordinates.len());
            let numbers = mesh.texture_coordinates.iter().flat_map(|at| at.to_array());
            hash_numbers(hash, numbers.map(f32::to_le_bytes));
            hash_count(hash, mesh.colours.len());
            hash_numbers(hash, mesh.colours.iter().flat_map(|colour| colour.map(f32::to_le_bytes)));
        }
    }
    for (index, Object { surface, .. }) in scene.objects.iter().enumerate() {
        if *surface != Surface::default() {
            hash.update(b"surface");
            hash_count(hash, index);
            hash.update(surface.cutoff.to_le_bytes());
            // No scene has as many textures as the last number.
            hash.update(surface.texture.unwrap_or(u32::MAX).to_le_bytes());
            hash.update([u8::from(surface.single_sided)]);
        }
    }
    for texture in &scene.textures {
        hash.update(b"texture");
        hash_numbers(hash, texture.size.into_iter().map(u32::to_le_bytes));
        hash_numbers(hash, texture.texels.iter().copied());
        hash.update(texture.wrap.map(|wrap| wrap as u8));
    }
}

/// Only of scenes that have any, so that all others keep the hash that they have always had.
fn hash_deformed(hash: &mut Sha256, scene: &Scene) {
    if scene.deformed.is_empty() && scene.skins.is_empty() {
        return;
    }
    hash_debug(hash, &scene.skins);
    for Deformed { mesh, skin, rest, targets } in &scene.deformed {
        hash.update(b"deformed");
        // No scene has as many skins as the last number.
        hash_numbers(hash, [*mesh, skin.unwrap_or(u32::MAX)].into_iter().map(u32::to_le_bytes));
        hash_count(hash, rest.len());
        for vertex in rest {
            let vectors = vertex.position.to_array().into_iter().chain(vertex.normal.to_array());
            hash_numbers(hash, vectors.chain(vertex.weights).map(f32::to_le_bytes));
            hash_numbers(hash, vertex.joints.into_iter().map(u32::to_le_bytes));
        }
        for MorphTarget { weight, displacements } in targets {
            hash.update(b"target");
            hash_count(hash, *weight as usize);
            hash_count(hash, displacements.len());
            hash_numbers(hash, displacements.iter().map(|displaced| displaced.vertex.to_le_bytes()));
            let vectors = displacements.iter().flat_map(|displaced| [displaced.position, displaced.normal]);
            hash_numbers(hash, vectors.flat_map(|vector| vector.to_array()).map(f32::to_le_bytes));
        }
    }
}

fn hash_objects(hash: &mut Sha256, objects: &[Object]) {
    hash_count(hash, objects.len());
    hash_numbers(hash, objects.iter().map(object_bytes));
}

fn object_bytes(object: &Object) -> [u8; 117] {
    let mut bytes = [0; 117];
    bytes[..96].copy_from_slice(&affine_bytes(&object.world_from_object));
    bytes[96..100].copy_from_slice(&object.mesh.to_le_bytes());
    for (target, part) in bytes[100..116].chunks_exact_mut(4).zip(object.colour) {
        target.copy_from_slice(&part.to_le_bytes());
    }
    bytes[116] = u8::from(object.dynamic) | u8::from(object.translucent) << 1 | u8::from(object.masked) << 2;
    bytes
}

fn affine_bytes(transform: &DAffine3) -> [u8; 96] {
    let mut bytes = [0; 96];
    for (target, part) in bytes.chunks_exact_mut(8).zip(transform.to_cols_array()) {
        target.copy_from_slice(&part.to_le_bytes());
    }
    bytes
}

fn hash_orbits(hash: &mut Sha256, orbits: &[Orbit]) {
    hash.update(b"orbits");
    hash_count(hash, orbits.len());
    for orbit in orbits {
        hash.update(orbit.object.to_le_bytes());
        hash.update(affine_bytes(&orbit.base));
        let numbers = [orbit.centre, orbit.axis, orbit.bob].into_iter().flat_map(|vector| vector.to_array());
        hash_numbers(hash, numbers.chain([orbit.radians_per_s, orbit.bob_period_s]).map(f64::to_le_bytes));
    }
}

/// Text that is hashed as it is written.
struct HashText<'a>(&'a mut Sha256);

impl Write for HashText<'_> {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

fn hash_debug(hash: &mut Sha256, value: &impl std::fmt::Debug) {
    // Writing into a hash cannot fail.
    let _ = write!(HashText(hash), "{value:?};");
}
