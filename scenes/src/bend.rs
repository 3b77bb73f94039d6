//! Handing objects over to skeletons, and what is wrong with some that were.

use crate::animation::Motion;
use crate::model::{Mesh, Scene, Topology};
use crate::moving::bent_always;
use crate::skin::{bent, JointPlaces, RestVertex, Skinned, MOST_OFF_ONE};
use glam::{DAffine3, DVec3};
use std::borrow::Cow;

/// Puts the vertices of a mesh where joints put them.
pub(crate) fn bend_mesh(mesh: &mut Mesh, rest: &[RestVertex], places: &[DAffine3]) {
    bend_vertices(mesh, rest, places);
    turn_round(mesh, places);
}

fn bend_vertices(mesh: &mut Mesh, rest: &[RestVertex], places: &[DAffine3]) {
    let vertices = rest.iter().map(|vertex| bent(vertex, places));
    let unit = |normal: DVec3| normal.try_normalize().unwrap_or(DVec3::Z).as_vec3();
    (mesh.positions, mesh.normals) = vertices.map(|(position, normal)| (position.as_vec3(), unit(normal))).unzip();
}

/// Winds triangles the other way round where joints mirror the mesh at rest, and those of a mesh that was mirrored back.
pub(crate) fn turn_round(mesh: &mut Mesh, places: &[DAffine3]) {
    let mirrored = places.first().is_some_and(|place| place.matrix3.determinant() < 0.0);
    if mirrored && mesh.topology == Topology::Triangles {
        mesh.indices.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
    }
}

impl Scene {
    /// Where the joints of its skins are at a time. Costs nothing without skins.
    pub fn joints_at(&self, seconds: f64) -> JointPlaces {
        JointPlaces::at(&self.motion, &self.skins, seconds)
    }

    /// Its meshes, those that skeletons bend in the shapes of a time.
    pub fn meshes_at(&self, seconds: f64) -> Cow<'_, [Mesh]> {
        if self.skinned.is_empty() {
            return Cow::Borrowed(&self.meshes);
        }
        let (joints, mut meshes) = (self.joints_at(seconds), self.meshes.clone());
        for Skinned { object, skin, rest } in &self.skinned {
            bend_vertices(&mut meshes[self.objects[*object as usize].mesh as usize], rest, joints.of(*skin));
        }
        Cow::Owned(meshes)
    }

    /// Hands an object over to a skeleton, whose anchor it must hang on: from now on its mesh, which must be its own, is bent. The mesh gets the shape of
    /// time 0, and a box that holds all its shapes.
    ///
    /// # Errors
    /// What is wrong, as half a sentence.
    pub fn bend(&mut self, object: u32, skin: u32, rest: Vec<RestVertex>) -> Result<(), String> {
        let skinned = Skinned { object, skin, rest };
        if let Some(fault) = skinned_fault(self, &skinned) {
            return Err(fault);
        }
        let Motion::Nodes(nodes) = &self.motion else { return Err("nothing moves its skeleton".into()) };
        let always = bent_always(nodes, &self.skins[skin as usize], &skinned.rest);
        if !always.is_valid() {
            return Err("its skeleton takes it beyond the range of numbers; scale the scene down".into());
        }
        let mut places = Vec::new();
        self.skins[skin as usize].places_at(nodes, 0.0, &mut places);
        let mesh = &mut self.meshes[self.objects[object as usize].mesh as usize];
        bend_mesh(mesh, &skinned.rest, &places);
        mesh.declared_bounds = Some(always);
        let at = self.skinned.partition_point(|other| other.object < object);
        self.skinned.insert(at, skinned);
        Ok(())
    }

    /// The first fault of its skins: the object, and what is wrong with it.
    pub(crate) fn skin_fault(&self) -> Option<(u32, String)> {
        let mut users = vec![0u32; if self.skinned.is_empty() { 0 } else { self.meshes.len() }];
        if !self.skinned.is_empty() {
            self.objects.iter().for_each(|object| users[object.mesh as usize] += 1);
        }
        self.skinned.iter().enumerate().find_map(|(at, skinned)| {
            let out_of_order = at > 0 && self.skinned[at - 1].object >= skinned.object;
            let fault = match skinned_fault(self, skinned) {
                _ if out_of_order => Some("it is bent twice, or out of order".into()),
                None if users[self.objects[skinned.object as usize].mesh as usize] != 1 => {
                    Some("a skeleton bends its mesh, which another object has too".into())
                }
                None if !self.meshes[self.objects[skinned.object as usize].mesh as usize].is_bent_mesh() => {
                    Some("its mesh is bent, but declares no box for all its shapes; see Scene::bend".into())
                }
                fault => fault,
            };
            fault.map(|fault| (skinned.object, fault))
        })
    }
}

impl Mesh {
    /// It declares a box that is larger than its vertices' own, which bent meshes must: it holds their other shapes too.
    fn is_bent_mesh(&self) -> bool {
        self.positions.is_empty() || self.honoured_bounds().is_some()
    }
}

fn skinned_fault(scene: &Scene, skinned: &Skinned) -> Option<String> {
    let Some(skin) = scene.skins.get(skinned.skin as usize) else {
        return Some(format!("it has skin {}, but the scene has {}", skinned.skin, scene.skins.len()));
    };
    let Some(mesh) =
        scene.objects.get(skinned.object as usize).and_then(|object| scene.meshes.get(object.mesh as usize))
    else {
        return Some(format!("it is bent, but the scene has {} objects", scene.objects.len()));
    };
    let Motion::Nodes(nodes) = &scene.motion else { return Some("nothing moves its skeleton".into()) };
    let hangs = nodes.objects().binary_search_by_key(&skinned.object, |attachment| attachment.object);
    let hangs = hangs.ok().map(|at| &nodes.objects()[at]);
    if !hangs.is_some_and(|it| it.node == skin.anchor() && it.node_from_object == DAffine3::IDENTITY) {
        return Some("it does not hang on the anchor of its skin".into());
    }
    if !skin.fits(nodes.nodes().len()) {
        return Some("its skin has bones that the animation lacks".into());
    }
    if skinned.rest.len() != mesh.positions.len() {
        return Some(format!("{} vertices at rest for the {} of its mesh", skinned.rest.len(), mesh.positions.len()));
    }
    skinned
        .rest
        .iter()
        .enumerate()
        .find_map(|(at, vertex)| vertex_fault(vertex, skin.joint_count()).map(|fault| format!("vertex {at}: {fault}")))
}

fn vertex_fault(vertex: &RestVertex, joints: usize) -> Option<String> {
    if !vertex.position.is_finite() || !vertex.normal.is_finite() {
        return Some("at rest it is not finite".into());
    }
    if let Some(joint) = vertex.joints.iter().find(|joint| **joint as usize >= joints) {
        return Some(format!("it has joint {joint}, but its skin has {joints}"));
    }
    let sum: f64 = vertex.weights.iter().copied().map(f64::from).sum();
    let good = vertex.weights.iter().all(|weight| *weight >= 0.0) && (sum - 1.0).abs() <= MOST_OFF_ONE;
    (!good).then(|| format!("its weights {:?} are negative, or do not add up to 1", vertex.weights))
}
