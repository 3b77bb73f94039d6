//! The JSON of a glTF 2.0 file: the `gltf` crate's model of it, and beside it what that model loses.
//!
//! The crate keeps transforms and lenses in `f32` where the format has numbers of any precision; those are read once more, in `f64`.
//! It requires lists that may be left out, which are filled in, and cuts indices to 32 bits, so larger ones are refused first. Its validation is not used: it refuses files for what does no harm,
//! such as attributes of unknown names and positions without bounds, lets vertex indices and node cycles pass, and panics at a
//! POSITION that refers to no accessor. Every reference is checked where it is followed instead.

use super::extensions;
use super::fault::{broken, one_line, Fault, Outcome};
use gltf::json::Root;
use serde::Deserialize;
use serde_json::{json, Value};

/// The node of an animation channel whose target is an extension's.
pub(super) const NO_NODE: u32 = u32::MAX;

/// A glTF document.
pub(super) struct Document<'a> {
    pub root: Root,
    /// Where each of the root's nodes is, in full precision.
    pub places: Vec<Place>,
    /// What each of the root's cameras sees, in full precision.
    pub lenses: Vec<Lens>,
    json: &'a [u8],
}

/// The numbers that the crate would cut to `f32`.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Doubles {
    nodes: Vec<Place>,
    cameras: Vec<Lens>,
}

#[derive(Deserialize)]
pub(super) struct Place {
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
pub(super) struct Lens {
    pub perspective: Option<Perspective>,
    pub orthographic: Option<Orthographic>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Perspective {
    pub aspect_ratio: Option<f64>,
    pub yfov: f64,
    pub znear: f64,
    pub zfar: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct Orthographic {
    pub xmag: Option<f64>,
    pub ymag: f64,
    pub znear: f64,
    pub zfar: f64,
}

/// What must be known before the rest can be understood: another version has another schema.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Head {
    asset: Option<Asset>,
    #[serde(default)]
    extensions_used: Vec<String>,
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
pub(super) fn parse(json: &[u8]) -> Outcome<Document<'_>> {
    let head: Head = from_json(json)?;
    let Some(asset) = head.asset else {
        return broken("it has no 'asset', so it is not glTF 2.0");
    };
    check_version(&asset)?;
    extensions::check(&head.extensions_used, &head.extensions_required)?;
    check_whole_numbers(json)?;
    let read = match Root::from_slice(json) {
        Ok(root) => (root, from_json(json)?),
        // What is missing may have been filled in; any other error knows its line, which the second reading does not.
        Err(error) => mended(json).map_err(|still| {
            let missing = error.to_string().starts_with("missing field");
            refusal(if missing { &still } else { &error })
        })?,
    };
    let (root, Doubles { nodes: places, cameras: lenses }) = read;
    Ok(Document { root, places, lenses, json })
}

impl Document<'_> {
    /// What the file says at a JSON pointer, for faults: of values that it does not know the crate only says so.
    pub(super) fn said(&self, pointer: &str) -> String {
        let document: Option<Value> = serde_json::from_slice(self.json).ok();
        match document.as_ref().and_then(|document| document.pointer(pointer)) {
            Some(Value::String(text)) => text.clone(),
            Some(value) => value.to_string(),
            None => String::new(),
        }
    }
}

/// Refuses indices and codes beyond 32 bits, which the crate would cut to others without a word.
fn check_whole_numbers(json: &[u8]) -> Outcome<()> {
    let numbers = json.split(|byte| !(byte.is_ascii_digit() || b"+-.eE".contains(byte)));
    // Most documents have none so long, and need no second look.
    if numbers.filter(|number| number.len() > 9).all(|number| number.iter().any(|byte| !byte.is_ascii_digit())) {
        return Ok(());
    }
    match beyond_32_bits("", &from_json(json)?) {
        Some((key, number)) => broken(format!("it has a '{key}' of {number}, beyond 32 bits")),
        None => Ok(()),
    }
}

fn beyond_32_bits<'a>(key: &'a str, value: &'a Value) -> Option<(&'a str, u64)> {
    /// Lengths, offsets and counts have 64 bits, and other numbers are not whole.
    const CUT: [&str; 20] = [
        "POSITION",
        "NORMAL",
        "buffer",
        "bufferView",
        "camera",
        "children",
        "componentType",
        "indices",
        "input",
        "joints",
        "material",
        "mesh",
        "mode",
        "node",
        "nodes",
        "output",
        "sampler",
        "scene",
        "skin",
        "source",
    ];
    match value {
        Value::Number(number) if CUT.contains(&key) => {
            number.as_u64().filter(|&it| it > u32::MAX.into()).map(|it| (key, it))
        }
        Value::Array(list) => list.iter().find_map(|value| beyond_32_bits(key, value)),
        // Extras are the application's own, and extensions are not read by the crate's model.
        Value::Object(object) => {
            let mut read = object.iter().filter(|(key, _)| !matches!(key.as_str(), "extras" | "extensions"));
            read.find_map(|(key, value)| beyond_32_bits(key, value))
        }
        _ => None,
    }
}

/// The document with what the crate requires and the format does not.
fn mended(json: &[u8]) -> Result<(Root, Doubles), serde_json::Error> {
    let mut document: Value = serde_json::from_slice(json)?;
    strip_nulls(&mut document);
    each(&mut document, "scenes").for_each(|scene| complete(scene, "nodes", json!([])));
    for animation in each(&mut document, "animations") {
        complete(animation, "samplers", json!([]));
        complete(animation, "channels", json!([]));
        let targets = each(animation, "channels").filter_map(|channel| channel.get_mut("target"));
        targets.for_each(|target| complete(target, "node", NO_NODE.into()));
    }
    // Before the crate's model gets an xmag that the file does not have.
    let doubles = serde_json::from_value(document.clone())?;
    let lenses = each(&mut document, "cameras").filter_map(|camera| camera.get_mut("orthographic"));
    lenses.for_each(|lens| complete(lens, "xmag", json!(1)));
    Ok((serde_json::from_value(document)?, doubles))
}

/// The elements of a list, if there is one.
fn each<'a>(parent: &'a mut Value, list: &str) -> impl Iterator<Item = &'a mut Value> {
    parent.get_mut(list).and_then(Value::as_array_mut).into_iter().flatten()
}

fn complete(object: &mut Value, key: &str, value: Value) {
    if let Some(object) = object.as_object_mut() {
        object.entry(key).or_insert(value);
    }
}

/// Some exporters write null for what they should leave out. JSON is never nested deeper than its reader's limit.
fn strip_nulls(value: &mut Value) {
    match value {
        Value::Object(object) => {
            object.retain(|_, value| !value.is_null());
            object.values_mut().for_each(strip_nulls);
        }
        Value::Array(list) => list.iter_mut().for_each(strip_nulls),
        _ => {}
    }
}

fn from_json<'a, T: Deserialize<'a>>(json: &'a [u8]) -> Outcome<T> {
    serde_json::from_slice(json).map_err(|error| refusal(&error))
}

/// What was expected, in words: the types in the message are Rust's.
fn refusal(error: &serde_json::Error) -> Fault {
    const WORDS: [(&str, &str); 6] = [
        ("expected index into child of root", "expected an index"),
        ("expected usize", "expected an index"),
        ("expected u64", "expected a count"),
        ("expected u32", "expected a number from a list"),
        ("expected f32", "expected a number"),
        ("expected f64", "expected a number"),
    ];
    let mut text = WORDS.iter().fold(error.to_string(), |text, (rust, words)| text.replace(rust, words));
    if let Some((before, (_, after))) =
        text.split_once("expected struct ").and_then(|(before, name)| Some((before, name.split_once(' ')?)))
    {
        text = format!("{before}expected an object {after}");
    }
    Fault::Broken(format!("the JSON is not a glTF 2.0 document: {text}"))
}

/// Checks the version. Readers of 2.0 read every 2.x and ignore its new features, unless `minVersion` is higher (glTF 2.0, section
/// 3.2).
fn check_version(asset: &Asset) -> Outcome<()> {
    let Some(version) = asset.version.as_deref() else {
        return broken("its 'asset' has no 'version'");
    };
    let unsupported = |what: String| Fault::Unsupported { what, remedy: "export the scene as glTF 2.0".into() };
    match parts(version) {
        Some((2, _)) => {}
        Some((0 | 1, _)) => return Err(gltf_1(&one_line(version, 20))),
        _ => return Err(unsupported(format!("glTF version '{}'", one_line(version, 20)))),
    }
    match asset.min_version.as_deref() {
        Some(least) if parts(least).is_none_or(|least| least > (2, 0)) => {
            Err(unsupported(format!("its 'minVersion', glTF '{}',", one_line(least, 20))))
        }
        _ => Ok(()),
    }
}

/// Splits a version into major and minor. A missing minor version is 0, and one that is too large for its type is the largest.
fn parts(version: &str) -> Option<(u32, u32)> {
    let (major, minor) = version.split_once('.').unwrap_or((version, "0"));
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let number = |text: &str| is_number(text).then(|| text.parse().unwrap_or(u32::MAX));
    Some((number(major)?, number(minor.split('.').next().unwrap_or(minor))?))
}

/// The fault of all files of glTF 1.
pub(super) fn gltf_1(version: &str) -> Fault {
    Fault::Unsupported {
        what: format!("glTF version {version}"),
        remedy: "convert it to glTF 2.0, for instance by importing and exporting it in Blender".into(),
    }
}
