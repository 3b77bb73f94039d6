//! The triangles of a scene at one time, for the oracle.

use super::{mirrors, Mask, Side, Surface, Triangle, Wide};
use glam::{DAffine3, DVec2};
use scenes::{JointPlaces, Mesh, Object, Scene, Topology};
use std::rc::Rc;

/// Returns all surfaces that can show in the item buffer, at a time in seconds. Translucent objects cannot.
pub fn surfaces(scene: &Scene, seconds: f64) -> (Vec<Surface>, Wide) {
    let meshes = scene.meshes_at(seconds);
    let joints = scene.joints_at(seconds);
    let mut places: Vec<DAffine3> = scene.objects.iter().map(|object| object.world_from_object).collect();
    let mut moved = Vec::new();
    scene.motion.transforms_at(seconds, &mut moved);
    moved.iter().for_each(|(object, place)| places[*object as usize] = *place);
    let textures: Vec<Rc<scenes::Texture>> = scene.textures.iter().cloned().map(Rc::new).collect();
    let (mut surfaces, mut wide) = (Vec::new(), Wide::default());
    for (number, (object, place)) in scene.objects.iter().zip(&places).enumerate() {
        let mesh = &meshes[object.mesh as usize];
        if object.translucent {
            continue;
        }
        if mesh.topology != Topology::Triangles {
            wide.segments.extend(segments(mesh, place));
            continue;
        }
        surfaces.push(Surface {
            object: number as u32,
            triangles: mesh.indices.chunks_exact(3).map(|corners| triangle(mesh, place, corners)).collect(),
            side: side(scene, number as u32, place, &joints),
            mask: object.masked.then(|| mask(object, mesh, &textures)),
        });
    }
    (surfaces, wide)
}

fn triangle(mesh: &Mesh, place: &DAffine3, corners: &[u32]) -> Triangle {
    let corners = [0, 1, 2].map(|at| corners[at] as usize);
    let alpha = |vertex: usize| mesh.colours.get(vertex).map_or(1.0, |colour| f64::from(colour[3]));
    let coordinates = |vertex: usize| mesh.texture_coordinates.get(vertex).map_or(DVec2::ZERO, |at| at.as_dvec2());
    Triangle {
        corners: corners.map(|vertex| place.transform_point3(mesh.positions[vertex].as_dvec3())),
        alpha: corners.map(alpha),
        coordinates: corners.map(coordinates),
    }
}

fn segments(mesh: &Mesh, place: &DAffine3) -> Vec<[glam::DVec3; 2]> {
    let position = |vertex: u32| place.transform_point3(mesh.positions[vertex as usize].as_dvec3());
    match mesh.topology {
        Topology::Lines => mesh.indices.chunks_exact(2).map(|ends| [position(ends[0]), position(ends[1])]).collect(),
        _ => mesh.indices.iter().map(|vertex| [position(*vertex); 2]).collect(),
    }
}

/// The front side of an object, by the determinant of its transform, and of its joints by the weight that they carry.
fn side(scene: &Scene, object: u32, place: &DAffine3, joints: &JointPlaces) -> Side {
    if !scene.objects[object as usize].surface.single_sided {
        return Side::Both;
    }
    let deformed = scene.deformation_of(scene.objects[object as usize].mesh);
    let by_joints = deformed.and_then(|deformed| Some((deformed, deformed.skin?))).is_some_and(|(deformed, skin)| {
        let votes = deformed.rest.iter().flat_map(|vertex| vertex.influences()).map(|(joint, weight)| {
            let determinant = joints.of(skin)[joint as usize].matrix3.determinant();
            f64::from(weight) * if determinant == 0.0 { 0.0 } else { determinant.signum() }
        });
        votes.sum::<f64>() < 0.0
    });
    match mirrors(&place.matrix3) != by_joints {
        true => Side::Clockwise,
        false => Side::CounterClockwise,
    }
}

fn mask(object: &Object, mesh: &Mesh, textures: &[Rc<scenes::Texture>]) -> Mask {
    let texture = object.surface.texture.filter(|_| !mesh.texture_coordinates.is_empty());
    Mask {
        cutoff: f64::from(object.surface.cutoff),
        factor: f64::from(object.colour[3]),
        texture: texture.map(|texture| textures[texture as usize].clone()),
    }
}
