//! Reads glTF 2.0, as .gltf with its data beside or within it, or as .glb.
//!
//! The import reads meshes of every mode and vertex format (KHR_mesh_quantization included), compressed or not; instances
//! (EXT_mesh_gpu_instancing); node trees in `f64`; node animation; and cameras. Of materials it reads the base colour with its texture
//! (PNG, JPEG or WebP; KHR_texture_transform), vertex colours, the alpha mode and its cutoff, and which sides show. Skins bend their
//! meshes, by eight joints a vertex, and animated weights of morph targets are played. Lights and other textures are not read.
//! `extensions.rs` lists all extensions and the treatment of each.
//!
//! Whatever is in the file, [`import`] returns: it does not panic, does not recurse, and allocates in proportion to the file.

mod accessor;
mod buffers;
mod cameras;
pub(crate) mod cells;
mod compressed;
mod container;
mod document;
mod extensions;
mod fault;
mod looks;
mod materials;
mod mesh;
mod morphs;
mod motion;
pub(crate) mod normals;
mod numbers;
mod objects;
mod pictures;
mod skins;
mod tree;
mod uri;
mod visibility;

use crate::animation::{Attachment, Motion, NodeAnimation, Track};
use crate::camera::Camera;
use crate::error::SceneError;
use crate::model::Scene;
use crate::skin::JOINTS_A_VERTEX;
use accessor::Accessors;
use document::Document;
use fault::{broken, Fault, Outcome};
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked::Valid;
use motion::Moving;
use objects::{Objects, Placement};
use skins::{Deforming, Skeletons};
use std::path::Path;
use tree::{node_label, Tree};

/// Reads a .gltf or .glb file, as a scene that [`Scene::check`] finds in order. Its default scene, or else its first, is taken; a file without one gives an empty scene.
///
/// There is one object for each mesh primitive of each node (and instance), in order of node, then primitive; nodes that show the
/// same mesh share it. Objects and cameras on animated nodes are placed as at time 0 and move with [`Scene::motion`].
///
/// # Errors
/// If the file or its data cannot be read, breaks the specification, requires an extension that Sightline does not know, or has
/// more than 2^24 objects or 2^31 indices. The message is one line; it names the file, the element and the fault.
pub fn import(path: &Path) -> Result<Scene, SceneError> {
    let file = std::fs::read(path).map_err(|cause| SceneError::Read { path: path.into(), cause })?;
    import_bytes(path, &file)
}

/// Reads the contents of a .gltf or .glb file, like [`import`]. `path` names the scene and the file in errors; data files are looked
/// for in its folder.
///
/// # Errors
/// As [`import`].
pub fn import_bytes(path: &Path, file: &[u8]) -> Result<Scene, SceneError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let scene = read(file, folder, name).map_err(|fault| fault.in_file(path))?;
    if scene.objects.is_empty() {
        tracing::warn!("{}: there is nothing to draw: {}", path.display(), why_empty(file));
    }
    Ok(scene)
}

/// Returns the reason why a legal file shows nothing.
fn why_empty(file: &[u8]) -> &'static str {
    let json = container::split(file).ok().and_then(|parts| serde_json::from_slice(parts.json).ok());
    let json: serde_json::Value = json.unwrap_or_default();
    let filled = |list: &str| json[list].as_array().is_some_and(|list| !list.is_empty());
    match (filled("scenes"), filled("meshes")) {
        (false, _) => "it has no scene; list the root nodes in `scenes`",
        (true, false) => "it has no mesh",
        (true, true) => "no node of the scene that is shown has a mesh; choose another with `scene`",
    }
}

fn read(file: &[u8], folder: &Path, name: String) -> Outcome<Scene> {
    let parts = container::split(file)?;
    let json = numbers::whole(parts.json);
    let mut document = document::parse(&json)?;
    looks::settle(&mut document.root.materials);
    let tree = Tree::new(&document)?;
    let hidden = visibility::hidden(&document.root, &tree);
    let mut buffers = buffers::load(&document.root, parts.binary, folder)?;
    let size = json.len() as u64 + buffers::stored(&buffers);
    compressed::decode(&mut document, &mut buffers)?;
    let accessors = Accessors::new(&document, &buffers, size);
    let moving = Moving::read(&document, &accessors, &tree)?;
    let skeletons = Skeletons::read(&document, &accessors, &tree)?;

    let mut objects = Objects::new(&document, &accessors, (&skeletons, &moving), folder);
    let mut cameras = Vec::new();
    // In order of index, whatever the tree looks like.
    let mut nodes = tree.order.clone();
    nodes.sort_unstable();
    for &node in &nodes {
        if !hidden[node] {
            objects.add(node, &tree)?;
        }
        if let Some(camera) = document.root.nodes[node].camera {
            let name = document.root.nodes[node].name.as_deref();
            let camera = cameras::read(&document, camera, name, tree.world_from_camera(node));
            cameras.push((node, camera.map_err(|fault| fault.within(|| node_label(&document, node)))?));
        }
    }
    warn_of_joints(&document, &name, &nodes);
    let (nodes_of_cameras, cameras) = cameras.into_iter().unzip();
    let Objects { meshes, materials, placements, deforming, weights, objects, .. } = objects;
    let mut scene = Scene { name, meshes, objects, textures: materials.textures, cameras, ..Scene::default() };
    scene.cells = cells::read(&document)?;
    let moving_skins = skeletons.moving(&document, &moving);
    let deforms = deforming_objects(&scene, &deforming, &moving_skins);
    let mut bones = skeletons.bones(&tree, &moving);
    bones.extend(placements.iter().zip(&deforms).filter(|(_, deforms)| **deforms).map(|(placed, _)| placed.node));
    let moves = placements.iter().zip(deforms).map(|(placed, deforms)| deforms || moving.moves(placed.node));
    let carried = Carried { placements: &placements, moves: moves.collect(), bones, weights };
    let places = set_in_motion(&mut scene, &document, &tree, moving, carried, nodes_of_cameras)?;
    skeletons.deform(&mut scene, &tree, (&moving_skins, &places), deforming)?;
    check_cameras(&scene.cameras)?;
    scene.faults().map_err(|error| Fault::Broken(error.to_string()))?;
    Ok(scene)
}

/// What nodes carry.
struct Carried<'a> {
    /// By object.
    placements: &'a [Placement],
    moves: Vec<bool>,
    /// Nodes of skins that move, and those that carry deformed meshes.
    bones: Vec<usize>,
    /// Animated weights of morph targets.
    weights: Vec<Track<f64>>,
}

/// Returns a flag for each object: its mesh changes its shape with time.
fn deforming_objects(scene: &Scene, deforming: &[Deforming], moving_skins: &[bool]) -> Vec<bool> {
    let mut deforms = vec![false; scene.meshes.len()];
    deforming.iter().for_each(|deforming| deforms[deforming.mesh as usize] = deforming.moves(moving_skins));
    scene.objects.iter().map(|object| deforms[object.mesh as usize]).collect()
}

/// Hangs objects and cameras on the animated nodes and puts them where they are at time 0. Gives the place of each of the file's nodes among the animated ones.
fn set_in_motion(
    scene: &mut Scene,
    document: &Document,
    tree: &Tree,
    moving: Moving,
    objects: Carried<'_>,
    nodes_of_cameras: Vec<usize>,
) -> Outcome<Vec<Option<usize>>> {
    let carriers =
        objects.placements.iter().zip(&objects.moves).filter(|(_, moves)| **moves).map(|(placed, _)| placed.node);
    let moves: Vec<bool> = nodes_of_cameras.iter().map(|&node| moving.moves(node)).collect();
    let cameras = nodes_of_cameras.iter().copied().zip(&moves).filter(|(_, moves)| **moves).map(|(node, _)| node);
    let carriers: Vec<usize> = carriers.chain(cameras).collect();
    if carriers.is_empty() {
        return Ok(vec![None; document.root.nodes.len()]);
    }
    let (nodes, places) = moving.into_nodes(document, tree, (&carriers, &objects.bones))?;
    let placements = objects.placements.iter().zip(&objects.moves).enumerate().filter(|(_, (_, moves))| **moves);
    let attachments = placements.filter_map(|(object, (placement, _))| {
        let node = places[placement.node]?;
        // There are at most 2^24 objects.
        let Placement { node_from_object, world_from_tree, .. } = *placement;
        Some(Attachment { object: object as u32, node, node_from_object, world_from_tree })
    });
    let animation = NodeAnimation::new(nodes, attachments.collect()).map_err(Fault::Broken)?;
    scene.motion = Motion::Nodes(animation.with_weights(objects.weights));
    let mut transforms = Vec::new();
    scene.motion.transforms_at(0.0, &mut transforms);
    for (index, world_from_object) in transforms {
        let object = &mut scene.objects[index as usize];
        if !world_from_object.is_finite() {
            return broken(format!("object '{}': its place at time 0 is not finite", object.name));
        }
        (object.world_from_object, object.dynamic) = (world_from_object, true);
    }
    for ((camera, node), moves) in scene.cameras.iter_mut().zip(nodes_of_cameras).zip(moves) {
        camera.node = places[node].filter(|_| moves);
        if let Some(pose) = camera.node.and_then(|node| scene.motion.camera_pose_at(node, 0.0)) {
            camera.pose = pose;
        }
    }
    Ok(places)
}

fn check_cameras(cameras: &[Camera]) -> Outcome<()> {
    match cameras.iter().find(|camera| !(camera.pose.position.is_finite() && camera.pose.rotation.is_finite())) {
        Some(camera) => broken(format!("camera '{}': its place in the world is not finite", camera.name)),
        None => Ok(()),
    }
}

/// Warns once of meshes that are bent by fewer joints than the file gives them.
fn warn_of_joints(document: &Document, scene: &str, nodes: &[usize]) {
    let meshes = nodes
        .iter()
        .filter_map(|&node| document.root.nodes[node].mesh.filter(|_| document.root.nodes[node].skin.is_some()));
    let primitives = meshes.filter_map(|mesh| document.root.meshes.get(mesh.value())).flat_map(|mesh| &mesh.primitives);
    let more = primitives.filter(|primitive| primitive.attributes.contains_key(&Valid(Semantic::Joints(2)))).count();
    if more > 0 {
        tracing::warn!(
            "{scene}: {more} skinned meshes have more than {JOINTS_A_VERTEX} joints a vertex (JOINTS_2); the {JOINTS_A_VERTEX} of the largest weights bend it"
        );
    }
}
