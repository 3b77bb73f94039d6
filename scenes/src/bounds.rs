//! Boxes: of points, of meshes, and of objects in the world, rounded outward for the GPU.

mod reach;

pub(crate) use reach::{Reach, SMALLEST, TRANSFORM_ERROR};

use crate::model::{Aabb, Mesh, Object, Scene};
use glam::{DAffine3, DVec3};

impl Aabb {
    /// The box of nothing: `min` is above `max`, and a union with it changes nothing.
    pub const EMPTY: Aabb = Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around points; [`Aabb::EMPTY`] if there are none.
    pub fn from_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points
            .into_iter()
            .fold(Self::EMPTY, |bounds, point| Aabb { min: bounds.min.min(point), max: bounds.max.max(point) })
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest box around this box after a transform, up to rounding in `f64`. The empty box stays empty.
    pub fn transformed(self, transform: &DAffine3) -> Self {
        if !self.is_valid() {
            return self;
        }
        // Arvo 1990: each output axis takes the smaller and the larger product of each input axis.
        let columns = transform.matrix3;
        let mut bounds = Aabb { min: transform.translation, max: transform.translation };
        let axes = [columns.x_axis, columns.y_axis, columns.z_axis];
        for (axis, (low, high)) in axes.iter().zip(self.min.to_array().into_iter().zip(self.max.to_array())) {
            bounds.min += (*axis * low).min(*axis * high);
            bounds.max += (*axis * low).max(*axis * high);
        }
        bounds
    }

    /// The box that reaches so much farther in each direction.
    pub fn widened(self, by: DVec3) -> Self {
        Aabb { min: self.min - by, max: self.max + by }
    }

    /// The middle.
    pub fn centre(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Half the size along each axis.
    pub fn half_extent(&self) -> DVec3 {
        0.5 * self.max - 0.5 * self.min
    }

    /// Finite and not inverted. Flat boxes and points are valid.
    pub fn is_valid(&self) -> bool {
        self.min.is_finite() && self.max.is_finite() && self.min.cmple(self.max).all()
    }

    /// The point lies in the box or on its surface.
    pub fn contains(&self, point: DVec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }
}

impl Mesh {
    /// The smallest box around its vertices, in object space; [`Aabb::EMPTY`] if there are none.
    pub fn bounds(&self) -> Aabb {
        Aabb::from_points(self.positions.iter().map(|position| position.as_dvec3()))
    }
}

impl Scene {
    /// World bounds of one object at time 0, see [`WorldBounds`]. Walks over its mesh: for many objects, keep a [`WorldBounds`].
    ///
    /// # Panics
    /// If there is no such object or mesh.
    pub fn world_bounds(&self, object: usize) -> Aabb {
        let Object { mesh, world_from_object, .. } = &self.objects[object];
        Reach::of(&self.meshes[*mesh as usize]).transformed(world_from_object)
    }

    /// World bounds of the scene at time 0; [`Aabb::EMPTY`] without objects.
    pub fn bounds(&self) -> Aabb {
        let bounds = WorldBounds::new(self);
        let of = |object: &Object| bounds.of(object.mesh, &object.world_from_object);
        self.objects.iter().map(of).fold(Aabb::EMPTY, Aabb::union)
    }
}

/// Makes world bounds for the objects of a scene, at any transform.
///
/// A mesh is known by how far it reaches in the 26 directions whose components are -1, 0 or 1. A world axis, seen from the
/// object, is a sum of at most three of these with weights >= 0, and the reach in a sum is at most the sum of the reaches.
/// So each bound costs three products however large the mesh. It is exact for transforms that keep axes on axes and for
/// meshes that are boxes, never looser than the transformed local box, and at most 13 % too wide for a sphere.
///
/// A mesh that declares a larger box than it needs has that box's reach.
///
/// Bounds are rounded outward by what the GPU's arithmetic can add, so they hold each vertex where the GPU puts it.
#[derive(Clone, Debug)]
pub struct WorldBounds {
    reaches: Vec<Reach>,
}

impl WorldBounds {
    /// Walks once over all meshes.
    pub fn new(scene: &Scene) -> Self {
        WorldBounds { reaches: scene.meshes.iter().map(Reach::of).collect() }
    }

    /// World bounds of a mesh under a transform. A mesh without vertices gives the point at its origin.
    /// A transform that is not finite gives bounds that are not valid.
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn of(&self, mesh: u32, world_from_object: &DAffine3) -> Aabb {
        self.reaches[mesh as usize].transformed(world_from_object)
    }

    /// How far a mesh reaches.
    pub(crate) fn reach(&self, mesh: u32) -> &Reach {
        &self.reaches[mesh as usize]
    }

    /// The box of a mesh in object space; the point at its origin if it has no vertices.
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn in_object_space(&self, mesh: u32) -> Aabb {
        self.reaches[mesh as usize].in_object_space()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Surface;
    use glam::{DMat3, DQuat, Vec3};
    use proptest::prelude::*;

    fn mesh(positions: Vec<Vec3>) -> Mesh {
        Mesh { positions, ..Mesh::default() }
    }

    fn scene(positions: Vec<Vec3>, world_from_object: DAffine3) -> Scene {
        let object = Object {
            name: "thing".into(),
            mesh: 0,
            world_from_object,
            colour: [1.0; 4],
            dynamic: false,
            translucent: false,
            masked: false,
            surface: Surface::default(),
        };
        Scene { meshes: vec![mesh(positions)], objects: vec![object], ..Scene::default() }
    }

    /// The vertex as the GPU turns it: see `clip_from_object` in shaders/glsl/include/transform.glsl.
    fn gpu_vertex(transform: &DAffine3, position: Vec3) -> DVec3 {
        let columns = transform.matrix3.as_mat3();
        let turned = columns.x_axis * position.x + columns.y_axis * position.y + columns.z_axis * position.z;
        turned.as_dvec3() + transform.translation
    }

    fn any_transform() -> impl Strategy<Value = DAffine3> {
        let number = prop_oneof![-2.0..2.0f64, Just(0.0), Just(1.0), -1e-6..1e-6f64, -1e5..1e5f64, Just(1e-39)];
        (prop::array::uniform9(number), prop::array::uniform3(-2e6..2e6f64))
            .prop_map(|(linear, at)| DAffine3 { matrix3: DMat3::from_cols_array(&linear), translation: at.into() })
    }

    fn any_points() -> impl Strategy<Value = Vec<Vec3>> {
        let number = prop_oneof![-1.0..1.0f32, -1e4..1e4f32, Just(0.0f32), Just(1e-40f32)];
        prop::collection::vec(prop::array::uniform3(number).prop_map(Vec3::from), 1..40)
    }

    proptest! {
        #[test]
        fn world_bounds_hold_every_vertex_where_the_gpu_puts_it(points in any_points(), transform in any_transform()) {
            let bounds = scene(points.clone(), transform).world_bounds(0);
            prop_assert!(bounds.is_valid());
            for point in points {
                let vertex = gpu_vertex(&transform, point);
                prop_assert!(bounds.contains(vertex), "{vertex} is outside {bounds:?}");
            }
        }

        #[test]
        fn world_bounds_are_no_looser_than_the_transformed_box(points in any_points(), transform in any_transform()) {
            let bounds = scene(points.clone(), transform).world_bounds(0);
            let box_bounds = mesh(points.clone()).bounds().transformed(&transform);
            let largest = points.iter().fold(DVec3::ZERO, |sum, point| sum.max(point.as_dvec3().abs()));
            let rows = transform.matrix3.transpose();
            let slack = DVec3::new(
                rows.x_axis.abs().dot(largest), rows.y_axis.abs().dot(largest), rows.z_axis.abs().dot(largest),
            ) * 3e-7 + transform.translation.abs() * 1e-15 + 1e-30;
            prop_assert!(bounds.min.cmpge(box_bounds.min - slack).all(), "{bounds:?} {box_bounds:?}");
            prop_assert!(bounds.max.cmple(box_bounds.max + slack).all(), "{bounds:?} {box_bounds:?}");
        }
    }

    #[test]
    fn rotated_round_meshes_have_tight_bounds() {
        let points = (0..2000).map(|step| {
            let height = 1.0 - 2.0 * (step as f32 + 0.5) / 2000.0;
            let angle = step as f32 * 2.399_963;
            let ring = (1.0 - height * height).sqrt();
            Vec3::new(ring * angle.cos(), height, ring * angle.sin())
        });
        let turned = DAffine3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -0.7));
        let bounds = scene(points.collect(), turned).world_bounds(0);
        assert!(bounds.half_extent().max_element() < 1.13, "{bounds:?}");
    }

    #[test]
    fn an_object_of_no_size_has_a_point_for_bounds() {
        let at = DVec3::new(1.0, 2.0, 3.0);
        let transform = DAffine3 { matrix3: DMat3::ZERO, translation: at };
        let bounds = scene(vec![Vec3::ONE, Vec3::NEG_ONE], transform).world_bounds(0);
        assert_eq!(bounds, Aabb { min: at, max: at });
    }

    #[test]
    fn a_mesh_scaled_flat_has_a_flat_box() {
        let transform = DAffine3::from_scale(DVec3::new(1.0, 0.0, -1.0));
        let bounds = scene(vec![Vec3::ONE, Vec3::NEG_ONE], transform).world_bounds(0);
        assert_eq!((bounds.min.y, bounds.max.y), (0.0, 0.0));
        assert!(bounds.is_valid());
    }

    #[test]
    fn a_broken_vertex_shows_in_the_bounds() {
        let bounds = scene(vec![Vec3::ONE, Vec3::NAN, Vec3::ZERO], DAffine3::IDENTITY).world_bounds(0);
        assert!(!bounds.is_valid());
    }

    #[test]
    fn the_empty_box_is_neutral() {
        let one = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
        assert!(!Aabb::EMPTY.is_valid());
        assert_eq!(Aabb::EMPTY.union(one), one);
        assert_eq!(Aabb::EMPTY.transformed(&DAffine3::IDENTITY), Aabb::EMPTY);
        assert_eq!(Scene::default().bounds(), Aabb::EMPTY);
    }
}
