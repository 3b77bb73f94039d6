//! The JSON of a glTF 2.0 file, as far as Sightline reads it.
//!
//! Not the `gltf` crate's types: those keep transforms in `f32`, refuse scenes without `nodes`, and cut 64-bit numbers to 32 bits.
//! Tests hold this reader to what that crate reads.

use super::fault::{broken, Fault, Outcome};
use serde::de::IgnoredAny;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Extensions change nothing of what Sightline draws, but they must at least be objects.
type Extensions = BTreeMap<String, BTreeMap<String, IgnoredAny>>;

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Document {
    pub accessors: Vec<Accessor>,
    pub animations: Vec<Animation>,
    pub buffers: Vec<Buffer>,
    pub buffer_views: Vec<BufferView>,
    pub cameras: Vec<Camera>,
    pub materials: Vec<Material>,
    pub meshes: Vec<Mesh>,
    pub nodes: Vec<Node>,
    pub scene: Option<usize>,
    pub scenes: Vec<Scene>,
    pub skins: Vec<Skin>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: u64,
    #[serde(rename = "type")]
    pub kind: String,
    pub sparse: Option<Sparse>,
    #[serde(default)]
    pub min: Value,
    #[serde(default)]
    pub max: Value,
}

#[derive(Debug, Deserialize)]
pub(super) struct Sparse {
    pub count: u64,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: u32,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: u64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Animation {
    pub name: Option<String>,
    #[serde(default)]
    pub channels: Vec<Channel>,
    #[serde(default)]
    pub samplers: Vec<Sampler>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Channel {
    pub sampler: usize,
    pub target: Target,
}

#[derive(Debug, Deserialize)]
pub(super) struct Target {
    pub node: Option<usize>,
    pub path: String,
}

#[derive(Debug, Deserialize)]
pub(super) struct Sampler {
    pub input: usize,
    pub output: usize,
    pub interpolation: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub uri: Option<String>,
    pub byte_length: u64,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: Option<u64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Camera {
    pub name: Option<String>,
    #[serde(rename = "type")]
    pub kind: String,
    pub perspective: Option<Perspective>,
    pub orthographic: Option<Orthographic>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Perspective {
    pub yfov: f64,
    pub znear: f64,
    pub zfar: Option<f64>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Orthographic {
    pub ymag: f64,
    pub znear: f64,
    pub zfar: f64,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub name: Option<String>,
    #[serde(default)]
    pub pbr_metallic_roughness: PbrMetallicRoughness,
    pub alpha_mode: Option<String>,
    // Textures are not loaded yet; that they are well-formed is checked all the same.
    #[serde(rename = "normalTexture")]
    _normal_texture: Option<TextureReference>,
    #[serde(rename = "occlusionTexture")]
    _occlusion_texture: Option<TextureReference>,
    #[serde(rename = "emissiveTexture")]
    _emissive_texture: Option<TextureReference>,
    #[serde(rename = "extensions")]
    _extensions: Option<Extensions>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct PbrMetallicRoughness {
    pub base_color_factor: Option<[f32; 4]>,
    #[serde(rename = "baseColorTexture")]
    _base_color_texture: Option<TextureReference>,
    #[serde(rename = "metallicRoughnessTexture")]
    _metallic_roughness_texture: Option<TextureReference>,
}

#[derive(Debug, Deserialize)]
struct TextureReference {
    #[serde(rename = "index")]
    _index: usize,
    #[serde(rename = "scale")]
    _scale: Option<f64>,
    #[serde(rename = "strength")]
    _strength: Option<f64>,
    #[serde(rename = "extensions")]
    _extensions: Option<Extensions>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
    pub weights: Option<Vec<f32>>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Primitive {
    pub attributes: BTreeMap<String, usize>,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub mode: Option<u32>,
    #[serde(default)]
    pub targets: Vec<BTreeMap<String, usize>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub name: Option<String>,
    pub children: Vec<usize>,
    pub camera: Option<usize>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub weights: Option<Vec<f32>>,
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    pub extensions: NodeExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Instancing>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Instancing {
    pub attributes: BTreeMap<String, usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Scene {
    #[serde(rename = "name")]
    _name: Option<String>,
    #[serde(default)]
    pub nodes: Vec<usize>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Skin {
    pub name: Option<String>,
    pub joints: Vec<usize>,
}

/// What must be known before the rest can be understood: another version has another schema.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Head {
    asset: Option<Asset>,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: Option<String>,
    min_version: Option<String>,
}

/// Reads the JSON, after its version and required extensions have been found to be ones that Sightline knows.
pub(super) fn parse(json: &[u8]) -> Outcome<Document> {
    let head: Head = from_json(json)?;
    let Some(asset) = head.asset else {
        return broken("it has no 'asset', so it is not glTF 2.0");
    };
    check_version(asset.min_version.as_deref().or(asset.version.as_deref()))?;
    for extension in &head.extensions_required {
        check_extension(extension)?;
    }
    from_json(json)
}

fn from_json<'a, T: Deserialize<'a>>(json: &'a [u8]) -> Outcome<T> {
    serde_json::from_slice(json).map_err(|error| {
        // The types are Rust's: in words for everyone else.
        let error = error
            .to_string()
            .replace("expected usize", "expected an index")
            .replace("expected u64", "expected a count");
        let error =
            error.replace("expected u32", "expected a number from a list").replace("expected f64", "expected a number");
        Fault::Broken(format!("the JSON is not a glTF 2.0 document: {error}"))
    })
}

fn check_version(version: Option<&str>) -> Outcome<()> {
    let Some(version) = version else {
        return broken("its 'asset' has no 'version'");
    };
    match version.split('.').next() {
        Some("2") if version == "2" || version == "2.0" => Ok(()),
        Some("0" | "1") => Err(gltf_1(version)),
        _ => Err(Fault::Unsupported {
            what: format!("glTF version '{version}'"),
            remedy: "export the scene as glTF 2.0".into(),
        }),
    }
}

/// The fault of all files of glTF 1.
pub(super) fn gltf_1(version: &str) -> Fault {
    Fault::Unsupported {
        what: format!("glTF version {version}"),
        remedy: "convert it to glTF 2.0, for instance by importing and exporting it in Blender".into(),
    }
}

/// Sightline must do, or be right to ignore, every extension that a file requires.
fn check_extension(extension: &str) -> Outcome<()> {
    let remedy = match extension {
        "KHR_mesh_quantization" | "EXT_mesh_gpu_instancing" => return Ok(()),
        // Change only how surfaces look, or where their textures come from, which are not drawn.
        "KHR_texture_transform"
        | "KHR_texture_basisu"
        | "EXT_texture_webp"
        | "EXT_texture_avif"
        | "MSFT_texture_dds"
        | "KHR_lights_punctual"
        | "KHR_xmp_json_ld" => return Ok(()),
        _ if extension.starts_with("KHR_materials_") => return Ok(()),
        "KHR_draco_mesh_compression" => {
            "decompress it: npx @gltf-transform/cli copy IN.glb OUT.glb, or export without Draco"
        }
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            "export the scene without mesh compression, or run gltfpack without -c"
        }
        "KHR_technique_webgl" => "it describes shaders of WebGL 1: export the scene again with PBR materials",
        _ => "export the scene without it",
    };
    Err(Fault::Unsupported { what: format!("the required extension {extension}"), remedy: remedy.into() })
}
