//! Writes the oracle's models as .glb files.

use super::model::{Interpolation, Material, Mesh, Model, Node, Target};
use image::{ImageFormat, Rgba, RgbaImage};
use serde_json::{json, Value};
use std::io::Cursor;

const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

#[derive(Default)]
struct File {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    images: Vec<Value>,
}

impl Model {
    /// The file.
    pub fn glb(&self) -> Vec<u8> {
        let mut file = File::default();
        let meshes: Vec<Value> = self.meshes.iter().map(|mesh| file.mesh(mesh)).collect();
        let nodes: Vec<Value> = (0..self.nodes.len()).map(|number| self.node(number)).collect();
        let roots: Vec<usize> = (0..nodes.len()).filter(|number| self.nodes[*number].parent.is_none()).collect();
        let skins: Vec<Value> = self
            .skins
            .iter()
            .map(|skin| {
                let columns = skin.inverse_binds.iter().map(|bind| glam::DMat4::from(*bind).as_mat4().to_cols_array());
                json!({ "joints": skin.joints, "inverseBindMatrices": file.floats("MAT4", columns) })
            })
            .collect();
        let (mut channels, mut samplers) = (Vec::new(), Vec::new());
        for (number, node) in self.nodes.iter().enumerate() {
            file.tracks(number, node, &mut channels, &mut samplers);
        }
        let mut document = json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": roots }], "nodes": nodes, "meshes": meshes,
            "accessors": file.accessors, "bufferViews": file.views, "buffers": [{ "byteLength": file.binary.len() }],
            "materials": file.materials,
        });
        // Lists must not be empty.
        for (list, values) in [("skins", skins), ("textures", file.textures), ("images", file.images)] {
            if !values.is_empty() {
                document[list] = values.into();
            }
        }
        if !channels.is_empty() {
            document["animations"] = json!([{ "channels": channels, "samplers": samplers }]);
        }
        container(&document, file.binary)
    }

    fn node(&self, number: usize) -> Value {
        let node = &self.nodes[number];
        let (translation, rotation, scale) = node.place;
        let children: Vec<usize> =
            (0..self.nodes.len()).filter(|other| self.nodes[*other].parent == Some(number)).collect();
        let mut value = json!({
            "translation": translation.to_array(), "rotation": rotation.to_array(), "scale": scale.to_array(),
        });
        if !children.is_empty() {
            value["children"] = children.into();
        }
        if let Some(mesh) = node.mesh {
            value["mesh"] = mesh.into();
        }
        if let Some(skin) = node.skin {
            value["skin"] = skin.into();
        }
        value
    }
}

fn container(document: &Value, mut binary: Vec<u8>) -> Vec<u8> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |number: usize| (number as u32).to_le_bytes();
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let head = [&b"glTF"[..], &word(2), &word(length), &word(json.len()), b"JSON"].concat();
    [&head[..], &json, &word(binary.len()), b"BIN\0", &binary].concat()
}

impl File {
    fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let offset = self.binary.len().next_multiple_of(4);
        self.binary.resize(offset, 0);
        self.binary.extend_from_slice(bytes);
        self.views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }));
        let view = self.views.len() - 1;
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }));
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, kind: &str, elements: impl ExactSizeIterator<Item = [f32; N]>) -> usize {
        let count = elements.len();
        let bytes: Vec<u8> = elements.flatten().flat_map(f32::to_le_bytes).collect();
        self.accessor(&bytes, FLOAT, kind, count)
    }

    fn mesh(&mut self, mesh: &Mesh) -> Value {
        let mut attributes = json!({ "POSITION": self.floats("VEC3", mesh.positions.iter().copied()) });
        if !mesh.coordinates.is_empty() {
            attributes["TEXCOORD_0"] = self.floats("VEC2", mesh.coordinates.iter().copied()).into();
        }
        if !mesh.alpha.is_empty() {
            let colours: Vec<u8> = mesh.alpha.iter().flat_map(|alpha| [200, 200, 255, *alpha]).collect();
            let accessor = self.accessor(&colours, UNSIGNED_BYTE, "VEC4", mesh.alpha.len());
            self.accessors[accessor]["normalized"] = true.into();
            attributes["COLOR_0"] = accessor.into();
        }
        if !mesh.influences.is_empty() {
            let joints: Vec<u8> = mesh.influences.iter().flat_map(|(joints, _)| *joints).collect();
            attributes["JOINTS_0"] = self.accessor(&joints, UNSIGNED_BYTE, "VEC4", mesh.influences.len()).into();
            let weights = mesh.influences.iter().map(|(_, weights)| *weights);
            attributes["WEIGHTS_0"] = self.floats("VEC4", weights).into();
        }
        let bytes: Vec<u8> = mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = self.accessor(&bytes, UNSIGNED_INT, "SCALAR", mesh.indices.len());
        let material = self.material(&mesh.material);
        let mut primitive = json!({ "attributes": attributes, "indices": indices, "material": material });
        if !mesh.targets.is_empty() {
            let targets: Vec<Value> = mesh
                .targets
                .iter()
                .map(|target| json!({ "POSITION": self.floats("VEC3", target.iter().copied()) }))
                .collect();
            primitive["targets"] = targets.into();
        }
        json!({ "primitives": [primitive] })
    }

    fn material(&mut self, material: &Material) -> usize {
        let mut surface = json!({ "baseColorFactor": [0.8, 0.7, 0.6, material.alpha] });
        if let Some((side, alpha)) = &material.texture {
            let texel = |x: u32, y: u32| Rgba([255, 255, 255, alpha[(y * side + x) as usize]]);
            let mut png = Cursor::new(Vec::new());
            let written = RgbaImage::from_fn(*side, *side, texel).write_to(&mut png, ImageFormat::Png);
            written.expect("memory takes any picture");
            self.accessor(png.get_ref(), UNSIGNED_BYTE, "SCALAR", png.get_ref().len());
            self.images.push(json!({ "bufferView": self.views.len() - 1, "mimeType": "image/png" }));
            self.textures.push(json!({ "source": self.images.len() - 1 }));
            surface["baseColorTexture"] = json!({ "index": self.textures.len() - 1 });
        }
        let mut value = json!({ "pbrMetallicRoughness": surface, "doubleSided": material.double_sided });
        if let Some(cutoff) = material.cutoff {
            (value["alphaMode"], value["alphaCutoff"]) = ("MASK".into(), cutoff.into());
        }
        self.materials.push(value);
        self.materials.len() - 1
    }

    fn tracks(&mut self, number: usize, node: &Node, channels: &mut Vec<Value>, samplers: &mut Vec<Value>) {
        for track in &node.tracks {
            let (path, kind) = match track.target {
                Target::Translation => ("translation", "VEC3"),
                Target::Rotation => ("rotation", "VEC4"),
                Target::Scale => ("scale", "VEC3"),
                Target::Weights => ("weights", "SCALAR"),
            };
            let interpolation = match track.interpolation {
                Interpolation::Step => "STEP",
                Interpolation::Linear => "LINEAR",
                Interpolation::Cubic => "CUBICSPLINE",
            };
            let input = self.floats("SCALAR", track.times.iter().map(|time| [*time]));
            let (Some(first), Some(last)) = (track.times.first(), track.times.last()) else { continue };
            (self.accessors[input]["min"], self.accessors[input]["max"]) = (json!([first]), json!([last]));
            let numbers: Vec<u8> = track.values.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
            let count = if kind == "SCALAR" { numbers.len() / 4 } else { track.values.len() };
            let output = self.accessor(&numbers, FLOAT, kind, count);
            samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
            let target = json!({ "node": number, "path": path });
            channels.push(json!({ "sampler": samplers.len() - 1, "target": target }));
        }
    }
}
