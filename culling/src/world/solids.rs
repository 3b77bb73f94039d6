//! What a scene says of itself beside what is drawn: what is solid of its buildings, and its cells.

use super::World;
use glam::DVec3;
use scenes::{Building, Cells, Scene, Topology};

/// An upright box that an opaque object's closed mesh encloses: the object stays where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// The world's object.
    pub object: u32,
    /// Its middle.
    pub centre: DVec3,
    /// Its half extents: across, up, across.
    pub axes: [DVec3; 3],
}

impl World {
    /// What is solid of the scene's buildings.
    pub fn solids(&self) -> &[Solid] {
        &self.host.solids
    }

    /// The scene's cells, if it has such.
    pub fn cells(&self) -> Option<&Cells> {
        self.host.cells.as_ref()
    }
}

/// How far from upright and square, as the cosine of an angle, what `f32` made of a turn about +y may be.
const SQUARE: f64 = 1e-6;

/// Those of a scene. What is not upright, moves or can be seen through is none.
pub(super) fn solids(scene: &Scene, object_of_scene: &[u32]) -> Vec<Solid> {
    let solid = |building: &Building| {
        let object = scene.objects.get(building.object as usize)?;
        let mesh = &scene.meshes[object.mesh as usize];
        let opaque = !object.dynamic && !object.translucent && !object.masked && mesh.topology == Topology::Triangles;
        let (half, linear) = (building.solid.half_extent(), object.world_from_object.matrix3);
        let axes = [linear.x_axis * half.x, linear.y_axis * half.y, linear.z_axis * half.z];
        let centre = object.world_from_object.transform_point3(building.solid.centre());
        let is_solid = opaque && centre.is_finite() && is_upright(&axes);
        is_solid.then(|| Solid { object: object_of_scene[building.object as usize], centre, axes })
    };
    scene.buildings.iter().filter_map(solid).collect()
}

fn is_upright(axes: &[DVec3; 3]) -> bool {
    let square = |one: DVec3, other: DVec3| one.dot(other).abs() <= SQUARE * one.length() * other.length();
    let [x, up, z] = *axes;
    let sized = axes.iter().all(|axis| axis.is_finite() && axis.length() > 0.0);
    sized && square(x, z) && [x, z].iter().all(|axis| square(*axis, DVec3::Y) && square(*axis, up))
}
