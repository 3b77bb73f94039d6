//! Makes small glTF files.

use scenes::{Scene, SceneError};
use serde_json::{json, Value};
use std::path::Path;

pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const FLOAT: u32 = 5126;

/// A glTF file in the making.
pub struct Model {
    pub json: Value,
    pub binary: Vec<u8>,
}

impl Model {
    /// A file with an empty scene.
    pub fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }], "nodes": [], "meshes": [], "accessors": [],
            "bufferViews": [], "buffers": [{ "byteLength": 0 }], "cameras": [], "animations": [{ "channels": [], "samplers": [] }],
        });
        Model { json, binary: Vec::new() }
    }

    /// One triangle: mesh 0 on node 0, with positions in accessor 0 and without indices.
    pub fn triangle() -> Self {
        let mut model = Model::new();
        let positions = model.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
        model.mesh(json!({ "attributes": { "POSITION": positions } }));
        model.node(json!({ "mesh": 0 }), true);
        model
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    /// A buffer view of these bytes.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.binary.len().next_multiple_of(4);
        self.binary.resize(offset, 0);
        self.binary.extend(bytes);
        self.json["buffers"][0]["byteLength"] = self.binary.len().into();
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }))
    }

    pub fn bare_accessor(&mut self, accessor: Value) -> usize {
        self.push("accessors", accessor)
    }

    pub fn floats(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let width = match kind {
            "MAT4" => 16,
            _ => ["SCALAR", "VEC2", "VEC3", "VEC4"].iter().position(|&name| name == kind).expect("a type") + 1,
        };
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.accessor(&bytes, FLOAT, kind, numbers.len() / width)
    }

    pub fn mesh(&mut self, primitive: Value) -> usize {
        self.push("meshes", json!({ "primitives": [primitive] }))
    }

    pub fn node(&mut self, node: Value, root: bool) -> usize {
        let index = self.push("nodes", node);
        if root {
            self.json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(index.into());
        }
        index
    }

    /// Adds a channel to the animation.
    pub fn channel(&mut self, node: usize, path: &str, interpolation: &str, input: usize, output: usize) {
        let animation = &mut self.json["animations"][0];
        let samplers = animation["samplers"].as_array_mut().expect("a list");
        let sampler = samplers.len();
        samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
        let channels = animation["channels"].as_array_mut().expect("a list");
        channels.push(json!({ "sampler": sampler, "target": { "node": node, "path": path } }));
    }

    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut binary = self.binary.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let length = 12 + 8 + json.len() + 8 + binary.len();
        let word = |number: usize| (number as u32).to_le_bytes();
        [
            &b"glTF"[..],
            &word(2),
            &word(length),
            &word(json.len()),
            b"JSON",
            &json,
            &word(binary.len()),
            b"BIN\0",
            &binary,
        ]
        .concat()
    }

    pub fn import(&self) -> Result<Scene, SceneError> {
        import(&self.glb())
    }

    pub fn scene(&self) -> Scene {
        self.import().expect("a legal file")
    }

    pub fn error(&self) -> String {
        error(&self.glb())
    }
}

pub fn import(file: &[u8]) -> Result<Scene, SceneError> {
    scenes::import_bytes(Path::new("made/here.glb"), file)
}

/// The message for a file that must be refused, which is one line and names the file.
pub fn error(file: &[u8]) -> String {
    let message = import(file).expect_err("an illegal file").to_string();
    assert!(message.contains("made/here.glb") && !message.contains('\n'), "{message}");
    message
}

/// Asserts that the message has the text.
#[track_caller]
pub fn assert_says(message: &str, text: &str) {
    assert!(message.contains(text), "'{message}' should say '{text}'");
}
