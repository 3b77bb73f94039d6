//! Objects: every primitive of every node's mesh, once for each instance.

use super::accessor::{Accessors, Allowed};
use super::document::Document;
use super::fault::{broken, element, label, one_line, Fault, Outcome};
use super::materials::{Look, Materials};
use super::mesh;
use super::skins::{self, Bent, Influence, Skeleton, Skeletons};
use super::tree::{node_label, placed, unit, Tree};
use crate::check::MOST_OBJECTS;
use crate::model::{Mesh, Object};
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

/// Most vertices that skins bend: nodes that share a mesh each have it for themselves then, so that a small file could ask for much.
const MOST_BENT_VERTICES: usize = 1 << 24;

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
    /// By mesh, and by node if the node has morph weights of its own.
    parts: HashMap<(Index<FileMesh>, Option<usize>), Vec<Part>>,
    indices: usize,
    bent_vertices: usize,
    /// The materials of those meshes, and their textures.
    pub materials: Materials<'a>,
    /// What has been found so far.
    pub meshes: Vec<Mesh>,
    pub objects: Vec<Object>,
    pub placements: Vec<Placement>,
    /// Those that skins bend.
    pub bent: Vec<Bent>,
}

impl<'a> Objects<'a> {
    pub(super) fn new(
        document: &'a Document,
        accessors: &'a Accessors<'a>,
        skeletons: &'a Skeletons,
        folder: &'a Path,
    ) -> Self {
        Objects {
            document,
            accessors,
            skeletons,
            parts: HashMap::new(),
            indices: 0,
            bent_vertices: 0,
            materials: Materials::new(document, accessors, folder),
            meshes: Vec::new(),
            objects: Vec::new(),
            placements: Vec::new(),
            bent: Vec::new(),
        }
    }

    /// Adds the objects of one node.
    pub(super) fn add(&mut self, node: usize, tree: &Tree) -> Outcome<()> {
        let root = &self.document.root;
        let Some(mesh) = root.nodes[node].mesh else { return Ok(()) };
        let parts = self.parts(node, mesh)?;
        let skin = root.nodes[node].skin;
        let extensions = root.nodes[node].extensions.as_ref();
        let instances = match extensions.and_then(|extensions| extensions.others.get("EXT_mesh_gpu_instancing")) {
            Some(_) if skin.is_some() => return Err(instanced_skin()),
            Some(instancing) => self.instances(instancing).map_err(|fault| {
                fault.within(|| format!("{}: EXT_mesh_gpu_instancing", node_label(self.document, node)))
            })?,
            None => vec![DAffine3::IDENTITY],
        };
        let total = parts.len().checked_mul(instances.len()).and_then(|more| more.checked_add(self.objects.len()));
        if total.is_none_or(|total| total > MOST_OBJECTS) {
            return Err(Fault::TooLarge(format!("it has more than {MOST_OBJECTS} objects")));
        }
        let mut influences = match skin {
            Some(skin) => self.influences(mesh, &parts, self.skeletons.of(skin))?.into_iter(),
            None => Vec::new().into_iter(),
        };
        // What a skeleton bends hangs on that, wherever its node is.
        let carrier = skin.map_or(node, |skin| self.skeletons.of(skin).anchor);
        let name = root.nodes[node].name.as_deref().or(root.meshes[mesh.value()].name.as_deref());
        let name = name.map_or_else(|| format!("node {node}"), |name| one_line(name, LONGEST_NAME));
        for (index, part) in parts.iter().enumerate() {
            let name = if parts.len() == 1 { name.clone() } else { format!("{name}/{index}") };
            for (instance, &node_from_object) in instances.iter().enumerate() {
                let name = if instances.len() == 1 { name.clone() } else { format!("{name}#{instance}") };
                let world_from_object = placed(tree.world_from_node[carrier], node_from_object);
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
                self.placements.push(Placement { node: carrier, node_from_object });
                if let Some((skin, influences)) = skin.zip(influences.next()) {
                    // There are at most 2^24 objects.
                    let object = self.objects.len() as u32 - 1;
                    self.bent.push(Bent { object, skin: skin.value(), influences });
                }
            }
        }
        Ok(())
    }

    /// The primitives of a mesh, read when first needed.
    fn parts(&mut self, node: usize, index: Index<FileMesh>) -> Outcome<Vec<Part>> {
        let document = self.document;
        let own_weights = document.root.nodes[node].weights.as_deref();
        // What is bent is nobody else's.
        let is_own = own_weights.is_some() || document.root.nodes[node].skin.is_some();
        let key = (index, is_own.then_some(node));
        if let Some(parts) = self.parts.get(&key) {
            return Ok(parts.clone());
        }
        let mesh =
            element(&document.root, index, "mesh").map_err(|fault| fault.within(|| node_label(document, node)))?;
        let weights = own_weights.or(mesh.weights.as_deref()).unwrap_or(&[]);
        let mut parts = Vec::new();
        for (at, primitive) in mesh.primitives.iter().enumerate() {
            let place = || format!("{}, primitive {at}", label("mesh", index.value(), mesh.name.as_deref()));
            let name =
                mesh.name.as_deref().map_or_else(|| format!("mesh {index}"), |name| one_line(name, LONGEST_NAME));
            let name = if mesh.primitives.len() == 1 { name } else { format!("{name}/{at}") };
            let said_mode = || document.said(&format!("/meshes/{index}/primitives/{at}/mode"));
            let read = mesh::read(self.accessors, primitive, weights, name, &mut self.indices, said_mode)
                .map_err(|fault| fault.within(place))?;
            let Some(mut read) = read else {
                tracing::warn!("{} has no positions and is not drawn", place());
                continue;
            };
            // At most one mesh an object and index, both far below 2^32.
            let mesh = self.meshes.len() as u32;
            let look = self.materials.apply(primitive, &mut read).map_err(|fault| fault.within(place))?;
            self.meshes.push(read);
            parts.push(Part { mesh, look });
        }
        self.parts.insert(key, parts.clone());
        Ok(parts)
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
            self.bent_vertices += vertices;
            if self.bent_vertices > MOST_BENT_VERTICES {
                return Err(Fault::TooLarge(format!("its skins bend more than {MOST_BENT_VERTICES} vertices")));
            }
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

/// No one says where an instance of a mesh would be that is wherever its joints are.
fn instanced_skin() -> Fault {
    Fault::Unsupported {
        what: "a skinned mesh with EXT_mesh_gpu_instancing".into(),
        remedy: "give each instance a node and a skin of its own".into(),
    }
}
