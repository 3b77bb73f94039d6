//! Declared bounds: the box that a mesh's maker says it lies in, and whether that can be believed (EOVC thesis, section V and
//! figure 18: wrong bounding boxes).
//!
//! A box that holds every vertex is honoured, however large: an animation may need the room, and all that it costs is time. A
//! box that does not (inverted, empty, NaN, infinite, too small) would cull what can be seen, so the vertices' own box is taken
//! instead, with a warning. Nothing is ever culled because of what a file declares.

use crate::model::{Aabb, Mesh, Scene};
use glam::DVec3;

/// Meshes that one warning names.
const MOST_NAMES: usize = 8;

impl Aabb {
    /// The eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        let Aabb { min, max } = *self;
        std::array::from_fn(|corner| {
            let side = |bit: usize, low: f64, high: f64| if corner >> bit & 1 == 0 { low } else { high };
            DVec3::new(side(0, min.x, max.x), side(1, min.y, max.y), side(2, min.z, max.z))
        })
    }
}

impl Mesh {
    /// The declared box, in object space, if there is one that holds every vertex and is not simply the vertices' own.
    pub fn honoured_bounds(&self) -> Option<Aabb> {
        let honoured = self.declared_fault().is_none() && !self.positions.is_empty();
        self.declared_bounds.filter(|declared| honoured && *declared != self.bounds())
    }

    /// What is wrong with the declared box; none if nothing is, or nothing is declared.
    pub fn declared_fault(&self) -> Option<&'static str> {
        let declared = self.declared_bounds?;
        let Aabb { min, max } = declared;
        if min.is_nan() || max.is_nan() {
            Some("NaN")
        } else if declared == Aabb::EMPTY {
            Some("empty")
        } else if min.cmpgt(max).any() {
            Some("inverted")
        } else if !declared.is_valid() {
            Some("infinite")
        } else if !self.positions.iter().all(|position| declared.contains(position.as_dvec3())) {
            Some("too small for its vertices")
        } else {
            None
        }
    }
}

impl Scene {
    /// Forgets declared boxes that do not hold their mesh, which takes the box of its vertices instead, and warns of them once.
    /// `source` is the file or the name that the scene was opened by. Returns how many there were.
    pub fn repair_bounds(&mut self, source: &str) -> usize {
        let faults = self.bounds_faults();
        self.warn_of_bounds(source);
        self.meshes
            .iter_mut()
            .filter(|mesh| mesh.declared_fault().is_some())
            .for_each(|mesh| mesh.declared_bounds = None);
        faults.len()
    }

    /// Every mesh whose declared box is wrong, in words that name the mesh, an object that uses it, and the fault.
    pub fn bounds_faults(&self) -> Vec<String> {
        let fault = |(index, mesh): (usize, &Mesh)| {
            let fault = mesh.declared_fault()?;
            let user = self.objects.iter().find(|object| object.mesh as usize == index);
            let user = user.map_or_else(String::new, |object| format!(" (object '{}')", object.name));
            Some(format!("mesh '{}'{user}: {fault}", mesh.name))
        };
        self.meshes.iter().enumerate().filter_map(fault).collect()
    }

    pub(crate) fn warn_of_bounds(&self, source: &str) {
        let faults = self.bounds_faults();
        if faults.is_empty() {
            return;
        }
        let named = faults[..faults.len().min(MOST_NAMES)].join("; ");
        let others = faults.len().saturating_sub(MOST_NAMES);
        let others = if others == 0 { String::new() } else { format!("; and {others} more") };
        tracing::warn!(
            "{source}: declared bounds are wrong, those of the vertices are used instead; correct them where the scene was made: \
             {named}{others}"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Object, Surface};
    use crate::WorldBounds;
    use glam::{DAffine3, Vec3};

    const TIGHT: Aabb = Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE };

    fn scene(declared: Aabb) -> Scene {
        let positions = vec![Vec3::NEG_ONE, Vec3::ONE, Vec3::new(1.0, -1.0, 0.5)];
        let mesh = Mesh { name: "sail".into(), positions, declared_bounds: Some(declared), ..Mesh::default() };
        let world_from_object = DAffine3::from_translation(DVec3::X);
        let object = Object {
            name: "boat".into(),
            mesh: 0,
            world_from_object,
            colour: [1.0; 4],
            dynamic: false,
            translucent: false,
            masked: false,
            surface: Surface::default(),
        };
        Scene { name: "test".into(), meshes: vec![mesh], objects: vec![object], ..Scene::default() }
    }

    #[test]
    fn boxes_that_hold_the_mesh_are_honoured() {
        let large = Aabb { min: DVec3::splat(-5.0), max: DVec3::new(1.0, 2.0, 30.0) };
        let mut scene = scene(large);
        assert_eq!(scene.repair_bounds("test"), 0);
        let world = scene.world_bounds(0);
        assert!((world.max - DVec3::new(2.0, 2.0, 30.0)).abs().max_element() < 1e-4, "{world:?}");
        assert_eq!(WorldBounds::new(&scene).of(0, &scene.objects[0].world_from_object), world);
    }

    #[test]
    fn wrong_boxes_are_repaired_and_named() {
        let wrong = [
            (Aabb { min: DVec3::ONE, max: DVec3::NEG_ONE }, "inverted"),
            (Aabb::EMPTY, "empty"),
            (Aabb { min: DVec3::new(-1.0, f64::NAN, -1.0), ..TIGHT }, "NaN"),
            (Aabb { max: DVec3::new(1.0, 1.0, f64::INFINITY), ..TIGHT }, "infinite"),
            (Aabb { max: DVec3::new(1.0, 0.999, 1.0), ..TIGHT }, "too small"),
            (Aabb { min: DVec3::ZERO, max: DVec3::ZERO }, "too small"),
        ];
        let mut right = scene(TIGHT);
        right.meshes[0].declared_bounds = None;
        for (declared, fault) in wrong {
            let mut scene = scene(declared);
            // Before it is repaired too: whoever makes a scene by hand loses nothing.
            assert_eq!(scene.world_bounds(0), right.world_bounds(0), "{fault}");
            let faults = scene.bounds_faults().join("");
            assert!(["sail", "boat", fault].iter().all(|part| faults.contains(part)), "{faults}");
            assert_eq!((scene.repair_bounds("test"), scene.repair_bounds("test")), (1, 0));
            assert_eq!(scene.world_bounds(0), right.world_bounds(0), "{fault}");
        }
    }

    #[test]
    fn declaring_the_vertices_own_box_changes_nothing() {
        let mut with = scene(TIGHT);
        with.objects[0].world_from_object = DAffine3::from_rotation_y(0.7);
        let mut without = with.clone();
        without.meshes[0].declared_bounds = None;
        assert_eq!(with.world_bounds(0), without.world_bounds(0));
        assert_eq!(with.meshes[0].honoured_bounds(), None);
    }

    #[test]
    fn a_broken_vertex_shows_whatever_is_declared() {
        let mut scene = scene(Aabb { min: DVec3::splat(-9.0), max: DVec3::splat(9.0) });
        scene.meshes[0].positions[1].y = f32::NAN;
        assert!(!scene.world_bounds(0).is_valid());
    }
}
