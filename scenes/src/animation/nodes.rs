//! A tree of nodes whose places are animated, and what hangs on them.

use super::Track;
use crate::camera::Pose;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Where a node is in its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Local {
    /// Translation, rotation and scale, each of which a track may replace.
    Parts {
        /// In metres.
        translation: DVec3,
        /// Of unit length.
        rotation: DQuat,
        /// Per axis; may be negative.
        scale: DVec3,
    },
    /// Any affine matrix; tracks do not apply to it.
    Matrix(DAffine3),
}

/// One node of a [`NodeAnimation`].
#[derive(Clone, Debug)]
pub struct AnimatedNode {
    /// The node it hangs on, which comes before it in the list; none for a root.
    pub parent: Option<usize>,
    /// For a root: world from whatever it hangs on, which does not move. Ignored for others.
    pub world_from_root: DAffine3,
    /// Its place in its parent where no track says otherwise.
    pub local: Local,
    /// Animated translation in metres.
    pub translation: Option<Track<DVec3>>,
    /// Animated rotation.
    pub rotation: Option<Track<DQuat>>,
    /// Animated scale.
    pub scale: Option<Track<DVec3>>,
}

impl AnimatedNode {
    /// Parent from node at a time.
    pub fn parent_from_node(&self, seconds: f64) -> DAffine3 {
        match self.local {
            Local::Matrix(matrix) => matrix,
            Local::Parts { translation, rotation, scale } => DAffine3::from_scale_rotation_translation(
                self.scale.as_ref().map_or(scale, |track| track.at(seconds)),
                self.rotation.as_ref().map_or(rotation, |track| track.at(seconds)),
                self.translation.as_ref().map_or(translation, |track| track.at(seconds)),
            ),
        }
    }

    /// The same without the node's own scale, which cameras ignore. A matrix keeps all that it is.
    pub(crate) fn parent_from_camera(&self, seconds: f64) -> DAffine3 {
        match self.local {
            Local::Matrix(matrix) => matrix,
            Local::Parts { translation, rotation, .. } => DAffine3::from_rotation_translation(
                self.rotation.as_ref().map_or(rotation, |track| track.at(seconds)),
                self.translation.as_ref().map_or(translation, |track| track.at(seconds)),
            ),
        }
    }

    /// Times of its first and last key, if it has any.
    fn duration_s(&self) -> Option<(f64, f64)> {
        let tracks = [
            self.translation.as_ref().map(Track::duration_s),
            self.rotation.as_ref().map(Track::duration_s),
            self.scale.as_ref().map(Track::duration_s),
        ];
        tracks.into_iter().flatten().reduce(union)
    }
}

fn union(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// An object that hangs on a node.
#[derive(Clone, Copy, PartialEq)]
pub struct Attachment {
    /// Index of the object in its scene.
    pub object: u32,
    /// Index of the node in the animation.
    pub node: usize,
    /// Node from object: identity, or the place of one instance of many on a node.
    pub node_from_object: DAffine3,
    /// World from the space in which the tree moves: identity, or the place of one instance of a mesh that a skeleton bends.
    pub world_from_tree: DAffine3,
}

impl Attachment {
    /// Makes an object that is exactly where its node is.
    pub fn new(object: u32, node: usize) -> Self {
        Attachment { object, node, node_from_object: DAffine3::IDENTITY, world_from_tree: DAffine3::IDENTITY }
    }
}

/// Scenes are hashed by this text, so it names `world_from_tree` only where that is not the identity.
impl std::fmt::Debug for Attachment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut text = f.debug_struct("Attachment");
        text.field("object", &self.object).field("node", &self.node).field("node_from_object", &self.node_from_object);
        if self.world_from_tree != DAffine3::IDENTITY {
            text.field("world_from_tree", &self.world_from_tree);
        }
        text.finish()
    }
}

/// A tree of animated nodes, the objects on them, and the animated weights of morph targets.
#[derive(Clone, Default)]
pub struct NodeAnimation {
    nodes: Vec<AnimatedNode>,
    objects: Vec<Attachment>,
    weights: Vec<Track<f64>>,
    /// The smallest and the largest value of each of `weights`.
    weight_ranges: Vec<[f64; 2]>,
}

/// Scenes are hashed by this text, so it names weights only where there are some.
impl std::fmt::Debug for NodeAnimation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut text = f.debug_struct("NodeAnimation");
        text.field("nodes", &self.nodes).field("objects", &self.objects);
        if !self.weights.is_empty() {
            text.field("weights", &self.weights);
        }
        text.finish()
    }
}

impl NodeAnimation {
    /// An animation of nodes in which parents come before their children. Objects are put in order of index.
    ///
    /// # Errors
    /// What is wrong, as half a sentence: a parent at or after its child, an object on no node, or one that hangs on two.
    pub fn new(nodes: Vec<AnimatedNode>, mut objects: Vec<Attachment>) -> Result<Self, String> {
        for (index, node) in nodes.iter().enumerate() {
            if node.parent.is_some_and(|parent| parent >= index) {
                return Err(format!("node {index} comes before its parent"));
            }
        }
        objects.sort_by_key(|attachment| attachment.object);
        if let Some(pair) = objects.windows(2).find(|pair| pair[0].object == pair[1].object) {
            return Err(format!("object {} hangs on two nodes", pair[0].object));
        }
        if let Some(stray) = objects.iter().find(|attachment| attachment.node >= nodes.len()) {
            return Err(format!("object {} hangs on node {} of {}", stray.object, stray.node, nodes.len()));
        }
        Ok(NodeAnimation { nodes, objects, weights: Vec::new(), weight_ranges: Vec::new() })
    }

    /// Adds animated weights. [`MorphTarget::weight`](crate::MorphTarget::weight) is an index into them.
    pub fn with_weights(self, weights: Vec<Track<f64>>) -> Self {
        // Once a track, not once for each target that it moves: a file may have many keys and many primitives.
        let weight_ranges = weights.iter().map(Track::range).collect();
        NodeAnimation { weights, weight_ranges, ..self }
    }

    /// The smallest and the largest value that each of [`NodeAnimation::weights`] ever has.
    pub(crate) fn weight_ranges(&self) -> &[[f64; 2]] {
        &self.weight_ranges
    }

    /// The animated weights of morph targets.
    pub fn weights(&self) -> &[Track<f64>] {
        &self.weights
    }

    /// The nodes, parents before children.
    pub fn nodes(&self) -> &[AnimatedNode] {
        &self.nodes
    }

    /// The objects that move, by ascending index.
    pub fn objects(&self) -> &[Attachment] {
        &self.objects
    }

    /// Times of the first and the last key in seconds; (0, 0) without keys.
    pub fn duration_s(&self) -> (f64, f64) {
        let nodes = self.nodes.iter().filter_map(AnimatedNode::duration_s);
        nodes.chain(self.weights.iter().map(Track::duration_s)).reduce(union).unwrap_or((0.0, 0.0))
    }

    /// Appends world from object for each object at a time, by ascending object index.
    pub fn transforms_at(&self, seconds: f64, out: &mut Vec<(u32, DAffine3)>) {
        // Parents come first, so one pass over the list does what a recursion would, at any depth.
        let mut world: Vec<DAffine3> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let world_from_parent = node.parent.map_or(node.world_from_root, |parent| world[parent]);
            world.push(world_from_parent * node.parent_from_node(seconds));
        }
        let place = |on: &Attachment| {
            let tree_from_object = world[on.node] * on.node_from_object;
            // A product with the identity would turn -0 into 0, and other bytes mean another hash.
            match on.world_from_tree == DAffine3::IDENTITY {
                true => tree_from_object,
                false => on.world_from_tree * tree_from_object,
            }
        };
        out.extend(self.objects.iter().map(|attachment| (attachment.object, place(attachment))));
    }

    /// World from node at a time, or none if there is no such node. Costs the node's depth, not the size of the tree.
    pub fn world_from_node(&self, node: usize, seconds: f64) -> Option<DAffine3> {
        let mut current = self.nodes.get(node)?;
        let mut chain = vec![current];
        while let Some(parent) = current.parent {
            current = &self.nodes[parent];
            chain.push(current);
        }
        // Multiplied from the root down, in the order of `transforms_at`, so that both round alike.
        Some(chain.iter().rev().fold(current.world_from_root, |world, node| world * node.parent_from_node(seconds)))
    }

    /// Where a camera on the node is and looks at a time, or none if there is no such node. The node's own scale is ignored (glTF 2.0, 3.10.2).
    pub fn pose_at(&self, node: usize, seconds: f64) -> Option<Pose> {
        let own = self.nodes.get(node)?;
        let world_from_parent = match own.parent {
            Some(parent) => self.world_from_node(parent, seconds)?,
            None => own.world_from_root,
        };
        Some(pose_of(world_from_parent * own.parent_from_camera(seconds)))
    }
}

/// The rigid part of a camera's world transform: scale, shear and reflection are dropped, the view direction is kept.
pub(crate) fn pose_of(world_from_camera: DAffine3) -> Pose {
    let axes = world_from_camera.matrix3;
    let back = axes.z_axis.normalize_or(DVec3::Z);
    // The plane through the camera's y and z axes is kept; x follows from it.
    let right = axes.y_axis.cross(back).normalize_or(back.any_orthonormal_vector());
    let rotation = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)).normalize();
    Pose { position: world_from_camera.translation, rotation }
}
