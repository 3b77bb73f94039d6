//! Compiles what changed in `glsl/` since the program was built, or since it was last asked.
//!
//! What Rust sees of a stage cannot change while a program runs: the Rust text that a changed shader would get has to be what
//! `generated/` says, as the program was built with it.

use super::NewShader;
use crate::generator::compile::ShaderCompiler;
use crate::generator::docs::Docs;
use crate::generator::stages::{merge, Shader};
use crate::generator::structs::{emit_types, SharedStructs};
use crate::generator::{emit::emit_family, reflect};
use crate::sources::{self, Source};
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// The hashes of all sources and of what was generated of them, as they were when this was built.
const BUILT: &str = include_str!("../../generated/HASHES");

const REMEDY: &str = "run `cargo shaders` and build the program again";

/// The shaders that a program runs with, by the hashes of their sources.
#[derive(Clone)]
pub struct Reloader {
    root: PathBuf,
    /// As the program was built.
    built: BTreeMap<String, String>,
    /// As the program runs now.
    running: BTreeMap<String, String>,
}

impl Reloader {
    /// The shaders in the crate's folder `root`, as this program was built with them.
    pub fn new(root: &Path) -> Self {
        let built = sources::parse_hashes(BUILT);
        Reloader { root: root.to_owned(), running: built.clone(), built }
    }

    /// Compiles the shaders whose text, or what they include, changed since the last time that this went well. Every error is
    /// one finding, with its file; what runs is then still the last good state.
    pub fn changed(&mut self) -> Result<Vec<NewShader>, Vec<String>> {
        let now = sources::source_hashes(&self.root).map_err(|error| vec![error.to_string()])?;
        let listed = sources::list(&self.root).map_err(|error| vec![error.to_string()])?;
        let is_new = |source: &Source| {
            let path = format!("glsl/{}", source.file());
            now.get(&path) != self.running.get(&path)
        };
        let (mut new, mut errors) = (Vec::new(), Vec::new());
        for stage in listed.chunk_by(|one, other| one.stage() == other.stage()) {
            if !stage.iter().any(is_new) {
                continue;
            }
            match self.compile(stage) {
                Ok(shaders) => new.extend(shaders),
                Err(error) => errors.push(error),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        self.running = now;
        Ok(new)
    }

    /// All shaders of one stage.
    fn compile(&self, stage: &[Source]) -> Result<Vec<NewShader>, String> {
        let compiler = ShaderCompiler::new(&self.root)?;
        let (mut new, mut shaders) = (Vec::new(), Vec::new());
        for source in stage {
            let file = source.file();
            let in_file = |error: String| format!("shaders/glsl/{file}: {error}");
            let text = sources::read_text(&self.root.join("glsl").join(&file)).map_err(|error| error.to_string())?;
            let compiled = compiler.compile(source, &text)?;
            let reflection = reflect::reflect(&compiled.declared, source.kind).map_err(in_file)?;
            shaders.push(Shader::new(source.clone(), &text, &Docs::default(), reflection).map_err(in_file)?);
            new.push(NewShader { stage: source.stage(), kind: source.kind, words: compiled.shipped });
        }
        self.check_contract(&shaders)?;
        Ok(new)
    }

    /// An error if Rust would see something else of a stage, or of what it shares, than the program was built with.
    fn check_contract(&self, shaders: &[Shader]) -> Result<(), String> {
        let name = shaders[0].source.stage();
        let in_stage = |error: String| format!("shaders/glsl/{name}: {error}");
        let stage = merge(shaders).map_err(in_stage)?;
        let mut structs = SharedStructs::default();
        for shader in shaders {
            structs.add(&shader.source.file(), &shader.reflection.structs).map_err(in_stage)?;
        }
        let includes = self.includes().map_err(|error| error.to_string())?;
        let (types, _) = emit_types(&structs, &Docs::default(), &includes)?;
        for (file, text) in [("types", types), (&stage.family, emit_family(&stage.family, &[&stage]))] {
            let known = code(&self.generated(file)?);
            // What is used from elsewhere says nothing of the stage, and `rustfmt` sorts it.
            let mut parts = text.split("\n\n").filter(|part| !part.starts_with("use "));
            if let Some(part) = parts.find(|part| !known.contains(&code(part))) {
                return Err(in_stage(format!("the program was built with another `{}`: {REMEDY}", first_line(part))));
            }
        }
        Ok(())
    }

    /// The texts that shaders include, by name.
    fn includes(&self) -> io::Result<BTreeMap<String, String>> {
        let folder = sources::include_folder(&self.root);
        let read = |name: String| Ok((name.clone(), sources::read_text(&folder.join(name))?));
        sources::list_includes(&self.root)?.into_iter().map(read).collect()
    }

    /// A file of `generated/`, as the program was built with it.
    fn generated(&self, name: &str) -> Result<String, String> {
        let path = format!("generated/{name}.rs");
        let text = sources::read_text(&self.root.join(&path)).map_err(|error| error.to_string())?;
        match self.built.get(&path) {
            Some(built) if *built == sources::hash(text.as_bytes()) => Ok(text),
            _ => Err(format!("shaders/{path} is not what the program was built with: {REMEDY}")),
        }
    }
}

/// Rust text without comments, and without what `rustfmt` sets as it likes.
fn code(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.flat_map(str::chars).filter(|letter| !letter.is_whitespace() && *letter != ',').collect()
}

/// The first line that is neither comment nor attribute.
fn first_line(text: &str) -> &str {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.starts_with("//") && !line.starts_with('#'));
    lines.next().unwrap_or_default().trim_end_matches(" {")
}

#[cfg(test)]
mod tests;
