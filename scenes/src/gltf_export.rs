//! Writes any scene, with a camera path, as one .glb file.
//!
//! Kept exactly: objects in their order, names, transforms (as `f64` matrices), geometry, colours, textures, alpha modes, cells with their portals, and cameras
//! up to the rounding of their rotation; the import scales normals to length 1, which may change their last bit. Lost or changed:
//! - A mesh that is used with several colours or surfaces comes back as one mesh for each: in glTF the mesh holds its material.
//! - A texture of objects whose mesh has no texture coordinates is not drawn, and comes back as none.
//! - Objects whose mesh is empty come back as nothing: glTF has no empty meshes.
//! - Motion becomes straight lines between keys, one a frame, in `f32`. Animated nodes that carry an object or a joint are written with all
//!   nodes above them, so that objects below a parent that shears or flattens them keep their shape.
//! - Deformed meshes are written at rest, and inverse bind matrices are rounded to `f32`. An instance of a skinned mesh gets a skeleton
//!   of its own.
//! - Nodes that nothing moves are merged into the matrices of the objects below them.
//! - Cameras on moving nodes lose their motion: they are written in their place at time 0.
//! - The path is the animated camera `path <name>`, 30 keys a second, in `f32`, with the field of view of its first frame.
//! - The walk is not written, nor what is solid of a city's buildings.
//!
//! Skewed and flat matrices are beyond the letter of glTF, which wants matrices made of translation, rotation and scale.

mod binary;
mod morphs;
mod motion;
mod skins;

use crate::camera::Projection;
use crate::error::SceneError;
use crate::gltf::cells;
use crate::model::{Mesh, Object, Scene, Surface, Topology};
use crate::path::CameraPath;
use crate::texture::{Texture, Wrap};
use binary::Binary;
use glam::DAffine3;
use serde_json::{json, Value};
use std::collections::HashMap;

/// The scene, and the path sampled at `frames` frames as an animated camera, which is the file's first. Without a path, the
/// motion of one run of ten seconds, or from first key to last, is written.
///
/// # Errors
/// A scene that fails [`Scene::check`], a camera that glTF cannot express, or more than 4 GiB of data.
pub fn export_glb(scene: &Scene, path: Option<&CameraPath>, frames: usize) -> Result<Vec<u8>, SceneError> {
    scene.check()?;
    let mut export = Export::default();
    export.geometry(scene)?;
    export.textures(&scene.textures)?;
    for object in &scene.objects {
        export.object(object, &scene.meshes);
    }
    export.roots.extend(0..export.nodes.len());
    export.bent_objects(scene);
    let shots = motion::samples(scene, path, frames);
    if let Some(path) = path {
        export.path_camera(path, &shots)?;
    }
    for camera in &scene.cameras {
        let node = json!({
            "name": camera.name,
            "translation": camera.pose.position.to_array(),
            "rotation": camera.pose.rotation.to_array(),
        });
        export.camera(&camera.name, &camera.projection, camera.aspect, node)?;
    }
    let written = export.object_motion(scene, &shots);
    export.skeletons(scene, &written);
    export.weights(scene, &shots);
    export.extras = scene.cells.as_ref().map_or(Value::Null, cells::extras);
    export.finish(&scene.name)
}

/// What tells glTF materials apart: colour bits, alpha mode, cutoff bits, texture and sides.
type MaterialKey = ([u32; 4], &'static str, u32, Option<u32>, bool);

/// A glTF document in the making.
#[derive(Default)]
struct Export {
    binary: Binary,
    nodes: Vec<Value>,
    /// Nodes without a parent.
    roots: Vec<usize>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    images: Vec<Value>,
    texture_samplers: Vec<Value>,
    cameras: Vec<Value>,
    skins: Vec<Value>,
    /// Skins that are written once more for an instance: the scene's skin, and the place of the skeleton.
    placed_skins: Vec<(u32, DAffine3)>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
    /// The primitive of each scene mesh, without its material; null for empty ones.
    primitives: Vec<Value>,
    material_of: HashMap<MaterialKey, usize>,
    /// Of the scene; null for none.
    extras: Value,
    /// glTF mesh by scene mesh and material.
    mesh_of: HashMap<(u32, usize), usize>,
}

impl Export {
    fn geometry(&mut self, scene: &Scene) -> Result<(), SceneError> {
        for (mesh, index) in skins::meshes_at_rest(scene).iter().zip(0..) {
            if mesh.positions.is_empty() || mesh.indices.is_empty() {
                self.primitives.push(Value::Null);
                continue;
            }
            let positions = self.binary.positions(&mesh.positions, mesh.honoured_bounds());
            let normals = self.binary.vectors("VEC3", mesh.normals.iter().map(|normal| normal.to_array()));
            let indices = self.binary.indices(&mesh.indices);
            let mode = match mesh.topology {
                Topology::Points => 0,
                Topology::Lines => 1,
                Topology::Triangles => 4,
            };
            let mut attributes = json!({ "POSITION": positions, "NORMAL": normals });
            if !mesh.texture_coordinates.is_empty() {
                let coordinates = mesh.texture_coordinates.iter().map(|at| at.to_array());
                attributes["TEXCOORD_0"] = self.binary.vectors("VEC2", coordinates).into();
            }
            if !mesh.colours.is_empty() {
                attributes["COLOR_0"] = self.binary.vectors("VEC4", mesh.colours.iter().copied()).into();
            }
            self.influences(scene, index, &mut attributes)?;
            let mut primitive = json!({ "attributes": attributes, "indices": indices, "mode": mode });
            let targets = self.targets(scene, index);
            if !targets.is_null() {
                primitive["targets"] = targets;
            }
            self.primitives.push(primitive);
        }
        Ok(())
    }

    /// Each with a sampler and a picture of its own.
    fn textures(&mut self, textures: &[Texture]) -> Result<(), SceneError> {
        for (index, texture) in textures.iter().enumerate() {
            let file = texture.encode().map_err(|fault| SceneError::BadObject {
                object: texture.name.clone(),
                fault: format!("its texture: {fault}"),
            })?;
            let view = self.binary.file(&file);
            self.images.push(json!({ "name": texture.name, "bufferView": view, "mimeType": "image/png" }));
            let [wrap_s, wrap_t] = texture.wrap.map(|wrap| match wrap {
                Wrap::Repeat => 10_497,
                Wrap::Mirror => 33_648,
                Wrap::Clamp => 33_071,
            });
            self.texture_samplers.push(json!({ "wrapS": wrap_s, "wrapT": wrap_t }));
            self.textures.push(json!({ "sampler": index, "source": index }));
        }
        Ok(())
    }

    fn object(&mut self, object: &Object, meshes: &[Mesh]) {
        let mut node = json!({ "name": object.name });
        if object.world_from_object != DAffine3::IDENTITY {
            node["matrix"] = matrix(&object.world_from_object);
        }
        if !self.primitives[object.mesh as usize].is_null() {
            let material = self.material(object);
            node["mesh"] = self.mesh(object.mesh, material, &meshes[object.mesh as usize].name).into();
        }
        self.nodes.push(node);
    }

    fn material(&mut self, object: &Object) -> usize {
        let mode = match (object.translucent, object.masked) {
            (true, _) => "BLEND",
            (false, true) => "MASK",
            (false, false) => "OPAQUE",
        };
        let materials = &mut self.materials;
        let Surface { cutoff, texture, single_sided } = object.surface;
        let key = (object.colour.map(f32::to_bits), mode, cutoff.to_bits(), texture, single_sided);
        *self.material_of.entry(key).or_insert_with(|| {
            let mut material = json!({
                "pbrMetallicRoughness": { "baseColorFactor": object.colour.map(f64::from), "metallicFactor": 0.0 },
                "alphaMode": mode,
                "doubleSided": !single_sided,
            });
            if let Some(texture) = texture {
                material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
            }
            // Other modes have no use for it, and may not name it.
            if mode == "MASK" {
                material["alphaCutoff"] = f64::from(cutoff).into();
            }
            materials.push(material);
            materials.len() - 1
        })
    }

    fn mesh(&mut self, mesh: u32, material: usize, name: &str) -> usize {
        let (meshes, primitives) = (&mut self.meshes, &self.primitives);
        *self.mesh_of.entry((mesh, material)).or_insert_with(|| {
            let mut primitive = primitives[mesh as usize].clone();
            primitive["material"] = material.into();
            meshes.push(json!({ "name": name, "primitives": [primitive] }));
            meshes.len() - 1
        })
    }

    /// Adds a camera on a node of its own and returns the node.
    fn camera(
        &mut self,
        name: &str,
        projection: &Projection,
        aspect: Option<f64>,
        mut node: Value,
    ) -> Result<usize, SceneError> {
        let mut camera = match *projection {
            Projection::Perspective { fov_y, near, far } => {
                let mut lens = json!({ "yfov": fov_y, "znear": near });
                if let Some(far) = far {
                    lens["zfar"] = far.into();
                }
                if let Some(aspect) = aspect {
                    lens["aspectRatio"] = aspect.into();
                }
                json!({ "type": "perspective", "perspective": lens })
            }
            Projection::Orthographic { half_height, near, far } => {
                let lens = json!({ "xmag": half_height * aspect.unwrap_or(1.0), "ymag": half_height, "znear": near, "zfar": far });
                json!({ "type": "orthographic", "orthographic": lens })
            }
            Projection::Custom(_) => {
                return Err(SceneError::Unsupported {
                    path: format!("camera '{name}'").into(),
                    what: "writing a projection matrix of its own as glTF".into(),
                    remedy: "; give the camera a perspective or orthographic projection".into(),
                });
            }
        };
        camera["name"] = name.into();
        node["camera"] = self.cameras.len().into();
        self.cameras.push(camera);
        self.nodes.push(node);
        self.roots.push(self.nodes.len() - 1);
        Ok(self.nodes.len() - 1)
    }

    fn finish(self, name: &str) -> Result<Vec<u8>, SceneError> {
        let mut document = json!({
            "asset": { "version": "2.0", "generator": "Sightline" },
            "scene": 0,
            "scenes": [{ "name": name, "nodes": self.roots }],
        });
        if self.roots.is_empty() {
            document["scenes"] = json!([{ "name": name }]);
        }
        if !self.extras.is_null() {
            document["scenes"][0]["extras"] = self.extras;
        }
        let animations = match self.channels.is_empty() {
            true => Vec::new(),
            false => vec![json!({ "name": "motion", "samplers": self.samplers, "channels": self.channels })],
        };
        let (accessors, views, bytes) = self.binary.into_parts();
        let buffers = if bytes.is_empty() { Vec::new() } else { vec![json!({ "byteLength": bytes.len() })] };
        let lists = [
            ("nodes", self.nodes),
            ("meshes", self.meshes),
            ("materials", self.materials),
            ("textures", self.textures),
            ("images", self.images),
            ("samplers", self.texture_samplers),
            ("cameras", self.cameras),
            ("skins", self.skins),
            ("animations", animations),
            ("accessors", accessors),
            ("bufferViews", views),
            ("buffers", buffers),
        ];
        // glTF forbids empty lists.
        for (key, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
            document[key] = Value::Array(list);
        }
        binary::container(document.to_string().into_bytes(), bytes).ok_or_else(|| SceneError::TooLarge {
            scene: name.into(),
            fault: "it takes more than the 4 GiB of a .glb file; export it at a smaller --scale".into(),
        })
    }
}

/// The 16 numbers of a glTF node's matrix, column by column.
fn matrix(transform: &DAffine3) -> Value {
    let [x, y, z, at] = transform.to_cols_array_2d();
    json!([x[0], x[1], x[2], 0.0, y[0], y[1], y[2], 0.0, z[0], z[1], z[2], 0.0, at[0], at[1], at[2], 1.0])
}
