//! GLSL to SPIR-V through shaderc: Vulkan 1.3, SPIR-V 1.6, warnings as errors.

use crate::contract::ShaderKind;
use crate::sources::{include_folder, read_text, Source};
use shaderc::{CompileOptions, Compiler, EnvVersion, OptimizationLevel, ResolvedInclude, SpirvVersion, TargetEnv};
use std::path::{Path, PathBuf};

/// The one GLSL version in use. Without it glslang takes version 100 and prints all its built-in functions.
const VERSION: &str = "#version 460";

/// One shader, compiled twice.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// As written: every declared binding is still there. Reflection reads it.
    pub declared: Vec<u32>,
    /// Optimised for speed, names and source kept for RenderDoc. The device gets it.
    pub shipped: Vec<u32>,
}

/// A compiler and the folder where it finds what shaders include.
pub struct ShaderCompiler {
    compiler: Compiler,
    includes: PathBuf,
}

impl ShaderCompiler {
    /// A compiler for the shaders of the crate in folder `root`.
    pub fn new(root: &Path) -> Result<Self, String> {
        let compiler = Compiler::new().map_err(|error| format!("shaderc: {error}"))?;
        Ok(ShaderCompiler { compiler, includes: include_folder(root) })
    }

    /// Compiles `text` as the shader `source`. An error has a line per finding, each with file and line.
    pub fn compile(&self, source: &Source, text: &str) -> Result<Compiled, String> {
        Ok(Compiled {
            declared: self.translate(source, text, OptimizationLevel::Zero)?,
            shipped: self.ship(source, text)?,
        })
    }

    /// Compiles `text` only to what the device gets; for recompilation while a program runs.
    pub fn ship(&self, source: &Source, text: &str) -> Result<Vec<u32>, String> {
        self.translate(source, text, OptimizationLevel::Performance)
    }

    fn translate(&self, source: &Source, text: &str, level: OptimizationLevel) -> Result<Vec<u32>, String> {
        let file = source.file();
        if !text.lines().any(|line| line.trim() == VERSION) {
            return Err(format!("shaders/glsl/{file}: write `{VERSION}` after the comment at its head"));
        }
        let mut options = CompileOptions::new().map_err(|error| format!("shaderc: {error}"))?;
        options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_3 as u32);
        options.set_target_spirv(SpirvVersion::V1_6);
        options.set_warnings_as_errors();
        options.set_generate_debug_info();
        options.set_optimization_level(level);
        options.set_include_callback(|name, _, _, _| {
            let content = read_text(&self.includes.join(name)).map_err(|error| error.to_string())?;
            Ok(ResolvedInclude { resolved_name: format!("include/{name}"), content })
        });
        let artifact = self
            .compiler
            .compile_into_spirv(text, shader_kind(source.kind), &file, "main", Some(&options))
            .map_err(|error| findings(&file, &error))?;
        Ok(artifact.as_binary().to_vec())
    }
}

fn shader_kind(kind: ShaderKind) -> shaderc::ShaderKind {
    match kind {
        ShaderKind::Vertex => shaderc::ShaderKind::Vertex,
        ShaderKind::Fragment => shaderc::ShaderKind::Fragment,
        ShaderKind::Compute => shaderc::ShaderKind::Compute,
    }
}

/// The compiler's findings, a line each, paths as seen from the workspace.
fn findings(file: &str, error: &shaderc::Error) -> String {
    let shaderc::Error::CompilationError(_, text) = error else {
        return format!("shaders/glsl/{file}: {error}");
    };
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let lines = lines.map(|line| match line.contains(".glsl") || line.starts_with(file) {
        true => format!("shaders/glsl/{line}"),
        false => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}
