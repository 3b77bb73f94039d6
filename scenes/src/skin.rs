//! Skins: meshes that a skeleton bends (glTF 2.0, section 3.7.3).
//!
//! A vertex lies at rest in a space of the mesh's own. Each of a few joints would carry it somewhere; where it is, is the mean of these places by
//! its weights. Joints hang on nodes of the scene's animation, below one node or on it, the *anchor*: the node that the object itself hangs on.
//! So an object that walks as a whole has a transform as any other, and its vertices are bent within its own space, near its own origin.
//!
//! [`Deformed`](crate::Deformed) has the meshes that they bend.

use crate::animation::{Motion, NodeAnimation};
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// Most joints of a vertex: two sets of glTF's JOINTS_n.
pub const JOINTS_A_VERTEX: usize = 8;

/// A skeleton.
#[derive(Clone, Debug)]
pub struct Skin {
    anchor: usize,
    bones: Vec<Bone>,
    joints: Vec<Joint>,
}

/// A node below the anchor that carries a joint, or another bone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bone {
    pub(crate) node: usize,
    /// The bone it hangs on, which comes before it; none for the anchor.
    pub(crate) parent: Option<usize>,
}

/// What carries vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint {
    /// Its node in the animation.
    pub(crate) node: usize,
    /// None for the anchor.
    pub(crate) bone: Option<usize>,
    /// Where the mesh at rest is, seen from the joint: its inverse bind matrix.
    pub(crate) joint_from_rest: DAffine3,
}

/// A vertex of a deformed mesh at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RestVertex {
    /// In the mesh's own space.
    pub position: Vec3,
    /// Of unit length.
    pub normal: Vec3,
    /// Joints that carry it, as indices into its skin. Unused without a skin.
    pub joints: [u32; JOINTS_A_VERTEX],
    /// Share of the vertex that each joint carries. None is negative, and they add up to 1, but for one rounding of the largest: see
    /// [`weights_of_sum_one`]. Joints of weight 0 cost nothing. Unused without a skin.
    pub weights: [f32; JOINTS_A_VERTEX],
}

impl RestVertex {
    /// The joints that carry some of it, and the share of each.
    pub fn influences(&self) -> impl Iterator<Item = (u32, f32)> + '_ {
        self.joints.iter().copied().zip(self.weights).filter(|(_, weight)| *weight > 0.0)
    }
}

impl Skin {
    /// A skeleton of these joints: each a node of the animation, and its inverse bind matrix. All must be the anchor or hang below it.
    ///
    /// # Errors
    /// What is wrong, as half a sentence.
    pub fn new(nodes: &NodeAnimation, anchor: usize, joints: &[(usize, DAffine3)]) -> Result<Self, String> {
        let count = nodes.nodes().len();
        if anchor >= count {
            return Err(format!("its anchor is node {anchor} of {count}"));
        }
        let mut needed = Vec::new();
        for (number, (joint, joint_from_rest)) in joints.iter().enumerate() {
            if !joint_from_rest.is_finite() {
                return Err(format!("the inverse bind matrix of joint {number} is not finite"));
            }
            let mut node = *joint;
            while node != anchor {
                let Some(found) = nodes.nodes().get(node) else {
                    return Err(format!("joint {number} is node {node} of {count}"));
                };
                needed.push(node);
                let Some(parent) = found.parent else {
                    return Err(format!("joint {number} does not hang below the anchor"));
                };
                node = parent;
            }
        }
        needed.sort_unstable();
        needed.dedup();
        let place = |node: usize| needed.binary_search(&node).ok();
        let bone = |node: &usize| Bone { node: *node, parent: nodes.nodes()[*node].parent.and_then(place) };
        let joint = |(node, joint_from_rest): &(usize, DAffine3)| Joint {
            node: *node,
            bone: place(*node),
            joint_from_rest: *joint_from_rest,
        };
        let bones = needed.iter().map(bone).collect();
        Ok(Skin { anchor, bones, joints: joints.iter().map(joint).collect() })
    }

    /// No bone is a node beyond so many.
    pub(crate) fn fits(&self, nodes: usize) -> bool {
        self.anchor < nodes && self.bones.iter().all(|bone| bone.node < nodes)
    }

    /// The node that its objects hang on.
    pub fn anchor(&self) -> usize {
        self.anchor
    }

    /// How many joints it has.
    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    pub(crate) fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Appends object from rest, for each joint at a time.
    pub(crate) fn places_at(&self, nodes: &NodeAnimation, seconds: f64, out: &mut Vec<DAffine3>) {
        let mut anchor_from_bone: Vec<DAffine3> = Vec::with_capacity(self.bones.len());
        for bone in &self.bones {
            let parent_from_bone = nodes.nodes()[bone.node].parent_from_node(seconds);
            anchor_from_bone.push(match bone.parent {
                Some(parent) => anchor_from_bone[parent] * parent_from_bone,
                None => parent_from_bone,
            });
        }
        out.extend(self.joints.iter().map(|joint| match joint.bone {
            Some(bone) => anchor_from_bone[bone] * joint.joint_from_rest,
            None => joint.joint_from_rest,
        }));
    }
}

/// Where each joint of each skin puts its vertices at a time: object from rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointPlaces {
    places: Vec<DAffine3>,
    /// Where each skin's begin, and where the last one's end.
    firsts: Vec<usize>,
}

impl JointPlaces {
    /// Those of skins whose nodes a motion moves.
    pub(crate) fn at(motion: &Motion, skins: &[Skin], seconds: f64) -> Self {
        let mut all = JointPlaces::default();
        let Motion::Nodes(nodes) = motion else { return all };
        for skin in skins {
            all.firsts.push(all.places.len());
            skin.places_at(nodes, seconds, &mut all.places);
        }
        all.firsts.push(all.places.len());
        all
    }

    /// Those of one skin.
    pub fn of(&self, skin: u32) -> &[DAffine3] {
        &self.places[self.first(skin)..self.firsts[skin as usize + 1]]
    }

    /// The place of one skin's first joint among all.
    pub fn first(&self, skin: u32) -> usize {
        self.firsts[skin as usize]
    }

    /// Those of all skins.
    pub fn all(&self) -> &[DAffine3] {
        &self.places
    }
}

/// Weights for [`RestVertex::weights`]: each divided by the sum of all in `f64` and rounded, and the largest is what the others leave of 1. So their sum
/// is off 1 by half a step of the largest, 2^-25, and nothing else. Where all are 0, the first joint has all of the vertex.
pub fn weights_of_sum_one(weights: [f32; JOINTS_A_VERTEX]) -> [f32; JOINTS_A_VERTEX] {
    let sum: f64 = weights.iter().copied().map(f64::from).sum();
    if sum <= 0.0 {
        return std::array::from_fn(|joint| if joint == 0 { 1.0 } else { 0.0 });
    }
    let mut parts = weights.map(|weight| (f64::from(weight) / sum) as f32);
    let largest = (1..parts.len()).fold(0, |largest, at| if parts[at] > parts[largest] { at } else { largest });
    let others: f64 = (0..parts.len()).filter(|at| *at != largest).map(|at| f64::from(parts[at])).sum();
    parts[largest] = (1.0 - others) as f32;
    parts
}

/// Computes the mean of the places of a vertex's joints, by their weights, in `f64`.
pub(crate) fn mean_place(vertex: &RestVertex, places: &[DAffine3]) -> DAffine3 {
    let mut mean = DAffine3 { matrix3: DMat3::ZERO, translation: DVec3::ZERO };
    for (joint, weight) in vertex.influences() {
        let (place, weight) = (&places[joint as usize], f64::from(weight));
        mean.matrix3 += place.matrix3 * weight;
        mean.translation += place.translation * weight;
    }
    mean
}

/// Computes the matrix of cofactors, which turns normals where the given matrix moves points. It is right for mirrored and flattened
/// places too; turned normals have any length.
pub(crate) fn cofactors(DMat3 { x_axis, y_axis, z_axis }: DMat3) -> DMat3 {
    DMat3::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis))
}

/// How far the sum of a vertex's weights may be from 1: half a step of the largest, and what summing up in `f64` may round.
pub(crate) const MOST_OFF_ONE: f64 = 1.0 / 33_554_432.0 + 1.0 / (1u64 << 50) as f64;
