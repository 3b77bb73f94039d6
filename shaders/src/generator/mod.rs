//! The generator behind `cargo shaders`: compiles every shader, reflects it, and writes `shaders/generated/`.
//!
//! `compile` makes SPIR-V, `reflect` reads what it declares, `stages` joins the shaders of a stage, `emit` and
//! `structs` write Rust, in `words` that they share. Everything is made in memory first: an error leaves `generated/` as it was.

pub mod compile;
pub mod docs;
pub mod emit;
pub mod layout;
pub mod reflect;
pub mod spirv;
pub mod stages;
pub mod structs;
#[cfg(test)]
mod tests;
pub mod words;

use crate::sources::{self, Source, HASHES_FILE};
use compile::ShaderCompiler;
use docs::Docs;
use stages::{Shader, StageModel};
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use structs::SharedStructs;

/// What `generated/` should hold.
#[derive(Clone, Debug)]
pub struct Output {
    /// Content of each file, by path inside `generated/`.
    pub files: BTreeMap<String, Vec<u8>>,
    /// Names of the stages.
    pub stages: Vec<String>,
    /// What the reader may want to know, though it is no error.
    pub notes: Vec<String>,
}

/// Makes everything in memory. The errors are all that were found, each with its file.
pub fn generate(root: &Path) -> Result<Output, Vec<String>> {
    let one = |error: String| vec![error];
    let listed = sources::list(root).map_err(|error| one(error.to_string()))?;
    let includes = read_includes(root).map_err(one)?;
    let mut include_docs = Docs::default();
    for text in includes.values() {
        include_docs.add(&Docs::read(text));
    }
    let mut files = BTreeMap::new();
    let shaders = compile_all(root, &listed, &include_docs, &mut files)?;
    let stages = join_stages(&shaders)?;
    let (rust, notes) = write_rust(&shaders, &stages, &includes, include_docs).map_err(one)?;
    for (name, text) in rust {
        let formatted = rustfmt(root, &text).map_err(|error| one(format!("generated/{name}: {error}")))?;
        files.insert(name, formatted.into_bytes());
    }
    let mut hashes = sources::source_hashes(root).map_err(|error| one(error.to_string()))?;
    hashes.extend(files.iter().map(|(name, bytes)| (format!("generated/{name}"), sources::hash(bytes))));
    files.insert(HASHES_FILE.to_owned(), sources::format_hashes(&hashes).into_bytes());
    let stages = stages.into_iter().map(|stage| stage.name).collect();
    Ok(Output { files, stages, notes })
}

fn read_includes(root: &Path) -> Result<BTreeMap<String, String>, String> {
    let names = sources::list_includes(root).map_err(|error| error.to_string())?;
    let read = |name: String| {
        let text = sources::read_text(&sources::include_folder(root).join(&name)).map_err(|error| error.to_string())?;
        Ok((name, text))
    };
    names.into_iter().map(read).collect()
}

fn compile_all(
    root: &Path,
    listed: &[Source],
    include_docs: &Docs,
    files: &mut BTreeMap<String, Vec<u8>>,
) -> Result<Vec<Shader>, Vec<String>> {
    let compiler = ShaderCompiler::new(root).map_err(|error| vec![error])?;
    let (mut shaders, mut errors) = (Vec::new(), Vec::new());
    for source in listed {
        match compile_one(root, &compiler, source, include_docs) {
            Ok((shader, spirv)) => {
                files.insert(format!("spirv/{}.spv", source.file()), spirv);
                shaders.push(shader);
            }
            Err(error) => errors.push(error),
        }
    }
    match errors.is_empty() {
        true => Ok(shaders),
        false => Err(errors),
    }
}

fn compile_one(
    root: &Path,
    compiler: &ShaderCompiler,
    source: &Source,
    include_docs: &Docs,
) -> Result<(Shader, Vec<u8>), String> {
    let file = source.file();
    let in_file = |error: String| format!("shaders/glsl/{file}: {error}");
    let text = sources::read_text(&root.join("glsl").join(&file)).map_err(|error| error.to_string())?;
    let compiled = compiler.compile(source, &text)?;
    let reflection = reflect::reflect(&compiled.declared, source.kind).map_err(in_file)?;
    let shader = Shader::new(source.clone(), &text, include_docs, reflection).map_err(in_file)?;
    let spirv = compiled.shipped.iter().flat_map(|word| word.to_le_bytes()).collect();
    Ok((shader, spirv))
}

/// Stages by name, from shaders sorted by path.
fn join_stages(shaders: &[Shader]) -> Result<Vec<StageModel>, Vec<String>> {
    let (mut stages, mut errors) = (Vec::new(), Vec::new());
    for group in shaders.chunk_by(|a, b| a.source.stage() == b.source.stage()) {
        match stages::merge(group) {
            Ok(stage) if emit::hides_contract(&stage) => {
                errors.push(format!("shaders/glsl/{}: the name is taken by the contract: rename it", stage.name));
            }
            Ok(stage) => stages.push(stage),
            Err(error) => errors.push(format!("shaders/glsl/{}: {error}", group[0].source.stage())),
        }
    }
    match errors.is_empty() {
        true => Ok(stages),
        false => Err(errors),
    }
}

type RustFiles = BTreeMap<String, String>;

fn write_rust(
    shaders: &[Shader],
    stages: &[StageModel],
    includes: &BTreeMap<String, String>,
    mut docs: Docs,
) -> Result<(RustFiles, Vec<String>), String> {
    let mut structs = SharedStructs::default();
    for shader in shaders {
        let file = format!("shaders/glsl/{}", shader.source.file());
        structs.add(&file, &shader.reflection.structs).map_err(|error| format!("{file}: {error}"))?;
        docs.add(&shader.docs);
    }
    let (types, notes) = structs::emit_types(&structs, &docs, includes)?;
    let mut rust = RustFiles::from([("types.rs".to_owned(), types)]);
    let mut families = Vec::new();
    for group in stages.chunk_by(|a, b| a.family == b.family) {
        let family = group[0].family.as_str();
        if ["contract", "generated", "generator", "mod", "sources", "types"].contains(&family) {
            return Err(format!("shaders/glsl/{family}: the name is taken in Rust: rename the folder"));
        }
        stages::check_field_name(family)?;
        families.push(family);
        rust.insert(format!("{family}.rs"), emit::emit_family(family, &group.iter().collect::<Vec<_>>()));
    }
    rust.insert("mod.rs".to_owned(), emit::emit_root(&families, stages));
    Ok((rust, notes))
}

/// Formats Rust text as the workspace above `root` does.
fn rustfmt(root: &Path, text: &str) -> Result<String, String> {
    let mut child = Command::new("rustfmt")
        .args(["--edition", "2021", "--emit", "stdout", "--quiet"])
        .current_dir(root)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("rustfmt does not start ({error}): install it with `rustup component add rustfmt`"))?;
    let mut stdin = child.stdin.take().ok_or("rustfmt has no input")?;
    let owned = text.to_owned();
    let writer = std::thread::spawn(move || stdin.write_all(owned.as_bytes()));
    let done = child.wait_with_output().map_err(|error| format!("rustfmt: {error}"))?;
    let written = writer.join().map_err(|_| "rustfmt: the writing thread stopped")?;
    if !done.status.success() || written.is_err() {
        return Err(format!("rustfmt refused it: {}", String::from_utf8_lossy(&done.stderr)));
    }
    String::from_utf8(done.stdout).map_err(|error| format!("rustfmt: {error}"))
}

/// How `generated/` differs from `output`, a line a file; nothing if it is the same.
pub fn differences(root: &Path, output: &Output) -> Result<Vec<String>, String> {
    let present = sources::read_generated(root).map_err(|error| error.to_string())?;
    let mut lines = Vec::new();
    for (name, bytes) in &output.files {
        match present.get(name) {
            None => lines.push(format!("missing: shaders/generated/{name}")),
            Some(old) if old != bytes => lines.push(format!("differs: shaders/generated/{name}")),
            Some(_) => {}
        }
    }
    let stale = present.keys().filter(|name| !output.files.contains_key(*name));
    lines.extend(stale.map(|name| format!("stale: shaders/generated/{name}")));
    Ok(lines)
}

/// Brings `generated/` to `output`. What is the same is not touched, so that cargo does not build it again.
pub fn write(root: &Path, output: &Output) -> Result<usize, String> {
    let folder = root.join("generated");
    let present = sources::read_generated(root).map_err(|error| error.to_string())?;
    let named = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    let mut changed = 0;
    for name in present.keys().filter(|name| !output.files.contains_key(*name)) {
        let path = folder.join(name);
        fs::remove_file(&path).map_err(|error| named(&path, error))?;
        // Folders go when they are empty: removal fails, and ends the walk, at the first that is not.
        let mut parents = path.ancestors().skip(1);
        while parents.next().is_some_and(|parent| fs::remove_dir(parent).is_ok()) {}
        changed += 1;
    }
    for (name, bytes) in &output.files {
        if present.get(name) == Some(bytes) {
            continue;
        }
        let path = folder.join(name);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(|error| named(parent, error))?;
        }
        fs::write(&path, bytes).map_err(|error| named(&path, error))?;
        changed += 1;
    }
    Ok(changed)
}
