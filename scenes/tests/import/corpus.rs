//! Small files of every kind that the import reads, made in code: seeds of the mutation tests and of `examples/mutate_imports.rs`.

use crate::model::{Model, FLOAT, U16, U8};
use base64::engine::general_purpose::STANDARD;
use base64::Engine;
use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, MeshEncoder, PointAttribute,
};
use image::{ImageFormat, Rgba, RgbaImage};
use image_webp::{ColorType, WebPEncoder};
use meshoptimizer_rs::codec::{
    encode_filter_color, encode_filter_exp, encode_filter_oct, encode_filter_quat, encode_index_buffer,
    encode_index_sequence, encode_vertex_buffer, ExpMode, IndexEncoding, VertexEncoding,
};
use meshoptimizer_rs::Workspace;
use serde_json::json;
use std::io::Cursor;

/// Vertices along a side of the grid.
const SIDE: usize = 5;

/// A lossy WebP picture of 16x16 pixels, by libwebp 1.2.4: the first pixel is [235, 2, 8].
pub const LOSSY_WEBP: &str =
    "UklGRj4AAABXRUJQVlA4IDIAAACQAQCdASoQABAAD8BoJbACdGuAA1AA/u7bP89ofADFB0d/wacNBUP/5KzX+iomPoYAAA==";

/// As above with alpha, by the same: the first pixel is transparent.
pub const LOSSY_ALPHA_WEBP: &str = "UklGRgABAABXRUJQVlA4WAoAAAAQAAAADwAADwAAQUxQSHsAAAABcBoATBylj33R/aLq8VEsgKvDIVkBmyUYgA06A5N0kPYuHSEiFLZt22TvpD0DPmGrZsRZtT/QoSZjSGP35oOs895ZOh5qkc4QmWM4CVsApW3glHPiYLUCmMnFdJVypehoBkDjOZf7Lpm9QRlkRy6RB4n/IP6T/I9fEAAAVlA4IF4AAADQAgCdASoQABAAAoBCJbACdLoAngDeAP2q/YD2AAgAAP7vdtfy09IJ8MywtRQXbaoERHWRhyCYz/7URfp9XTtJOf/qiIFPimBTUT/9URflUS8p5uf878KeVamRAKAA";

/// All seeds, each with its name.
pub fn all() -> Vec<(&'static str, Vec<u8>)> {
    let mut files = vec![
        ("rich", rich().glb()),
        ("meshopt-ext", meshopt("EXT_meshopt_compression").glb()),
        ("meshopt-khr", meshopt("KHR_meshopt_compression").glb()),
        ("webp-lossless", textured(&webp()).glb()),
        ("webp-lossy", textured(&decoded(LOSSY_WEBP)).glb()),
        ("webp-alpha", textured(&decoded(LOSSY_ALPHA_WEBP)).glb()),
        ("quantized", quantized().glb()),
        ("morph", morph().glb()),
        ("text", text().into_bytes()),
    ];
    // Valence and standard EdgeBreaker, and the sequential method.
    files.extend([("draco-0", 0), ("draco-6", 6), ("draco-10", 10)].map(|(name, speed)| (name, draco(speed).glb())));
    files
}

pub fn decoded(base64: &str) -> Vec<u8> {
    STANDARD.decode(base64).expect("base64 as above")
}

/// A picture of 3x2 texels.
pub fn png() -> Vec<u8> {
    let picture = RgbaImage::from_fn(3, 2, |x, y| Rgba([x as u8 * 10, y as u8 * 20, 7, 100 * y as u8]));
    let mut file = Cursor::new(Vec::new());
    picture.write_to(&mut file, ImageFormat::Png).expect("it can be written");
    file.into_inner()
}

/// The same picture.
pub fn webp() -> Vec<u8> {
    let texels: Vec<u8> = (0..6u8).flat_map(|at| [at % 3 * 10, at / 3 * 20, 7, at / 3 * 100]).collect();
    let mut file = Vec::new();
    WebPEncoder::new(&mut file).encode(&texels, 3, 2, ColorType::Rgba8).expect("it can be written");
    file
}

/// Corners of a wavy grid, and its triangles.
pub fn grid() -> (Vec<[f32; 3]>, Vec<u32>) {
    let wave = |x: usize, y: usize| [x as f32 / 4.0, y as f32 / 4.0, (x * y % 3) as f32 / 8.0];
    let corners = (0..SIDE * SIDE).map(|at| wave(at % SIDE, at / SIDE)).collect();
    let cells = (0..(SIDE - 1) * (SIDE - 1)).map(|at| (at % (SIDE - 1) + at / (SIDE - 1) * SIDE) as u32);
    let side = SIDE as u32;
    let triangles = cells.flat_map(|a| [a, a + 1, a + side, a + 1, a + side + 1, a + side]).collect();
    (corners, triangles)
}

/// The grid, compressed as gltfpack does: positions by the exponential filter, octahedral normals, and colours and a quaternion track where
/// the extension has them.
pub fn meshopt(extension: &str) -> Model {
    let khr = extension.starts_with("KHR");
    let (encoding, workspace) = (VertexEncoding::new(khr.into(), 2).expect("a version"), &mut Workspace::default());
    let (corners, triangles) = grid();
    let count = corners.len();
    let mut model = Model::new();
    let vertices = |model: &mut Model, filter: &str, stride: usize, filtered: &[u8], workspace: &mut Workspace| {
        let count = filtered.len() / stride;
        let stream = encode_vertex_buffer(filtered, count, stride, encoding, workspace).expect("a stream");
        model.compressed_view(extension, "ATTRIBUTES", filter, (count, stride), &stream)
    };
    let floats = corners.as_flattened();
    let exponential = encode_filter_exp(count, 12, 20, floats, ExpMode::SharedVector, workspace).expect("a filter");
    let view = vertices(&mut model, "EXPONENTIAL", 12, &exponential, workspace);
    let positions = model.bare_accessor(
        json!({ "bufferView": view, "componentType": FLOAT, "type": "VEC3", "count": count, "min": [0, 0, 0], "max": [1, 1, 0.25] }),
    );
    let up: Vec<f32> = std::iter::repeat_n([0.0, 0.6, 0.8, 0.0], count).flatten().collect();
    let octahedral = encode_filter_oct(count, 4, 8, &up, workspace).expect("a filter");
    let view = vertices(&mut model, "OCTAHEDRAL", 4, &octahedral, workspace);
    let normals = model.bare_accessor(
        json!({ "bufferView": view, "componentType": 5120, "normalized": true, "type": "VEC3", "count": count }),
    );
    let mut attributes = json!({ "POSITION": positions, "NORMAL": normals });
    if khr {
        let green: Vec<f32> = std::iter::repeat_n([0.0, 1.0, 0.0, 1.0], count).flatten().collect();
        let colours = encode_filter_color(count, 4, 8, &green, workspace).expect("a filter");
        let view = vertices(&mut model, "COLOR", 4, &colours, workspace);
        attributes["COLOR_0"] = model
            .bare_accessor(
                json!({ "bufferView": view, "componentType": U8, "normalized": true, "type": "VEC4", "count": count }),
            )
            .into();
    }
    let turns = encode_filter_quat(2, 8, 16, &[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0], workspace).expect("a filter");
    let view = vertices(&mut model, "QUATERNION", 8, &turns, workspace);
    let turns = model.bare_accessor(
        json!({ "bufferView": view, "componentType": 5122, "normalized": true, "type": "VEC4", "count": 2 }),
    );
    let stream = encode_index_buffer(&triangles, IndexEncoding::DEFAULT, workspace).expect("a stream");
    let view = model.compressed_view(extension, "TRIANGLES", "NONE", (triangles.len(), 2), &stream);
    let list = model
        .bare_accessor(json!({ "bufferView": view, "componentType": U16, "type": "SCALAR", "count": triangles.len() }));
    let stream = encode_index_sequence(&[0, 1, 5, 6, 10, 11], IndexEncoding::DEFAULT, workspace).expect("a stream");
    let view = model.compressed_view(extension, "INDICES", "NONE", (6, 4), &stream);
    let strip = model.bare_accessor(json!({ "bufferView": view, "componentType": 5125, "type": "SCALAR", "count": 6 }));
    model.mesh(json!({ "attributes": attributes, "indices": list }));
    model.mesh(json!({ "attributes": attributes, "indices": strip, "mode": 5 }));
    model.node(json!({ "mesh": 0 }), true);
    model.node(json!({ "mesh": 1 }), true);
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    model.channel(0, "rotation", "LINEAR", times, turns);
    model.json["extensionsUsed"] = json!([extension, "KHR_mesh_quantization"]);
    model.json["extensionsRequired"] = model.json["extensionsUsed"].clone();
    model
}

/// An attribute of Draco, of little-endian bytes.
fn attribute(kind: GeometryAttributeType, width: usize, data: DataType, bytes: Vec<u8>) -> PointAttribute {
    let mut attribute = PointAttribute::new();
    attribute.init(kind, width as u8, data, false, bytes.len() / (width * data.byte_length()));
    attribute.buffer_mut().write(0, &bytes);
    attribute
}

fn floats<const N: usize>(kind: GeometryAttributeType, vectors: &[[f32; N]]) -> PointAttribute {
    let bytes = vectors.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
    attribute(kind, N, DataType::Float32, bytes)
}

fn draco_encoded(attributes: Vec<PointAttribute>, vertices: usize, triangles: &[u32], speed: i32) -> Vec<u8> {
    let mut mesh = draco_core::Mesh::new();
    for attribute in attributes {
        mesh.add_attribute(attribute);
    }
    mesh.set_num_points(vertices);
    mesh.set_num_faces(triangles.len() / 3);
    for (face, corners) in triangles.chunks_exact(3).enumerate() {
        mesh.set_face(FaceIndex(face as u32), [corners[0].into(), corners[1].into(), corners[2].into()]);
    }
    let mut options = EncoderOptions::new();
    options.set_global_int("encoding_speed", speed);
    options.set_global_int("decoding_speed", speed);
    for (attribute, bits) in [(0, 14), (1, 10), (2, 12)] {
        options.set_attribute_int(attribute, "quantization_bits", bits);
    }
    let (mut encoder, mut stream) = (MeshEncoder::new(), EncoderBuffer::new());
    encoder.set_mesh(mesh);
    encoder.encode(&options, &mut stream).expect("a stream");
    stream.data().to_vec()
}

/// A Draco stream of a mesh with positions alone.
pub fn draco_positions(corners: &[[f32; 3]], triangles: &[u32], speed: i32) -> Vec<u8> {
    draco_encoded(vec![floats(GeometryAttributeType::Position, corners)], corners.len(), triangles, speed)
}

/// A Draco stream of a mesh with positions, normals, texture coordinates, joints and weights, in this order.
pub fn draco_stream(corners: &[[f32; 3]], triangles: &[u32], speed: i32) -> Vec<u8> {
    let count = corners.len();
    let coordinates: Vec<[f32; 2]> = corners.iter().map(|[x, y, _]| [*x, *y]).collect();
    let joints = (0..count).flat_map(|at| [(at % 2) as u8, 0, 0, 0]).collect();
    let attributes = vec![
        floats(GeometryAttributeType::Position, corners),
        floats(GeometryAttributeType::Normal, &vec![[0.0, 0.6, 0.8]; count]),
        floats(GeometryAttributeType::TexCoord, &coordinates),
        attribute(GeometryAttributeType::Generic, 4, DataType::Uint8, joints),
        floats(GeometryAttributeType::Generic, &vec![[1.0, 0.0, 0.0, 0.0]; count]),
    ];
    draco_encoded(attributes, count, triangles, speed)
}

/// The grid as a primitive that Draco has compressed, bent by a skin of two joints.
pub fn draco(speed: i32) -> Model {
    let (corners, triangles) = grid();
    let (count, mut model) = (corners.len(), Model::new());
    let view = model.view(&draco_stream(&corners, &triangles, speed));
    let names = ["POSITION", "NORMAL", "TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"];
    let (mut attributes, mut ids) = (json!({}), json!({}));
    let kinds = [(FLOAT, "VEC3"), (FLOAT, "VEC3"), (FLOAT, "VEC2"), (U8, "VEC4"), (FLOAT, "VEC4")];
    for (id, (name, (component, kind))) in names.into_iter().zip(kinds).enumerate() {
        attributes[name] =
            model.bare_accessor(json!({ "componentType": component, "type": kind, "count": count })).into();
        ids[name] = id.into();
    }
    let indices = model.bare_accessor(json!({ "componentType": U16, "type": "SCALAR", "count": triangles.len() }));
    let extension = json!({ "KHR_draco_mesh_compression": { "bufferView": view, "attributes": ids } });
    model.mesh(json!({ "attributes": attributes, "indices": indices, "extensions": extension }));
    model.node(json!({ "mesh": 0, "skin": 0 }), true);
    model.node(json!({ "children": [2] }), true);
    model.node(json!({ "translation": [0, 0, 1] }), false);
    model.json["skins"] = json!([{ "joints": [1, 2] }]);
    let (times, turns) = (model.floats("SCALAR", &[0., 1.]), model.floats("VEC4", &[0., 0., 0., 1., 0., 1., 0., 0.]));
    model.channel(2, "rotation", "LINEAR", times, turns);
    model.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    model.json["extensionsRequired"] = model.json["extensionsUsed"].clone();
    model
}

/// A triangle whose texture is only in EXT_texture_webp.
pub fn textured(picture: &[u8]) -> Model {
    let mut model = Model::triangle();
    let coordinates = model.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.25, 0.75]);
    model.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = coordinates.into();
    model.json["meshes"][0]["primitives"][0]["material"] = 0.into();
    let base = json!({ "diffuseTexture": { "index": 0 }, "diffuseFactor": [1, 1, 1, 0.5] });
    model.json["materials"] =
        json!([{ "alphaMode": "MASK", "extensions": { "KHR_materials_pbrSpecularGlossiness": base } }]);
    model.json["textures"] = json!([{ "extensions": { "EXT_texture_webp": { "source": 0 } } }]);
    let view = model.view(picture);
    model.json["images"] = json!([{ "bufferView": view, "mimeType": "image/webp" }]);
    model.json["extensionsUsed"] = json!(["EXT_texture_webp", "KHR_materials_pbrSpecularGlossiness"]);
    model.json["extensionsRequired"] = model.json["extensionsUsed"].clone();
    model
}

/// Positions as normalised 16-bit integers 8 bytes apart, some of them sparse.
pub fn quantized() -> Model {
    let mut model = Model::new();
    let (corners, triangles) = grid();
    let step = |number: f32| ((number * 65_535.0) as u16).to_le_bytes();
    let bytes: Vec<u8> = corners.iter().flat_map(|[x, y, z]| [step(*x), step(*y), step(*z), [0, 0]].concat()).collect();
    let positions = model.accessor(&bytes, U16, "VEC3", corners.len());
    model.json["accessors"][positions]["normalized"] = true.into();
    model.json["bufferViews"][0]["byteStride"] = 8.into();
    let (at, value) = (model.view(&[3, 7]), model.view(&[255; 12]));
    let indices = json!({ "bufferView": at, "componentType": U8 });
    model.json["accessors"][positions]["sparse"] =
        json!({ "count": 2, "indices": indices, "values": { "bufferView": value } });
    let list: Vec<u8> = triangles.iter().map(|corner| *corner as u8).collect();
    let list = model.accessor(&list, U8, "SCALAR", triangles.len());
    model.mesh(json!({ "attributes": { "POSITION": positions }, "indices": list }));
    model.node(json!({ "mesh": 0 }), true);
    model.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    model
}

/// A mesh of zeros whose whole shape is in two animated targets, one of them sparse.
pub fn morph() -> Model {
    let mut model = Model::new();
    let base = model.bare_accessor(json!({ "componentType": FLOAT, "type": "VEC3", "count": 3 }));
    let shape = model.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    let (at, value) = (model.view(&[2]), model.view(&[0, 0, 128, 63, 0, 0, 0, 0, 0, 0, 0, 64]));
    let sparse = model.bare_accessor(json!({ "componentType": FLOAT, "type": "VEC3", "count": 3,
        "sparse": { "count": 1, "indices": { "bufferView": at, "componentType": U8 }, "values": { "bufferView": value } } }));
    let targets = json!([{ "POSITION": shape, "NORMAL": sparse }, { "POSITION": sparse }]);
    model.mesh(json!({ "attributes": { "POSITION": base }, "targets": targets }));
    model.json["meshes"][0]["weights"] = json!([1, 0.25]);
    model.node(json!({ "mesh": 0 }), true);
    let (times, weights) = (model.floats("SCALAR", &[0., 1.]), model.floats("SCALAR", &[1., 0., 0.5, 1.]));
    model.channel(0, "weights", "LINEAR", times, weights);
    model
}

/// A .gltf with embedded data, integers written as decimals, and a hidden node.
pub fn text() -> String {
    let mut model = Model::triangle();
    model.node(json!({ "mesh": 0, "extensions": { "KHR_node_visibility": { "visible": false } } }), true);
    let data = STANDARD.encode(&model.binary).replace('=', "%3D");
    model.json["buffers"][0]["uri"] = format!("data:application/gltf-buffer;base64,{data}").into();
    model.json.to_string().replace("\"count\":3", "\"count\":3.0").replace("\"mesh\":0", "\"mesh\":0e0")
}

/// A file with most features of uncompressed files that the import reads.
pub fn rich() -> Model {
    let mut model = Model::triangle();
    let indices = model.accessor(&[0, 0, 1, 0, 2, 0], U16, "SCALAR", 3);
    let deltas = model.floats("VEC3", &[0.5; 9]);
    let (at, value) = (model.view(&[1]), model.view(&[0; 12]));
    let model_coordinates = model.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.25, 0.75]);
    let model_colours = model.floats("VEC4", &[0.5; 12]);
    model.json["accessors"][deltas]["sparse"] = json!({ "count": 1, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": value } });
    let primitive = &mut model.json["meshes"][0]["primitives"][0];
    primitive["indices"] = indices.into();
    primitive["attributes"]["NORMAL"] = deltas.into();
    primitive["targets"] = json!([{ "POSITION": deltas }]);
    primitive["mode"] = 5.into();
    primitive["material"] = 0.into();
    primitive["attributes"]["TEXCOORD_0"] = model_coordinates.into();
    primitive["attributes"]["COLOR_0"] = model_colours.into();
    let mut glass = primitive.clone();
    glass["material"] = 1.into();
    model.json["meshes"][0]["primitives"].as_array_mut().expect("a list").push(glass);
    model.json["meshes"][0]["weights"] = json!([0.5]);
    let transform = json!({ "offset": [0.5, 0.25], "rotation": 0.5, "scale": [2, 4] });
    let texture = json!({ "index": 0, "texCoord": 0, "extensions": { "KHR_texture_transform": transform } });
    model.json["materials"] = json!([
        { "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1], "baseColorTexture": texture } },
        { "alphaMode": "BLEND", "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0.5], "baseColorTexture": texture } },
    ]);
    model.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    model.json["samplers"] = json!([{ "wrapS": 33_071, "wrapT": 33_648 }]);
    let picture = model.view(&png());
    model.json["images"] = json!([{ "bufferView": picture, "mimeType": "image/png" }]);
    model.json["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1 } }]);
    let places = model.floats("VEC3", &[1., 2., 3., 4., 5., 6.]);
    let instancing = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    model.json["nodes"] = json!([
        { "children": [1, 2], "rotation": [0, 0, 0, 1] },
        { "mesh": 0, "extensions": instancing },
        { "camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] },
        { "mesh": 0, "skin": 0 },
    ]);
    model.json["scenes"][0]["nodes"] = json!([0, 3]);
    let identity = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    let inverse_binds = model.floats("MAT4", &[identity, identity].concat());
    model.json["skins"] = json!([{ "joints": [2, 0], "inverseBindMatrices": inverse_binds }]);
    let joints = model.accessor(&[0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0], U8, "VEC4", 3);
    let weights = model.floats("VEC4", &[0.5, 0.5, 0., 0., 1., 0., 0., 0., 1., 0., 0., 0.]);
    for primitive in model.json["meshes"][0]["primitives"].as_array_mut().expect("a list") {
        primitive["attributes"]["JOINTS_0"] = joints.into();
        primitive["attributes"]["WEIGHTS_0"] = weights.into();
    }
    let (input, output) = (model.floats("SCALAR", &[0., 1.]), model.floats("VEC4", &[0., 0., 0., 1., 0., 1., 0., 0.]));
    model.channel(0, "rotation", "LINEAR", input, output);
    let weights = model.floats("SCALAR", &[0., 1., 0.5, 0.25, -0.5, 2.]);
    model.channel(1, "weights", "CUBICSPLINE", input, weights);
    model
}
