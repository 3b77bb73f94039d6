//! What a scene must be before it can be drawn, and how large it may be.

use crate::animation::Motion;
use crate::bounds::WorldBounds;
use crate::error::SceneError;
use crate::model::{Mesh, Object, Scene, Topology};

/// Most objects that a scene may have: object indices are drawn into 24 bits of the item buffer's keys.
pub const MOST_OBJECTS: usize = 1 << 24;

impl Scene {
    /// Refuses what has no meaning: transforms, vertices or bounds that are not finite or leave the range of `f32`, indices out of
    /// range, and scenes too large to address. Flat, point-sized and reflected objects are legal. Wrong declared bounds do no
    /// harm and give a warning, see [`Scene::repair_bounds`].
    ///
    /// # Errors
    /// [`SceneError::BadObject`] with the object's name, or [`SceneError::TooLarge`].
    pub fn check(&self) -> Result<(), SceneError> {
        self.faults()?;
        self.warn_of_bounds(&self.name);
        Ok(())
    }

    /// As [`Scene::check`], without a word on declared bounds.
    pub(crate) fn faults(&self) -> Result<(), SceneError> {
        self.check_sizes()?;
        let faults: Vec<Option<String>> = self.meshes.iter().map(mesh_fault).collect();
        let bounds = WorldBounds::new(self);
        for object in &self.objects {
            let fault = match faults.get(object.mesh as usize) {
                None => {
                    let meshes = self.meshes.len();
                    Some(format!("it uses mesh {}, but the scene has {meshes}", object.mesh))
                }
                Some(Some(fault)) => Some(fault.clone()),
                Some(None) => object_fault(object, &bounds).or_else(|| surface_fault(object, self)),
            };
            if let Some(fault) = fault {
                return Err(SceneError::BadObject { object: object.name.clone(), fault });
            }
        }
        self.check_buildings()?;
        self.check_cells()?;
        self.check_motion()
    }

    fn check_buildings(&self) -> Result<(), SceneError> {
        for building in &self.buildings {
            let Some(object) = self.objects.get(building.object as usize) else {
                let fault = format!("it is a building, but the scene has {} objects", self.objects.len());
                return Err(SceneError::BadObject { object: format!("number {}", building.object), fault });
            };
            let (solid, mesh) = (building.solid, self.meshes[object.mesh as usize].bounds());
            if !solid.is_valid() || !mesh.contains(solid.min) || !mesh.contains(solid.max) {
                let fault = "what is solid of it is no box, or reaches out of its mesh".into();
                return Err(SceneError::BadObject { object: object.name.clone(), fault });
            }
        }
        Ok(())
    }

    fn check_sizes(&self) -> Result<(), SceneError> {
        let vertices = self.meshes.iter().map(|mesh| mesh.positions.len() as u64).sum();
        let indices = self.meshes.iter().map(|mesh| mesh.indices.len() as u64).sum();
        match size_fault(self.objects.len() as u64, vertices, indices) {
            Some(fault) => Err(SceneError::TooLarge { scene: self.name.clone(), fault }),
            None => Ok(()),
        }
    }

    fn check_motion(&self) -> Result<(), SceneError> {
        let stray = self.motion.dynamic_objects().into_iter().find(|&object| object as usize >= self.objects.len());
        if let Some(stray) = stray {
            let fault = format!("it is animated, but the scene has {} objects", self.objects.len());
            return Err(SceneError::BadObject { object: format!("number {stray}"), fault });
        }
        self.check_deformed()?;
        let Motion::Orbits(orbits) = &self.motion else { return Ok(()) };
        for orbit in orbits {
            let numbers = [orbit.radians_per_s, orbit.bob_period_s];
            let vectors = [orbit.centre, orbit.axis, orbit.bob];
            let finite = orbit.base.is_finite()
                && numbers.iter().all(|number| number.is_finite())
                && vectors.iter().all(|vector| vector.is_finite());
            if !finite {
                let object = self.objects[orbit.object as usize].name.clone();
                let fault = "a number of its motion is not finite".into();
                return Err(SceneError::BadObject { object, fault });
            }
        }
        Ok(())
    }

    /// True if some object has more than one colour: a texture, or colours at its vertices.
    pub fn has_textures(&self) -> bool {
        let coloured =
            |object: &Object| self.meshes.get(object.mesh as usize).is_some_and(|mesh| !mesh.colours.is_empty());
        self.objects.iter().any(|object| object.surface.texture.is_some() || coloured(object))
    }

    /// Triangles drawn when every object is: each mesh counts once an object. Lines and points count none.
    pub fn triangles(&self) -> u64 {
        let of_mesh = |mesh: &Mesh| match mesh.topology {
            Topology::Triangles => mesh.indices.len() as u64 / 3,
            Topology::Lines | Topology::Points => 0,
        };
        self.objects.iter().filter_map(|object| self.meshes.get(object.mesh as usize)).map(of_mesh).sum()
    }
}

fn size_fault(objects: u64, vertices: u64, indices: u64) -> Option<String> {
    let totals = [
        ("objects", objects, MOST_OBJECTS as u64),
        ("vertices", vertices, u64::from(u32::MAX)),
        ("indices", indices, u64::from(u32::MAX)),
    ];
    let (what, count, limit) = totals.into_iter().find(|(_, count, limit)| count > limit)?;
    Some(format!("it has {count} {what}, more than the {limit} that can be addressed; try a smaller --scale"))
}

fn mesh_fault(mesh: &Mesh) -> Option<String> {
    let vertices = mesh.positions.len();
    if let Some(vertex) = mesh.positions.iter().position(|position| !position.is_finite()) {
        return Some(format!("vertex {vertex} of its mesh '{}' is not finite", mesh.name));
    }
    if let Some(vertex) = mesh.normals.iter().position(|normal| !normal.is_finite()) {
        return Some(format!("normal {vertex} of its mesh '{}' is not finite", mesh.name));
    }
    if mesh.normals.len() != vertices {
        let normals = mesh.normals.len();
        return Some(format!("its mesh '{}' has {normals} normals for {vertices} vertices", mesh.name));
    }
    for (what, count) in [("texture coordinates", mesh.texture_coordinates.len()), ("colours", mesh.colours.len())] {
        if count != 0 && count != vertices {
            return Some(format!("its mesh '{}' has {count} {what} for {vertices} vertices", mesh.name));
        }
    }
    if !mesh.texture_coordinates.iter().all(|at| at.is_finite()) {
        return Some(format!("the texture coordinates of its mesh '{}' are not all finite", mesh.name));
    }
    if let Some(index) = mesh.indices.iter().find(|&&index| index as usize >= vertices) {
        return Some(format!("its mesh '{}' has index {index}, but {vertices} vertices", mesh.name));
    }
    let each = match mesh.topology {
        Topology::Triangles => 3,
        Topology::Lines => 2,
        Topology::Points => 1,
    };
    let count = mesh.indices.len();
    (!count.is_multiple_of(each))
        .then(|| format!("its mesh '{}' has {count} indices, not a multiple of {each}", mesh.name))
}

fn surface_fault(object: &Object, scene: &Scene) -> Option<String> {
    if !object.surface.cutoff.is_finite() {
        return Some("its alpha cutoff is not finite".into());
    }
    let texture = object.surface.texture?;
    match scene.textures.get(texture as usize) {
        None => Some(format!("it uses texture {texture}, but the scene has {}", scene.textures.len())),
        Some(texture) => texture.fault(),
    }
}

fn object_fault(object: &Object, bounds: &WorldBounds) -> Option<String> {
    if !object.world_from_object.is_finite() {
        return Some("its transform is not finite; check its node and the nodes above it".into());
    }
    if !object.colour.iter().all(|part| part.is_finite()) {
        return Some("its colour is not finite".into());
    }
    let most = f64::from(f32::MAX);
    let linear_fits = object.world_from_object.matrix3.to_cols_array().iter().all(|part| part.abs() <= most);
    let world = bounds.of(object.mesh, &object.world_from_object);
    let fits = world.is_valid() && world.min.abs().max(world.max.abs()).max_element() <= most;
    (!linear_fits || !fits)
        .then(|| "its transform takes it beyond the range of 32-bit numbers; scale the scene down".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::Orbit;
    use crate::model::Surface;
    use crate::texture::Texture;
    use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};

    fn triangle() -> Scene {
        let mesh = Mesh {
            name: "triangle".into(),
            topology: Topology::Triangles,
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z; 3],
            indices: vec![0, 1, 2],
            ..Mesh::default()
        };
        let object = Object {
            name: "kite".into(),
            mesh: 0,
            world_from_object: DAffine3::IDENTITY,
            colour: [1.0; 4],
            dynamic: false,
            translucent: false,
            masked: false,
            surface: Surface::default(),
        };
        Scene { name: "test".into(), meshes: vec![mesh], objects: vec![object], ..Scene::default() }
    }

    fn fault(change: impl FnOnce(&mut Scene)) -> String {
        let mut scene = triangle();
        change(&mut scene);
        scene.check().expect_err("the change is a fault").to_string()
    }

    #[test]
    fn a_plain_scene_is_good() {
        let scene = triangle();
        assert!(scene.check().is_ok());
        assert_eq!(scene.triangles(), 1);
        assert!(Scene::default().check().is_ok());
    }

    #[test]
    fn flat_point_and_reflected_objects_are_legal() {
        for scale in [DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0), DVec3::new(-1.0, 1.0, 1.0), DVec3::splat(1e-30)] {
            let mut scene = triangle();
            scene.objects[0].world_from_object.matrix3 = DMat3::from_diagonal(scale);
            assert!(scene.check().is_ok(), "scale {scale}");
        }
    }

    #[test]
    fn faults_name_the_object() {
        let faults = [
            fault(|scene| scene.objects[0].world_from_object.translation.x = f64::NAN),
            fault(|scene| scene.objects[0].world_from_object.matrix3.x_axis.y = f64::INFINITY),
            fault(|scene| scene.objects[0].world_from_object.matrix3.x_axis.y = 1e60),
            fault(|scene| scene.objects[0].world_from_object.translation.x = 1e60),
            fault(|scene| scene.objects[0].mesh = 1),
            fault(|scene| scene.objects[0].colour[2] = f32::NAN),
            fault(|scene| scene.objects[0].surface.cutoff = f32::NAN),
            fault(|scene| scene.objects[0].surface.texture = Some(0)),
            fault(|scene| {
                scene.objects[0].surface.texture = Some(0);
                scene.textures = vec![Texture { size: [2, 1], texels: vec![[0; 4]], ..Texture::default() }];
            }),
            fault(|scene| scene.meshes[0].texture_coordinates = vec![Vec2::ZERO]),
            fault(|scene| scene.meshes[0].texture_coordinates = vec![Vec2::NAN; 3]),
            fault(|scene| scene.meshes[0].colours = vec![[0.0; 4]; 4]),
            fault(|scene| scene.meshes[0].positions[1].y = f32::NAN),
            fault(|scene| scene.meshes[0].normals[1].y = f32::NAN),
            fault(|scene| scene.meshes[0].normals.truncate(2)),
            fault(|scene| scene.meshes[0].indices[1] = 3),
            fault(|scene| scene.meshes[0].indices.truncate(2)),
        ];
        for fault in faults {
            assert!(fault.starts_with("object 'kite': "), "{fault}");
        }
    }

    #[test]
    fn motion_is_checked() {
        let orbit = Orbit {
            object: 1,
            base: DAffine3::IDENTITY,
            centre: DVec3::ZERO,
            axis: DVec3::Y,
            radians_per_s: 1.0,
            bob: DVec3::ZERO,
            bob_period_s: 0.0,
        };
        let stray = fault(|scene| scene.motion = Motion::Orbits(vec![orbit]));
        assert!(stray.contains("number 1"), "{stray}");
        let broken = Orbit { object: 0, axis: DVec3::NAN, ..orbit };
        let broken = fault(|scene| scene.motion = Motion::Orbits(vec![broken]));
        assert!(broken.starts_with("object 'kite'"), "{broken}");
    }

    #[test]
    fn too_large_scenes_are_refused() {
        let most = u64::from(u32::MAX);
        assert_eq!(size_fault(1 << 24, most, most), None);
        let fault = |objects, vertices, indices| size_fault(objects, vertices, indices).unwrap_or_default();
        assert!(fault((1 << 24) + 1, 0, 0).contains("16777217 objects"));
        assert!(fault(0, most + 1, 0).contains("4294967296 vertices"));
        assert!(fault(0, 0, most + 1).contains("4294967296 indices"));
    }
}
