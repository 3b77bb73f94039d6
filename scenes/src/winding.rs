//! The winding of an object's triangles (glTF 2.0, section 3.7.4). Where the determinant of its current transform is negative, the
//! object is *mirrored*, and the front of a triangle is the side on which its corners go clockwise.
//!
//! The indices of a mesh never change, but a transform changes with time, and the winding with it. A scale that goes through zero, an
//! animated mirrored parent and a joint that mirrors all turn an object in the middle of an animation.

use crate::animation::{AnimatedNode, Local, Motion, NodeAnimation};
use crate::model::Scene;
use crate::morph::Deformed;
use crate::skin::{JointPlaces, RestVertex};
use glam::{DAffine3, DVec3};
use std::collections::BTreeMap;

/// The winding of every object of a scene, at any time.
#[derive(Clone, Debug, Default)]
pub struct Windings {
    /// For each skinned mesh: its skin, and the share of the mesh's vertices that each joint of the skin carries.
    skinned: BTreeMap<u32, (u32, Vec<f64>)>,
    /// The mesh of each object; empty if no mesh is deformed.
    meshes: Vec<u32>,
    turning: Vec<u32>,
}

impl Windings {
    /// Finds the objects of a scene that can change their winding. Walks over the vertices of skinned objects once.
    pub fn new(scene: &Scene) -> Self {
        let shares = |deformed: &Deformed| {
            let skin = deformed.skin?;
            Some((deformed.mesh, (skin, joint_shares(&deformed.rest, scene.skins[skin as usize].joint_count()))))
        };
        let skinned = scene.deformed.iter().filter_map(shares).collect();
        let meshes =
            if scene.deformed.is_empty() { Vec::new() } else { scene.objects.iter().map(|it| it.mesh).collect() };
        Windings { skinned, meshes, turning: turning(scene) }
    }

    /// Objects whose winding can change with time, ascending. All others keep the winding of time 0.
    pub fn turning(&self) -> &[u32] {
        &self.turning
    }

    /// True if an object with this transform is mirrored. `joints` are those of [`Scene::joints_at`] at the same time.
    ///
    /// A skinned object has a transform for each joint. The signs of its joints vote, each by the weight of the vertices that the joint
    /// carries. Joints without extent (determinant 0) do not vote.
    pub fn is_mirrored(&self, object: u32, world_from_object: &DAffine3, joints: &JointPlaces) -> bool {
        let mirrors = |place: &DAffine3| place.matrix3.determinant() < 0.0;
        let skinned = self.meshes.get(object as usize).and_then(|mesh| self.skinned.get(mesh));
        let by_joints = skinned.is_some_and(|(skin, shares)| mirrored_by(shares, joints.of(*skin)));
        mirrors(world_from_object) != by_joints
    }
}

/// Sums up the weights with which each joint carries vertices.
pub(crate) fn joint_shares(rest: &[RestVertex], joints: usize) -> Vec<f64> {
    let mut shares = vec![0.0; joints];
    for vertex in rest {
        for (joint, weight) in vertex.influences() {
            shares[joint as usize] += f64::from(weight);
        }
    }
    shares
}

/// True if the joints that mirror carry more than the others.
pub(crate) fn mirrored_by(shares: &[f64], places: &[DAffine3]) -> bool {
    let vote = |(share, place): (&f64, &DAffine3)| {
        let determinant = place.matrix3.determinant();
        if determinant == 0.0 {
            0.0
        } else {
            share * determinant.signum()
        }
    };
    shares.iter().zip(places).map(vote).sum::<f64>() < 0.0
}

fn turning(scene: &Scene) -> Vec<u32> {
    // Orbits turn and shift objects: the determinant stays.
    let Motion::Nodes(nodes) = &scene.motion else { return Vec::new() };
    let below = nodes_below_a_turning_one(nodes);
    let skin_turns = |object: u32| {
        let deformed = scene.deformation_of(scene.objects[object as usize].mesh);
        let skin = deformed.and_then(|deformed| deformed.skin).map(|skin| &scene.skins[skin as usize]);
        skin.is_some_and(|skin| skin.joints().iter().any(|joint| below[joint.node]))
    };
    let turns = |at: &&crate::animation::Attachment| below[at.node] || skin_turns(at.object);
    nodes.objects().iter().filter(turns).map(|attachment| attachment.object).collect()
}

/// Returns a flag for each node: the sign of its determinant, or of a node above it, can change.
fn nodes_below_a_turning_one(nodes: &NodeAnimation) -> Vec<bool> {
    let mut below: Vec<bool> = Vec::with_capacity(nodes.nodes().len());
    for node in nodes.nodes() {
        let above = node.parent.is_some_and(|parent| below[parent]);
        below.push(above || can_turn(node));
    }
    below
}

/// True if the sign of a node's determinant can change. The determinant is the product of the scale's factors. Between two keys of a
/// LINEAR or STEP track each factor stays between its values there. A spline can leave that range.
fn can_turn(node: &AnimatedNode) -> bool {
    let (Local::Parts { .. }, Some(track)) = (&node.local, &node.scale) else { return false };
    let Some(values) = track.values_that_bound() else { return true };
    let signs = |scale: &DVec3| scale.to_array().map(|factor| (factor > 0.0, factor < 0.0));
    let first = signs(&values[0]);
    values.iter().any(|scale| signs(scale) != first || scale.min_element() * scale.max_element() == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::{Attachment, Interpolation, Track};

    fn node(parent: Option<usize>, scale: DVec3, track: Option<(Interpolation, Vec<DVec3>)>) -> AnimatedNode {
        let keys = |values: &Vec<DVec3>, each: usize| (0..values.len() / each).map(|key| key as f64).collect();
        let track = track.map(|(kind, values)| {
            let each = if kind == Interpolation::CubicSpline { 3 } else { 1 };
            Track::new(kind, keys(&values, each), values).unwrap()
        });
        let local = Local::Parts { translation: DVec3::ZERO, rotation: glam::DQuat::IDENTITY, scale };
        let world_from_root = DAffine3::IDENTITY;
        AnimatedNode { parent, world_from_root, local, translation: None, rotation: None, scale: track }
    }

    fn turns(nodes: Vec<AnimatedNode>) -> Vec<u32> {
        let hang = |node| Attachment {
            object: node as u32,
            node,
            node_from_object: DAffine3::IDENTITY,
            world_from_tree: DAffine3::IDENTITY,
        };
        let objects = (0..nodes.len()).map(hang).collect();
        let motion = Motion::Nodes(NodeAnimation::new(nodes, objects).unwrap());
        let object = crate::model::Object {
            name: String::new(),
            mesh: 0,
            world_from_object: DAffine3::IDENTITY,
            colour: [1.0; 4],
            dynamic: true,
            translucent: false,
            masked: false,
            surface: crate::model::Surface::default(),
        };
        let all = vec![object; 2];
        turning(&Scene { motion, objects: all, ..Scene::default() })
    }

    #[test]
    fn only_a_scale_that_changes_its_sign_turns_objects_and_all_below_it() {
        let linear = |values: &[DVec3]| Some((Interpolation::Linear, values.to_vec()));
        let through_zero = linear(&[DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0)]);
        let grows = linear(&[DVec3::ONE, DVec3::splat(3.0)]);
        let stays_mirrored = linear(&[DVec3::new(-1.0, 1.0, 1.0), DVec3::new(-2.0, 5.0, 1.0)]);
        // Both ends have the same determinant, but two factors go through zero one after the other.
        let half_turn = linear(&[DVec3::ONE, DVec3::new(-1.0, -2.0, 1.0)]);
        let flat = linear(&[DVec3::ONE, DVec3::new(0.0, 1.0, 1.0)]);
        let spline = Some((Interpolation::CubicSpline, vec![DVec3::ONE; 6]));
        let one = |track| turns(vec![node(None, DVec3::ONE, track), node(Some(0), DVec3::NEG_ONE, None)]);
        assert_eq!(one(through_zero), [0, 1]);
        assert_eq!(one(half_turn), [0, 1]);
        assert_eq!(one(flat), [0, 1]);
        assert_eq!(one(spline), [0, 1], "a spline can overshoot");
        for track in [None, grows, stays_mirrored] {
            assert!(one(track).is_empty());
        }
    }

    #[test]
    fn the_joints_that_carry_most_decide() {
        let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let flat = DAffine3::from_scale(DVec3::new(0.0, 1.0, 1.0));
        let places = [DAffine3::IDENTITY, mirror, flat];
        assert!(mirrored_by(&[1.0, 2.0, 9.0], &places));
        assert!(!mirrored_by(&[2.0, 1.0, 9.0], &places));
        assert!(!mirrored_by(&[0.0, 0.0, 1.0], &places));
        let mut rest = [RestVertex::default(); 2];
        (rest[0].joints[1], rest[1].joints[0]) = (1, 1);
        rest[0].weights[..2].copy_from_slice(&[0.25, 0.75]);
        rest[1].weights[0] = 1.0;
        assert_eq!(joint_shares(&rest, 2), [0.25, 1.75]);
    }
}
