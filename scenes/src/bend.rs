//! Handing meshes over to skeletons and morph targets, and the faults of deformed meshes.

use crate::animation::{Attachment, Motion, NodeAnimation};
use crate::error::SceneError;
use crate::model::{Aabb, Mesh, Scene, Topology};
use crate::morph::{Deformed, Displacement, MorphTarget, Shapes, MOST_TARGETS};
use crate::moving::always;
use crate::skin::{cofactors, mean_place, JointPlaces, RestVertex, Skin, MOST_OFF_ONE};
use crate::winding::{joint_shares, mirrored_by};
use glam::{DAffine3, DVec3, Vec3};
use std::borrow::Cow;

/// The largest sum of a vertex's size at rest and all its displacements at their largest weights. The device adds them up in any order
/// without leaving the range of `f32`.
const MOST_DISPLACED: f64 = f32::MAX as f64 / 8.0;

/// Bends a mesh once, by joints whose places never change. The displacements of its morph targets are bent too: bending is linear in a
/// vertex's position.
pub(crate) fn bend_for_ever(
    mesh: &mut Mesh,
    rest: &mut [RestVertex],
    targets: &mut [MorphTarget],
    places: &[DAffine3],
) {
    let means: Vec<DAffine3> = rest.iter().map(|vertex| mean_place(vertex, places)).collect();
    for displaced in targets.iter_mut().flat_map(|target| &mut target.displacements) {
        let (vertex, mean) = (&rest[displaced.vertex as usize], &means[displaced.vertex as usize].matrix3);
        // The normal at rest gets unit length below, so its displacement is divided by the same length.
        let length = (cofactors(*mean) * vertex.normal.as_dvec3()).length();
        let normal = cofactors(*mean) * displaced.normal.as_dvec3() / if length > 0.0 { length } else { 1.0 };
        displaced.position = (*mean * displaced.position.as_dvec3()).as_vec3();
        displaced.normal = normal.as_vec3();
    }
    for (vertex, mean) in rest.iter_mut().zip(&means) {
        vertex.position = mean.transform_point3(vertex.position.as_dvec3()).as_vec3();
        vertex.normal = unit(cofactors(mean.matrix3) * vertex.normal.as_dvec3());
    }
    (mesh.positions, mesh.normals) = rest.iter().map(|vertex| (vertex.position, vertex.normal)).unzip();
    // The joints are gone afterwards, so the indices must say that they mirror.
    if mesh.topology == Topology::Triangles && mirrored_by(&joint_shares(rest, places.len()), places) {
        mesh.indices.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
    }
}

fn unit(normal: DVec3) -> Vec3 {
    normal.try_normalize().unwrap_or(DVec3::Z).as_vec3()
}

fn shape(mesh: &mut Mesh, deformed: &Deformed, shapes: &Shapes) {
    let vertices = deformed.vertices(shapes);
    (mesh.positions, mesh.normals) = vertices.map(|(position, normal)| (position.as_vec3(), unit(normal))).unzip();
}

impl Scene {
    /// Returns the joints and weights that shape the deformed meshes at a time. Costs nothing without deformed meshes.
    pub fn shapes_at(&self, seconds: f64) -> Shapes {
        let weights = match &self.motion {
            Motion::Nodes(nodes) => nodes.weights().iter().map(|track| track.at(seconds)).collect(),
            Motion::Still | Motion::Orbits(_) => Vec::new(),
        };
        Shapes { joints: self.joints_at(seconds), weights }
    }

    /// The deformation of a mesh; none if it is rigid.
    pub fn deformation_of(&self, mesh: u32) -> Option<&Deformed> {
        let at = self.deformed.binary_search_by_key(&mesh, |deformed| deformed.mesh).ok()?;
        Some(&self.deformed[at])
    }

    /// Where the joints of its skins are at a time. Costs nothing without skins.
    pub fn joints_at(&self, seconds: f64) -> JointPlaces {
        JointPlaces::at(&self.motion, &self.skins, seconds)
    }

    /// Returns all meshes, deformed ones in their shape at a time. Indices are the same at every time: [`Windings`](crate::Windings)
    /// tells which side is the front.
    pub fn meshes_at(&self, seconds: f64) -> Cow<'_, [Mesh]> {
        if self.deformed.is_empty() {
            return Cow::Borrowed(&self.meshes);
        }
        let (shapes, mut meshes) = (self.shapes_at(seconds), self.meshes.clone());
        for deformed in &self.deformed {
            shape(&mut meshes[deformed.mesh as usize], deformed, &shapes);
        }
        Cow::Owned(meshes)
    }

    /// Hands meshes over to a skeleton, to morph targets, or to both. The objects that have them must hang on the animation already; on
    /// the skeleton's anchor if there is one. Each mesh gets its shape of time 0, and a declared box that holds all its shapes.
    ///
    /// # Errors
    /// [`SceneError::BadObject`] with the name of an object that has the mesh.
    pub fn deform(&mut self, all: Vec<Deformed>) -> Result<(), SceneError> {
        let users = self.users_of_meshes();
        let shapes = self.shapes_at(0.0);
        for deformed in &all {
            let always = match self.deformed_fault(deformed, &users) {
                Some(fault) => Err(fault),
                None => self.always(deformed),
            };
            let always = always.map_err(|fault| self.fault_of(deformed.mesh, &users, fault))?;
            let mesh = &mut self.meshes[deformed.mesh as usize];
            shape(mesh, deformed, &shapes);
            mesh.declared_bounds = Some(always);
        }
        self.deformed.extend(all);
        self.deformed.sort_by_key(|deformed| deformed.mesh);
        Ok(())
    }

    /// The box of all shapes of a mesh.
    fn always(&self, deformed: &Deformed) -> Result<Aabb, String> {
        let Motion::Nodes(nodes) = &self.motion else { return Err("nothing moves it".into()) };
        let always = always(nodes, deformed.skin.map(|skin| &self.skins[skin as usize]), deformed);
        match always.is_valid() {
            true => Ok(always),
            false => Err("its deformation takes it beyond the range of numbers; scale the scene down".into()),
        }
    }

    fn fault_of(&self, mesh: u32, users: &[(u32, u32)], fault: String) -> SceneError {
        let user = users.iter().find(|(of_user, _)| *of_user == mesh);
        let name = user.map(|(_, object)| self.objects[*object as usize].name.clone());
        SceneError::BadObject { object: name.unwrap_or_else(|| format!("of mesh {mesh}")), fault }
    }

    /// Refuses deformed meshes that have no meaning.
    pub(crate) fn check_deformed(&self) -> Result<(), SceneError> {
        if self.deformed.is_empty() {
            return Ok(());
        }
        let users = self.users_of_meshes();
        for (at, deformed) in self.deformed.iter().enumerate() {
            let out_of_order = at > 0 && self.deformed[at - 1].mesh >= deformed.mesh;
            let fault = match self.deformed_fault(deformed, &users) {
                _ if out_of_order => Some("its mesh is deformed twice, or out of order".into()),
                None if !self.meshes[deformed.mesh as usize].declares_a_box() => {
                    Some("its mesh is deformed, but declares no box for all its shapes; see Scene::deform".into())
                }
                fault => fault,
            };
            if let Some(fault) = fault {
                return Err(self.fault_of(deformed.mesh, &users, fault));
            }
        }
        Ok(())
    }

    /// Pairs of a mesh and an object that has it, in order.
    fn users_of_meshes(&self) -> Vec<(u32, u32)> {
        let mut users: Vec<(u32, u32)> =
            self.objects.iter().zip(0..).map(|(object, index)| (object.mesh, index)).collect();
        users.sort_unstable();
        users
    }

    /// Finds the first fault of a deformed mesh. `users` has pairs of a mesh and an object that has it, in order.
    fn deformed_fault(&self, deformed: &Deformed, users: &[(u32, u32)]) -> Option<String> {
        let Some(mesh) = self.meshes.get(deformed.mesh as usize) else {
            return Some(format!("mesh {} is deformed, but the scene has {}", deformed.mesh, self.meshes.len()));
        };
        let Motion::Nodes(nodes) = &self.motion else { return Some("its mesh is deformed, but nothing moves".into()) };
        let skin = match deformed.skin.map(|skin| (skin, self.skins.get(skin as usize))) {
            Some((index, None)) => return Some(format!("it has skin {index}, but the scene has {}", self.skins.len())),
            Some((_, skin)) => skin,
            None => None,
        };
        if skin.is_some_and(|skin| !skin.fits(nodes.nodes().len())) {
            return Some("its skin has bones that the animation lacks".into());
        }
        let first = users.partition_point(|(mesh, _)| *mesh < deformed.mesh);
        let users = users[first..].iter().take_while(|(mesh, _)| *mesh == deformed.mesh);
        if let Some(fault) = users.into_iter().find_map(|(_, object)| hanging_fault(nodes, skin, *object)) {
            return Some(fault);
        }
        let (rest, vertices) = (deformed.rest.len(), mesh.positions.len());
        if rest != vertices {
            return Some(format!("{rest} vertices at rest for the {vertices} of its mesh"));
        }
        let vertex = deformed
            .rest
            .iter()
            .enumerate()
            .find_map(|(at, vertex)| vertex_fault(vertex, skin).map(|fault| format!("vertex {at}: {fault}")));
        vertex.or_else(|| targets_fault(deformed, nodes))
    }
}

impl Mesh {
    /// True if the mesh declares a box without a fault. A deformed mesh must: the box holds its other shapes too.
    fn declares_a_box(&self) -> bool {
        self.positions.is_empty() || (self.declared_bounds.is_some() && self.declared_fault().is_none())
    }
}

/// Finds the fault in the place of an object whose mesh is deformed.
fn hanging_fault(nodes: &NodeAnimation, skin: Option<&Skin>, object: u32) -> Option<String> {
    let found = nodes.objects().binary_search_by_key(&object, |attachment| attachment.object);
    let on: Option<&Attachment> = found.ok().map(|at| &nodes.objects()[at]);
    match (on, skin) {
        (None, _) => Some("its mesh is deformed, but it hangs on no node of the animation".into()),
        (Some(on), Some(skin)) if on.node != skin.anchor() || on.node_from_object != DAffine3::IDENTITY => {
            Some("it does not hang on the anchor of its skin".into())
        }
        _ => None,
    }
}

fn vertex_fault(vertex: &RestVertex, skin: Option<&Skin>) -> Option<String> {
    if !vertex.position.is_finite() || !vertex.normal.is_finite() {
        return Some("at rest it is not finite".into());
    }
    let joints = skin?.joint_count();
    if let Some(joint) = vertex.joints.iter().find(|joint| **joint as usize >= joints) {
        return Some(format!("it has joint {joint}, but its skin has {joints}"));
    }
    let sum: f64 = vertex.weights.iter().copied().map(f64::from).sum();
    let good = vertex.weights.iter().all(|weight| *weight >= 0.0) && (sum - 1.0).abs() <= MOST_OFF_ONE;
    (!good).then(|| format!("its weights {:?} are negative, or do not add up to 1", vertex.weights))
}

fn targets_fault(deformed: &Deformed, nodes: &NodeAnimation) -> Option<String> {
    let (targets, weights) = (&deformed.targets, nodes.weight_ranges());
    if targets.len() > MOST_TARGETS {
        return Some(format!("{} morph targets move it at once; the limit is {MOST_TARGETS}", targets.len()));
    }
    // Sums stay NaN once a number is NaN.
    let size = |position: Vec3, normal: Vec3| (position.as_dvec3().abs() + normal.as_dvec3().abs()).element_sum();
    let mut sizes: Vec<f64> = deformed.rest.iter().map(|vertex| size(vertex.position, vertex.normal)).collect();
    for (number, target) in targets.iter().enumerate() {
        let Some([least, most]) = weights.get(target.weight as usize) else {
            return Some(format!(
                "morph target {number} has weight {}, but there are {}",
                target.weight,
                weights.len()
            ));
        };
        let most = least.abs().max(most.abs());
        let ascend = target.displacements.windows(2).all(|pair| pair[0].vertex < pair[1].vertex);
        if !ascend || target.displacements.last().is_some_and(|last| last.vertex as usize >= sizes.len()) {
            return Some(format!("morph target {number}: its vertices do not ascend, or are more than its mesh has"));
        }
        for Displacement { vertex, position, normal } in &target.displacements {
            sizes[*vertex as usize] += size(*position, *normal) * most.max(1.0) + most;
        }
    }
    let largest = sizes.iter().position(|size| size.is_nan() || *size > MOST_DISPLACED);
    largest.map(|vertex| format!("morph targets can take vertex {vertex} beyond the range of 32-bit numbers"))
}
