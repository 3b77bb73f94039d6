//! Objects: every primitive of every node's mesh, once for each instance.

use super::accessor::{Accessors, Allowed};
use super::document::Document;
use super::fault::{broken, element, label, one_line, Fault, Outcome};
use super::materials::{Look, Materials};
use super::mesh;
use super::morphs;
use super::motion::Moving;
use super::skins::{self, Deforming, Influence, Skeleton, Skeletons};
use super::tree::{node_label, placed, unit, Tree};
use crate::animation::Track;
use crate::check::MOST_OBJECTS;
use crate::model::{Mesh, Object};
use crate::morph::MorphTarget;
use glam::{DAffine3, DQuat, DVec3};
use gltf::json::accessor::Accessor;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked::Valid;
use gltf::json::{Index, Mesh as FileMesh};
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Longest object or mesh name kept, in characters: a node's name is copied to each of its instances.
const LONGEST_NAME: usize = 200;

/// Most vertices of deformed meshes. Nodes that share a deformed mesh have a copy each, so a small file could ask for much memory.
const MOST_DEFORMED_VERTICES: usize = 1 << 24;

/// A mesh primitive that has been read, and what its material says.
#[derive(Clone, Copy)]
struct Part {
    mesh: u32,
    look: Look,
}

/// An object's place, for motion.
pub(super) struct Placement {
    /// The node it hangs on.
    pub node: usize,
    /// Node from object: identity, but for instances.
    pub node_from_object: DAffine3,
    /// World from the space of the nodes: identity, but for instances of a mesh with a skin.
    pub world_from_tree: DAffine3,
}

/// EXT_mesh_gpu_instancing, which the crate does not know.
#[derive(Deserialize)]
struct Instancing {
    attributes: BTreeMap<String, u32>,
}

/// Collects objects and the meshes they share.
pub(super) struct Objects<'a> {
    document: &'a Document<'a>,
    accessors: &'a Accessors<'a>,
    skeletons: &'a Skeletons,
    moving: &'a Moving,
    /// Indexed by mesh, and by node if the node has morph weights or a skin of its own.
    parts: HashMap<(Index<FileMesh>, Option<usize>), Vec<Part>>,
    indices: usize,
    deformed_vertices: usize,
    displacements: usize,
    /// Morph targets of animated weight, by mesh. An entry is taken out when the objects of the mesh are added.
    targets: HashMap<u32, Vec<MorphTarget>>,
    /// The materials of those meshes, and their textures.
    pub materials: Materials<'a>,
    /// What has been found so far.
    pub meshes: Vec<Mesh>,
    pub objects: Vec<Object>,
    pub placements: Vec<Placement>,
    /// Meshes that skins or morph targets deform.
    pub deforming: Vec<Deforming>,
    /// Animated weights of morph targets.
    pub weights: Vec<Track<f64>>,
}

impl<'a> Objects<'a> {
    pub(super) fn new(
        document: &'a Document,
        accessors: &'a Accessors<'a>,
        (skeletons, moving): (&'a Skeletons, &'a Moving),
        folder: &'a Path,
    ) -> Self {
        Objects {
            document,
            accessors,
            skeletons,
            moving,
            parts: HashMap::new(),
            indices: 0,
            deformed_vertices: 0,
            displacements: 0,
            targets: HashMap::new(),
            materials: Materials::new(document, accessors, folder),
            meshes: Vec::new(),
            objects: Vec::new(),
            placements: Vec::new(),
            deforming: Vec::new(),
            weights: Vec::new(),
        }
    }

    /// Adds the objects of one node.
    pub(super) fn add(&mut self, node: usize, tree: &Tree) -> Outcome<()> {
        let root = &self.document.root;
        let Some(mesh) = root.nodes[node].mesh else { return Ok(()) };
        let parts = self.parts(node, mesh)?;
        let skin = root.nodes[node].skin;
        let instances = self.instances_of(node)?;
        let total = parts.len().checked_mul(instances.len()).and_then(|more| more.checked_add(self.objects.len()));
        if total.is_none_or(|total| total > MOST_OBJECTS) {
            return Err(Fault::TooLarge(format!("it has more than {MOST_OBJECTS} objects")));
        }
        let mut influences = match skin {
            Some(skin) => self.influences(mesh, &parts, self.skeletons.of(skin))?.into_iter(),
            None => Vec::new().into_iter(),
        };
        // A skinned mesh hangs on its skeleton, wherever its node is.
        let carrier = skin.map_or(node, |skin| self.skeletons.of(skin).anchor);
        let name = root.nodes[node].name.as_deref().or(root.meshes[mesh.value()].name.as_deref());
        let name = name.map_or_else(|| format!("node {node}"), |name| one_line(name, LONGEST_NAME));
        for (index, part) in parts.iter().enumerate() {
            let name = if parts.len() == 1 { name.clone() } else { format!("{name}/{index}") };
            let first = self.objects.len() as u32;
            for (instance, place) in
                instances.iter().map(|place| placement(carrier, *place, skin.is_some())).enumerate()
            {
                let name = if instances.len() == 1 { name.clone() } else { format!("{name}#{instance}") };
                let world_from_object =
                    placed(place.world_from_tree, placed(tree.world_from_node[carrier], place.node_from_object));
                if !world_from_object.is_finite() {
                    return broken(format!(
                        "{}: its place in the world is not finite",
                        node_label(self.document, node)
                    ));
                }
                let Part { mesh, look: Look { colour, translucent, masked, surface } } = *part;
                self.objects.push(Object {
                    name,
                    mesh,
                    world_from_object,
                    colour,
                    dynamic: false,
                    translucent,
                    masked,
                    surface,
                });
                self.placements.push(place);
            }
            let (targets, influences) = (self.targets.remove(&part.mesh), influences.next());
            // Without instances no object has the mesh.
            if (targets.is_some() || influences.is_some()) && !instances.is_empty() {
                self.deforming.push(Deforming {
                    mesh: part.mesh,
                    object: first,
                    skin: skin.map(|skin| skin.value()),
                    influences: influences.unwrap_or_default(),
                    targets: targets.unwrap_or_default(),
                });
            }
        }
        Ok(())
    }

    /// Node from object of each instance of a node: identity without EXT_mesh_gpu_instancing.
    fn instances_of(&self, node: usize) -> Outcome<Vec<DAffine3>> {
        let extensions = self.document.root.nodes[node].extensions.as_ref();
        match extensions.and_then(|extensions| extensions.others.get("EXT_mesh_gpu_instancing")) {
            Some(instancing) => self.instances(instancing).map_err(|fault| {
                fault.within(|| format!("{}: EXT_mesh_gpu_instancing", node_label(self.document, node)))
            }),
            None => Ok(vec![DAffine3::IDENTITY]),
        }
    }

    /// The primitives of a mesh, read when first needed.
    fn parts(&mut self, node: usize, index: Index<FileMesh>) -> Outcome<Vec<Part>> {
        let document = self.document;
        let of_node = &document.root.nodes[node];
        // No two nodes share a deformed mesh.
        let is_own = of_node.weights.is_some() || of_node.skin.is_some() || self.moving.weights(node).is_some();
        let key = (index, is_own.then_some(node));
        if let Some(parts) = self.parts.get(&key) {
            return Ok(parts.clone());
        }
        let mesh =
            element(&document.root, index, "mesh").map_err(|fault| fault.within(|| node_label(document, node)))?;
        let weights = self.weights_of(node, mesh);
        // The index of each weight among all animated weights, once a target uses it.
        let mut numbers = vec![None; weights.moves.len()];
        let mut parts = Vec::new();
        for (at, primitive) in mesh.primitives.iter().enumerate() {
            let place = || format!("{}, primitive {at}", label("mesh", index.value(), mesh.name.as_deref()));
            let name =
                mesh.name.as_deref().map_or_else(|| format!("mesh {index}"), |name| one_line(name, LONGEST_NAME));
            let name = if mesh.primitives.len() == 1 { name } else { format!("{name}/{at}") };
            let said_mode = || document.said(&format!("/meshes/{index}/primitives/{at}/mode"));
            let read = mesh::read(self.accessors, primitive, &weights, name, &mut self.indices, said_mode)
                .map_err(|fault| fault.within(place))?;
            let Some((mut read, targets)) = read else {
                tracing::warn!("{} has no positions and is not drawn", place());
                continue;
            };
            // At most one mesh an object and index, both far below 2^32.
            let mesh = self.meshes.len() as u32;
            let look = self.materials.apply(primitive, &mut read).map_err(|fault| fault.within(place))?;
            self.keep_targets(node, mesh, (&read, targets), &mut numbers)?;
            self.meshes.push(read);
            parts.push(Part { mesh, look });
        }
        self.parts.insert(key, parts.clone());
        Ok(parts)
    }

    /// Returns the weights of a mesh's morph targets on a node. Animated weights that never change are fixed.
    fn weights_of(&self, node: usize, mesh: &FileMesh) -> morphs::Weights {
        let by_default = self.document.root.nodes[node].weights.as_deref().or(mesh.weights.as_deref());
        match self.moving.weights(node) {
            None => morphs::Weights { fixed: by_default.unwrap_or(&[]).to_vec(), moves: Vec::new() },
            Some(tracks) => {
                let fixed = |track: &Track<f64>| Some(track.at(0.0) as f32).filter(|_| track.is_constant());
                morphs::Weights {
                    fixed: tracks.iter().map(|track| fixed(track).unwrap_or(0.0)).collect(),
                    moves: tracks.iter().map(|track| fixed(track).is_none()).collect(),
                }
            }
        }
    }

    /// Keeps the targets that move a mesh until its objects are added. `numbers` has the index of each of the node's weights among all
    /// weights.
    fn keep_targets(
        &mut self,
        node: usize,
        index: u32,
        (mesh, moving): (&Mesh, Vec<morphs::Moving>),
        numbers: &mut [Option<u32>],
    ) -> Outcome<()> {
        let tracks = self.moving.weights(node).unwrap_or(&[]);
        if moving.is_empty() {
            return Ok(());
        }
        self.count_deformed(mesh.positions.len())?;
        let mut targets = Vec::with_capacity(moving.len());
        for (target, displacements) in moving {
            self.displacements += displacements.len();
            morphs::check_displacements(self.displacements)?;
            let weight = *numbers[target].get_or_insert_with(|| {
                self.weights.push(tracks[target].clone());
                // Fewer than displacements.
                self.weights.len() as u32 - 1
            });
            targets.push(MorphTarget { weight, displacements });
        }
        self.targets.insert(index, targets);
        Ok(())
    }

    fn count_deformed(&mut self, vertices: usize) -> Outcome<()> {
        self.deformed_vertices += vertices;
        match self.deformed_vertices > MOST_DEFORMED_VERTICES {
            true => {
                Err(Fault::TooLarge(format!("its deformed meshes have more than {MOST_DEFORMED_VERTICES} vertices")))
            }
            false => Ok(()),
        }
    }

    /// What joints carry of each of a mesh's parts.
    fn influences(
        &mut self,
        index: Index<FileMesh>,
        parts: &[Part],
        skeleton: &Skeleton,
    ) -> Outcome<Vec<Vec<Influence>>> {
        let mesh = element(&self.document.root, index, "mesh")?;
        let drawn = |primitive: &&Primitive| primitive.attributes.contains_key(&Valid(Semantic::Positions));
        let drawn = mesh.primitives.iter().enumerate().filter(|(_, primitive)| drawn(primitive));
        let mut all = Vec::with_capacity(parts.len());
        for ((at, primitive), part) in drawn.zip(parts) {
            let vertices = self.meshes[part.mesh as usize].positions.len();
            self.count_deformed(vertices)?;
            let place = || format!("{}, primitive {at}", label("mesh", index.value(), mesh.name.as_deref()));
            let read = skins::influences(self.accessors, primitive, vertices, skeleton);
            all.push(read.map_err(|fault| fault.within(place))?);
        }
        Ok(all)
    }

    /// Node from object of each instance (EXT_mesh_gpu_instancing).
    fn instances(&self, instancing: &Value) -> Outcome<Vec<DAffine3>> {
        let instancing =
            Option::<Instancing>::deserialize(instancing).map_err(|error| Fault::Broken(error.to_string()))?;
        let Some(Instancing { attributes }) = instancing else { return Ok(vec![DAffine3::IDENTITY]) };
        let accessor = |name: &str| attributes.get(name).map(|&index| Index::<Accessor>::new(index));
        let counts = attributes.values().map(|&index| self.accessors.count(Index::new(index)));
        let counts: Vec<u64> = counts.collect::<Outcome<_>>()?;
        let Some(&count) = counts.first() else { return Ok(vec![DAffine3::IDENTITY]) };
        if counts.iter().any(|&other| other != count) {
            return broken("its attributes have different counts");
        }
        if count > MOST_OBJECTS as u64 {
            return Err(Fault::TooLarge(format!("it has more than {MOST_OBJECTS} objects")));
        }
        let vectors = |name: &str, otherwise: f32| match accessor(name) {
            Some(index) => {
                self.accessors.vectors::<3>(index, Allowed::Normalized).map_err(|fault| fault.within(|| name.into()))
            }
            None => Ok(vec![[otherwise; 3]; count as usize]),
        };
        let rotations = match accessor("ROTATION") {
            Some(index) => self
                .accessors
                .vectors::<4>(index, Allowed::Normalized)
                .map_err(|fault| fault.within(|| "ROTATION".into()))?,
            None => vec![[0.0, 0.0, 0.0, 1.0]; count as usize],
        };
        let (translations, scales) = (vectors("TRANSLATION", 0.0)?, vectors("SCALE", 1.0)?);
        let parts = translations.into_iter().zip(rotations).zip(scales);
        parts
            .map(|((translation, rotation), scale)| {
                let rotation = unit(DQuat::from_array(rotation.map(f64::from)))?;
                let (scale, translation) =
                    (DVec3::from_array(scale.map(f64::from)), DVec3::from_array(translation.map(f64::from)));
                Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
            })
            .collect()
    }
}

/// Places an instance. EXT_mesh_gpu_instancing puts it at NodeWorldXform * InstanceXform. glTF 3.7.3.3 ignores the node's transform where there is
/// a skin, which puts vertices into the world; the instance's transform stays. `carrier` is the node, or the anchor of its skin.
fn placement(carrier: usize, instance: DAffine3, skinned: bool) -> Placement {
    match skinned {
        false => Placement { node: carrier, node_from_object: instance, world_from_tree: DAffine3::IDENTITY },
        true => Placement { node: carrier, node_from_object: DAffine3::IDENTITY, world_from_tree: instance },
    }
}
