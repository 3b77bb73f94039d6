//! Skins: joints, what of each vertex they carry, and the node that all of a skin hangs on.
//!
//! The node that a skinned mesh is on has no say in where the mesh is (glTF 2.0, section 3.7.3.3): its joints have. The object is put on the lowest node
//! that all joints hang on or are, and bent within its space. A skin that nothing moves is bent once, here.

use super::accessor::{Accessors, Allowed};
use super::document::Document;
use super::fault::{broken, element, label, Fault, Outcome};
use super::motion::Moving;
use super::tree::{affine, matrix, node_label, Tree};
use crate::bend::bend_for_ever;
use crate::model::Scene;
use crate::morph::{Deformed, MorphTarget};
use crate::skin::{weights_of_sum_one, RestVertex, Skin, JOINTS_A_VERTEX};
use glam::DAffine3;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked::Valid;
use gltf::json::{Index, Skin as FileSkin};
use std::collections::btree_map::{BTreeMap, Entry};

/// Joints and weights of a vertex.
pub(super) type Influence = ([u32; JOINTS_A_VERTEX], [f32; JOINTS_A_VERTEX]);

/// Most nodes above all joints of a skin together, each counted for every joint: a chain of a million joints would take hours.
const MOST_DEPTH: usize = 1 << 22;

/// A skin of the file.
pub(super) struct Skeleton {
    /// The lowest node that all joints hang on or are.
    pub(super) anchor: usize,
    /// Nodes.
    joints: Vec<usize>,
    joint_from_rest: Vec<DAffine3>,
}

/// A mesh that has been read and that is deformed.
pub(super) struct Deforming {
    pub(super) mesh: u32,
    /// The first object that has it.
    pub(super) object: u32,
    pub(super) skin: Option<usize>,
    /// One a vertex; none without a skin.
    pub(super) influences: Vec<Influence>,
    /// Targets whose weight is animated.
    pub(super) targets: Vec<MorphTarget>,
}

impl Deforming {
    /// True if the mesh changes its shape with time. `moving` has a flag for each skin that moves.
    pub(super) fn moves(&self, moving: &[bool]) -> bool {
        !self.targets.is_empty() || self.skin.is_some_and(|skin| moving[skin])
    }

    /// Returns the vertices at rest: those of the mesh.
    fn rest(&mut self, scene: &Scene) -> Vec<RestVertex> {
        let mesh = &scene.meshes[self.mesh as usize];
        let mut influences = std::mem::take(&mut self.influences).into_iter();
        let vertices = mesh.positions.iter().zip(&mesh.normals);
        let vertex = vertices.map(|(position, normal)| {
            let (joints, weights) = influences.next().unwrap_or_default();
            RestVertex { position: *position, normal: *normal, joints, weights }
        });
        vertex.collect()
    }
}

/// The skins that nodes of the scene use, by number.
pub(super) struct Skeletons(BTreeMap<usize, Skeleton>);

impl Skeletons {
    pub(super) fn read(document: &Document, accessors: &Accessors, tree: &Tree) -> Outcome<Self> {
        let mut skeletons = BTreeMap::new();
        for &node in &tree.order {
            let of_file = &document.root.nodes[node];
            let (Some(index), Some(_)) = (of_file.skin, of_file.mesh) else { continue };
            let skin =
                element(&document.root, index, "skin").map_err(|fault| fault.within(|| node_label(document, node)))?;
            if let Entry::Vacant(free) = skeletons.entry(index.value()) {
                let place = || label("skin", index.value(), skin.name.as_deref());
                let skeleton = skeleton(document, accessors, tree, skin).map_err(|fault| fault.within(place))?;
                free.insert(skeleton);
            }
        }
        Ok(Skeletons(skeletons))
    }

    /// One of those that are used.
    pub(super) fn of(&self, skin: Index<FileSkin>) -> &Skeleton {
        &self.0[&skin.value()]
    }

    /// The nodes that skins need which something moves: anchors, joints, and what is between.
    pub(super) fn bones(&self, tree: &Tree, moving: &Moving) -> Vec<usize> {
        let skeletons = self.0.values().filter(|skeleton| skeleton.moves(moving));
        let joints = skeletons.flat_map(|skeleton| skeleton.joints.iter().map(|joint| (*joint, skeleton.anchor)));
        let mut bones: Vec<usize> =
            joints.flat_map(|(joint, anchor)| up(tree, joint, anchor).chain([anchor])).collect();
        bones.sort_unstable();
        bones.dedup();
        bones
    }

    /// Deforms meshes. A mesh whose skin never moves is bent once; other meshes are handed over to the scene. `places` has the index of
    /// each node of the file in the scene's animation.
    pub(super) fn deform(
        &self,
        scene: &mut Scene,
        tree: &Tree,
        (moving, places): (&[bool], &[Option<usize>]),
        deforming: Vec<Deforming>,
    ) -> Outcome<()> {
        let (mut skins, mut deformed) = (BTreeMap::new(), Vec::new());
        for mut deforming in deforming {
            let name = scene.objects[deforming.object as usize].name.clone();
            let fault = |fault| Fault::Broken(format!("object '{name}': {fault}"));
            let mut rest = deforming.rest(scene);
            let (moves, Deforming { mesh, skin, mut targets, .. }) = (deforming.moves(moving), deforming);
            let skin = match skin {
                Some(still) if !moving[still] => {
                    let (mesh, places) = (&mut scene.meshes[mesh as usize], self.0[&still].object_from_rest(tree));
                    bend_for_ever(mesh, &mut rest, &mut targets, &places);
                    mesh.declared_bounds = None;
                    None
                }
                Some(skin) => match skins.get(&skin) {
                    Some(number) => Some(*number),
                    None => {
                        scene.skins.push(self.0[&skin].skin(scene, places).map_err(fault)?);
                        // There are no more than objects, 2^24.
                        Some(*skins.entry(skin).or_insert(scene.skins.len() as u32 - 1))
                    }
                },
                None => None,
            };
            if moves {
                deformed.push(Deformed { mesh, skin, rest, targets });
            }
        }
        scene.deform(deformed).map_err(|error| Fault::Broken(error.to_string()))
    }

    /// By number of the file's skins: something moves it.
    pub(super) fn moving(&self, document: &Document, moving: &Moving) -> Vec<bool> {
        let moves = |skin: usize| self.0.get(&skin).is_some_and(|skeleton| skeleton.moves(moving));
        (0..document.root.skins.len()).map(moves).collect()
    }
}

impl Skeleton {
    fn moves(&self, moving: &Moving) -> bool {
        self.joints.iter().any(|joint| moving.moves(*joint))
    }

    /// Where each joint puts vertices at rest, seen from the anchor, if nothing moves.
    fn object_from_rest(&self, tree: &Tree) -> Vec<DAffine3> {
        let place = |(joint, joint_from_rest): (&usize, &DAffine3)| {
            up(tree, *joint, self.anchor).fold(*joint_from_rest, |place, node| matrix(&tree.locals[node]) * place)
        };
        self.joints.iter().zip(&self.joint_from_rest).map(place).collect()
    }

    fn skin(&self, scene: &Scene, places: &[Option<usize>]) -> Result<Skin, String> {
        let crate::animation::Motion::Nodes(nodes) = &scene.motion else { return Err("nothing moves its skin".into()) };
        let place = |node: usize| places[node].ok_or_else(|| format!("node {node} is not animated"));
        let joints = self.joints.iter().zip(&self.joint_from_rest);
        let joints: Vec<(usize, DAffine3)> =
            joints.map(|(node, from)| Ok((place(*node)?, *from))).collect::<Result<_, String>>()?;
        Skin::new(nodes, place(self.anchor)?, &joints)
    }
}

/// A node and those above it, as far as below another.
fn up(tree: &Tree, node: usize, below: usize) -> impl Iterator<Item = usize> + '_ {
    std::iter::successors(Some(node), |node| tree.parents[*node]).take_while(move |node| *node != below)
}

fn skeleton(document: &Document, accessors: &Accessors, tree: &Tree, skin: &FileSkin) -> Outcome<Skeleton> {
    for &joint in &skin.joints {
        element(&document.root, joint, "node")?;
    }
    let joints: Vec<usize> = skin.joints.iter().map(|joint| joint.value()).collect();
    let Some(&first) = joints.first() else { return broken("it has no joints") };
    if let Some(joint) = joints.iter().find(|&&joint| tree.roots[joint] != tree.roots[first]) {
        return broken(format!("its joints {first} and {joint} have no common root; put them under one node"));
    }
    let depths = joints.iter().map(|joint| std::iter::successors(Some(*joint), |node| tree.parents[*node]).count());
    if depths.sum::<usize>() > MOST_DEPTH {
        return Err(Fault::TooLarge(format!("its joints hang below more than {MOST_DEPTH} nodes in all")));
    }
    if !tree.order.contains(&tree.roots[first]) {
        return broken(format!("its joints are not in the scene; add node {} to it", tree.roots[first]));
    }
    let joint_from_rest = match skin.inverse_bind_matrices {
        None => vec![DAffine3::IDENTITY; joints.len()],
        Some(index) => {
            let read = || {
                let count = accessors.count(index)?;
                if count < joints.len() as u64 {
                    return broken(format!(
                        "accessor {index} has {count} elements, but there are {} joints",
                        joints.len()
                    ));
                }
                accessors
                    .matrices(index)?
                    .iter()
                    .take(joints.len())
                    .map(|numbers| affine(&numbers.map(f64::from)))
                    .collect()
            };
            read().map_err(|fault: Fault| fault.within(|| "inverseBindMatrices".into()))?
        }
    };
    Ok(Skeleton { anchor: lowest_above(tree, &joints), joints, joint_from_rest })
}

/// The lowest node that all of these, which have one root, hang on or are.
fn lowest_above(tree: &Tree, nodes: &[usize]) -> usize {
    let path = |node: usize| {
        let mut path: Vec<usize> = std::iter::successors(Some(node), |node| tree.parents[*node]).collect();
        path.reverse();
        path
    };
    let mut common = path(nodes[0]);
    for node in &nodes[1..] {
        let shared = common.iter().zip(path(*node)).take_while(|(one, other)| **one == *other).count();
        common.truncate(shared);
    }
    // They share the root at least.
    common.last().copied().unwrap_or(nodes[0])
}

/// A set of joints and weights of a primitive: JOINTS_n and WEIGHTS_n.
struct Set {
    number: u32,
    joints: Vec<[u32; 4]>,
    weights: Vec<[f32; 4]>,
}

impl Set {
    /// Reads a set; none if the primitive does not have it.
    fn read(accessors: &Accessors, primitive: &Primitive, vertices: usize, number: u32) -> Outcome<Option<Self>> {
        let attribute = |semantic: Semantic, name: &str| {
            let Some(&index) = primitive.attributes.get(&Valid(semantic)) else {
                return broken(format!("its node has a skin, but it has no {name}"));
            };
            let count = accessors.count(index)?;
            if count != vertices as u64 {
                return broken(format!(
                    "{name}: accessor {index} has {count} elements, but there are {vertices} positions"
                ));
            }
            Ok(index)
        };
        let has = |semantic: Semantic| primitive.attributes.contains_key(&Valid(semantic));
        if number > 0 && !has(Semantic::Joints(number)) && !has(Semantic::Weights(number)) {
            return Ok(None);
        }
        let [joints_n, weights_n] = [format!("JOINTS_{number}"), format!("WEIGHTS_{number}")];
        let joints = attribute(Semantic::Joints(number), &joints_n)?;
        let weights = attribute(Semantic::Weights(number), &weights_n)?;
        let joints = accessors.joints(joints).map_err(|fault| fault.within(|| joints_n))?;
        let weights = accessors.vectors::<4>(weights, Allowed::Normalized);
        let set = Set { number, joints, weights: weights.map_err(|fault| fault.within(|| weights_n.clone()))? };
        for (vertex, weights) in set.weights.iter().enumerate() {
            if let Some(weight) = weights.iter().find(|weight| !(**weight >= 0.0 && weight.is_finite())) {
                return broken(format!("{weights_n}: a weight of vertex {vertex} is {weight}; weights are 0 or more"));
            }
        }
        Ok(Some(set))
    }

    /// Adds the set to the influences of each vertex. A vertex of more than eight joints keeps those of the largest weights.
    fn add_to(&self, influences: &mut [Influence], joints: usize) -> Outcome<()> {
        for (vertex, (joints_now, weights_now)) in influences.iter_mut().enumerate() {
            // A vertex without weights hangs on its first joint.
            if self.number == 0 && (self.joints[vertex][0] as usize) < joints {
                joints_now[0] = self.joints[vertex][0];
            }
            for (joint, weight) in self.joints[vertex].into_iter().zip(self.weights[vertex]) {
                // A joint without weight may be any number.
                if weight > 0.0 && joint as usize >= joints {
                    return broken(format!(
                        "JOINTS_{}: vertex {vertex} refers to joint {joint}, but its skin has {joints}",
                        self.number
                    ));
                }
                let least = (1..JOINTS_A_VERTEX).fold(0, |a, b| if weights_now[b] < weights_now[a] { b } else { a });
                if weight > weights_now[least] {
                    (joints_now[least], weights_now[least]) = (joint, weight);
                }
            }
        }
        Ok(())
    }
}

/// Reads the joints that carry each vertex, and their weights, which add up to 1.
pub(super) fn influences(
    accessors: &Accessors,
    primitive: &Primitive,
    vertices: usize,
    skeleton: &Skeleton,
) -> Outcome<Vec<Influence>> {
    let mut influences = vec![Influence::default(); vertices];
    for number in 0.. {
        match Set::read(accessors, primitive, vertices, number)? {
            Some(set) => set.add_to(&mut influences, skeleton.joints.len())?,
            None => break,
        }
    }
    influences.iter_mut().for_each(|(_, weights)| *weights = weights_of_sum_one(*weights));
    Ok(influences)
}
