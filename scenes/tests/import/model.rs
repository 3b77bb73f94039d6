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

    /// Adds a buffer view that a meshopt extension compresses, with a mode and a filter. Elements are given by count and stride.
    pub fn compressed_view(
        &mut self,
        extension: &str,
        mode: &str,
        filter: &str,
        (count, stride): (usize, usize),
        stream: &[u8],
    ) -> usize {
        let view = self.view(stream);
        let offset = self.json["bufferViews"][view]["byteOffset"].clone();
        let buffers = self.json["buffers"].as_array_mut().expect("a list");
        buffers.resize(2, json!({ "byteLength": 0 }));
        let fallback = &mut buffers[1];
        let start = fallback["byteLength"].as_u64().unwrap_or(0);
        *fallback =
            json!({ "byteLength": start + (count * stride) as u64, "extensions": { extension: { "fallback": true } } });
        let compressed = json!({ "buffer": 0, "byteOffset": offset, "byteLength": stream.len(), "byteStride": stride,
            "count": count, "mode": mode, "filter": filter });
        self.json["bufferViews"][view] = json!({ "buffer": 1, "byteOffset": start, "byteLength": count * stride,
            "extensions": { extension: compressed } });
        if mode == "ATTRIBUTES" {
            self.json["bufferViews"][view]["byteStride"] = stride.into();
        }
        view
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
        let mut binary = self.binary.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        if !binary.is_empty() {
            return joined(&self.json.to_string(), &binary);
        }
        let mut json = self.json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
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

/// Splits a .glb into JSON and data; a .gltf has no data.
pub fn parts(file: &[u8]) -> (String, &[u8]) {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
    if !file.starts_with(b"glTF") {
        return (text(file), &[]);
    }
    let length = u32::from_le_bytes(file[12..16].try_into().expect("four bytes")) as usize;
    (text(&file[20..20 + length]), &file[20 + length + 8..])
}

/// Joins JSON and data to a .glb; without data, to a .gltf.
pub fn joined(json: &str, data: &[u8]) -> Vec<u8> {
    if data.is_empty() {
        return json.as_bytes().to_vec();
    }
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + data.len();
    let word = |number: usize| (number as u32).to_le_bytes();
    let header = [&b"glTF"[..], &word(2), &word(length), &word(json.len()), b"JSON"].concat();
    [&header, &json, &word(data.len())[..], b"BIN\0", data].concat()
}

/// Returns the text of each warning of a call.
pub fn warnings<T>(call: impl FnOnce() -> T) -> (T, Vec<String>) {
    let heard = Heard::default();
    let lines = heard.0.clone();
    let result = tracing::subscriber::with_default(heard, call);
    let lines = lines.lock().expect("no thread has panicked").clone();
    (result, lines)
}

#[derive(Clone, Default)]
struct Heard(std::sync::Arc<std::sync::Mutex<Vec<String>>>);

impl tracing::Subscriber for Heard {
    fn enabled(&self, metadata: &tracing::Metadata<'_>) -> bool {
        *metadata.level() <= tracing::Level::WARN
    }
    fn new_span(&self, _: &tracing::span::Attributes<'_>) -> tracing::span::Id {
        tracing::span::Id::from_u64(1)
    }
    fn record(&self, _: &tracing::span::Id, _: &tracing::span::Record<'_>) {}
    fn record_follows_from(&self, _: &tracing::span::Id, _: &tracing::span::Id) {}
    fn event(&self, event: &tracing::Event<'_>) {
        struct Text(String);
        impl tracing::field::Visit for Text {
            fn record_debug(&mut self, field: &tracing::field::Field, value: &dyn std::fmt::Debug) {
                if field.name() == "message" {
                    self.0 = format!("{value:?}");
                }
            }
        }
        let mut text = Text(String::new());
        event.record(&mut text);
        self.0.lock().expect("no thread has panicked").push(text.0);
    }
    fn enter(&self, _: &tracing::span::Id) {}
    fn exit(&self, _: &tracing::span::Id) {}
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
