//! Which shaders there are, what each is made of, and the hashes that hold `generated/` to its sources.
//!
//! Needs no shader compiler, so that `tests/freshness.rs` can run everywhere.

use crate::contract::ShaderKind;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The folder of texts that shaders include; every other folder in `glsl/` is a family of stages.
pub const INCLUDE_FOLDER: &str = "include";

/// One shader file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// The folder it is in: a method family.
    pub family: String,
    /// The file's name without extension: what the stage does.
    pub stem: String,
    /// Which pipeline stage it is for, from its extension.
    pub kind: ShaderKind,
}

impl Source {
    /// The name of its stage, `family/verb_noun`.
    pub fn stage(&self) -> String {
        format!("{}/{}", self.family, self.stem)
    }

    /// The file's path inside `glsl/`, with forward slashes.
    pub fn file(&self) -> String {
        format!("{}.{}", self.stage(), extension(self.kind))
    }
}

/// The crate's own folder, as it was when this was built.
pub fn crate_root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The folder of the texts that `#include` finds.
pub fn include_folder(root: &Path) -> PathBuf {
    root.join("glsl").join(INCLUDE_FOLDER)
}

fn extension(kind: ShaderKind) -> &'static str {
    match kind {
        ShaderKind::Vertex => "vert",
        ShaderKind::Fragment => "frag",
        ShaderKind::Compute => "comp",
    }
}

fn kind_of(extension: &str) -> Option<ShaderKind> {
    match extension {
        "vert" => Some(ShaderKind::Vertex),
        "frag" => Some(ShaderKind::Fragment),
        "comp" => Some(ShaderKind::Compute),
        _ => None,
    }
}

/// Every shader under `root/glsl`, by path. A file that is no shader is an error: nothing lies there unused.
pub fn list(root: &Path) -> io::Result<Vec<Source>> {
    let mut sources = Vec::new();
    for folder in sorted_entries(&root.join("glsl"))? {
        let family = name_of(&folder);
        if family == INCLUDE_FOLDER {
            continue;
        }
        if !folder.is_dir() {
            return Err(stray(&folder));
        }
        for file in sorted_entries(&folder)? {
            let name = name_of(&file);
            let (stem, ending) = name.split_once('.').ok_or_else(|| stray(&file))?;
            let kind = kind_of(ending).ok_or_else(|| stray(&file))?;
            sources.push(Source { family: family.clone(), stem: stem.to_owned(), kind });
        }
    }
    Ok(sources)
}

/// The names of the texts in the include folder, sorted.
pub fn list_includes(root: &Path) -> io::Result<Vec<String>> {
    let files = sorted_entries(&include_folder(root))?;
    Ok(files.iter().map(|file| name_of(file)).collect())
}

/// The names a text includes, transitively, in the order in which they are first met.
pub fn included_by(root: &Path, text: &str) -> io::Result<Vec<String>> {
    let mut found = Vec::new();
    add_includes(root, text, &mut found)?;
    Ok(found)
}

fn add_includes(root: &Path, text: &str, found: &mut Vec<String>) -> io::Result<()> {
    for name in text.lines().filter_map(include_directive) {
        if found.iter().any(|known| known == name) {
            continue;
        }
        found.push(name.to_owned());
        let path = include_folder(root).join(name);
        add_includes(root, &read_text(&path)?, found)?;
    }
    Ok(())
}

/// The name in `#include "name"`, if the line is that directive.
fn include_directive(line: &str) -> Option<&str> {
    let rest = line.trim_start().strip_prefix('#')?.trim_start();
    let quoted = rest.strip_prefix("include")?.trim_start();
    quoted.strip_prefix('"')?.split('"').next()
}

/// Reads a text; the error names the file.
pub fn read_text(path: &Path) -> io::Result<String> {
    fs::read_to_string(path).map_err(|error| named(path, error))
}

/// The hash of each shader with all that shapes its output, by path inside the crate: the shader, what it includes,
/// and the generator.
pub fn source_hashes(root: &Path) -> io::Result<BTreeMap<String, String>> {
    let generator = generator_text(root)?;
    let mut hashes = BTreeMap::new();
    for source in list(root)? {
        let text = read_text(&root.join("glsl").join(source.file()))?;
        let mut hasher = Sha256::new();
        hasher.update(text.as_bytes());
        let mut includes = included_by(root, &text)?;
        includes.sort();
        for name in includes {
            hasher.update(name.as_bytes());
            hasher.update(read_text(&include_folder(root).join(name))?.as_bytes());
        }
        hasher.update(&generator);
        hashes.insert(format!("glsl/{}", source.file()), hex(&hasher.finalize()));
    }
    for name in list_includes(root)? {
        let text = read_text(&include_folder(root).join(&name))?;
        hashes.insert(format!("glsl/include/{name}"), hash(text.as_bytes()));
    }
    Ok(hashes)
}

/// The hash of each generated file, by path inside the crate. `HASHES` itself is left out.
pub fn output_hashes(root: &Path) -> io::Result<BTreeMap<String, String>> {
    let mut hashes = BTreeMap::new();
    for (name, bytes) in read_generated(root)? {
        if name != HASHES_FILE {
            hashes.insert(format!("generated/{name}"), hash(&bytes));
        }
    }
    Ok(hashes)
}

/// The file in `generated/` that lists the hashes.
pub const HASHES_FILE: &str = "HASHES";

/// Every file in `generated/` with its content, by path inside it; nothing if the folder is not there.
pub fn read_generated(root: &Path) -> io::Result<BTreeMap<String, Vec<u8>>> {
    let mut files = BTreeMap::new();
    let folder = root.join("generated");
    if folder.exists() {
        add_files(&folder, "", &mut files)?;
    }
    Ok(files)
}

fn add_files(folder: &Path, prefix: &str, files: &mut BTreeMap<String, Vec<u8>>) -> io::Result<()> {
    for path in sorted_entries(folder)? {
        let name = format!("{prefix}{}", name_of(&path));
        if path.is_dir() {
            add_files(&path, &format!("{name}/"), files)?;
        } else {
            let bytes = fs::read(&path).map_err(|error| named(&path, error))?;
            files.insert(name, bytes);
        }
    }
    Ok(())
}

/// Reads `HASHES`: one line a file, hash then path.
pub fn parse_hashes(text: &str) -> BTreeMap<String, String> {
    let pairs = text.lines().filter_map(|line| line.split_once("  "));
    pairs.map(|(hash, path)| (path.to_owned(), hash.to_owned())).collect()
}

/// Writes what [`parse_hashes`] reads.
pub fn format_hashes(hashes: &BTreeMap<String, String>) -> String {
    let line = |(path, hash)| format!("{hash}  {path}\n");
    hashes.iter().map(line).collect()
}

/// SHA-256 in hexadecimal.
pub fn hash(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The text of everything that decides how a shader becomes SPIR-V and Rust.
fn generator_text(root: &Path) -> io::Result<Vec<u8>> {
    let mut files = sorted_entries(&root.join("src/generator"))?;
    files.push(root.join("src/bin/shader-compiler.rs"));
    files.push(root.join("src/contract.rs"));
    let mut text = Vec::new();
    for file in files {
        text.extend(read_text(&file)?.into_bytes());
    }
    Ok(text)
}

fn sorted_entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).map_err(|error| named(folder, error))?;
    let mut paths = entries.map(|entry| entry.map(|entry| entry.path())).collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    Ok(paths)
}

fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn named(path: &Path, error: io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

fn stray(path: &Path) -> io::Error {
    let what = "expected glsl/FAMILY/VERB_NOUN.comp, .vert or .frag; included texts belong in glsl/include";
    io::Error::new(io::ErrorKind::InvalidData, format!("{}: {what}", path.display()))
}
