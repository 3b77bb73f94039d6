//! Shaders to put in the place of those built in, without a compiler.

use shaders::reload::NewShader;
use shaders::{ShaderKind, ShaderModule, STAGES};

/// The environment variable that replaces shaders on every device of the tests: `hzb/test_bounds.comp=FILE.spv`, several joined by commas.
/// The example `mutate_shaders` sets it.
pub const SHADERS_VARIABLE: &str = "SIGHTLINE_TEST_SHADERS";

/// Reads the shaders that [`SHADERS_VARIABLE`] names; none without it.
///
/// # Panics
/// If an entry is not `STAGE.KIND=FILE`, or its file cannot be read.
pub fn from_environment() -> Vec<NewShader> {
    let named = std::env::var(SHADERS_VARIABLE).unwrap_or_default();
    named.split(',').filter(|entry| !entry.is_empty()).map(read).collect()
}

fn read(entry: &str) -> NewShader {
    let parts = entry.split_once('=').and_then(|(shader, path)| Some((shader.rsplit_once('.')?, path)));
    let Some(((stage, kind), path)) = parts else {
        panic!("{SHADERS_VARIABLE}: '{entry}' is not STAGE.KIND=FILE");
    };
    let kind = match kind {
        "comp" => ShaderKind::Compute,
        "vert" => ShaderKind::Vertex,
        "frag" => ShaderKind::Fragment,
        other => panic!("{SHADERS_VARIABLE}: '{other}' is not comp, vert or frag"),
    };
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{SHADERS_VARIABLE}: {path}: {error}"));
    NewShader { stage: stage.to_owned(), kind, words: words(&bytes) }
}

/// The words of SPIR-V, which is little-endian.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
}

/// A shader as it was built in.
///
/// # Panics
/// If there is none.
pub fn built_in(stage: &str, kind: ShaderKind) -> NewShader {
    let info = STAGES.iter().find(|info| info.name == stage).unwrap_or_else(|| panic!("no stage '{stage}'"));
    let is_it = |module: &&ShaderModule| module.kind == kind;
    let module = info.modules.iter().find(is_it).unwrap_or_else(|| panic!("no {kind:?} shader in '{stage}'"));
    NewShader { stage: stage.to_owned(), kind, words: words(module.spirv) }
}

/// `example/count_covered` with its comparison turned round: it counts what is not covered.
pub fn count_uncovered() -> NewShader {
    let mut shader = built_in("example/count_covered", ShaderKind::Compute);
    for (at, operation) in operations(&shader.words) {
        if operation == GREATER {
            shader.words[at] += LESS_OR_EQUAL - GREATER;
        }
    }
    shader
}

/// The fragment shader of a stage that draws colour, with red in place of that.
pub fn red(stage: &str) -> NewShader {
    let mut shader = built_in(stage, ShaderKind::Fragment);
    let words = &mut shader.words;
    let found = operations(words);
    let first = |wanted: &dyn Fn(usize, u32) -> bool| {
        found
            .iter()
            .find(|(at, operation)| wanted(*at, *operation))
            .map(|(at, _)| *at)
            .unwrap_or_else(|| panic!("{stage}"))
    };
    let float = words[first(&|at, operation| operation == TYPE_FLOAT && words[at + 2] == 32) + 1];
    let vec4 = words[first(&|at, operation| operation == TYPE_VECTOR && words[at + 2..at + 4] == [float, 4]) + 1];
    let is_output =
        |id: u32| found.iter().any(|(at, operation)| *operation == VARIABLE && words[at + 2..at + 4] == [id, OUTPUT]);
    let colour = words[first(&|at, operation| {
        operation == DECORATE && words[at + 2..at + 4] == [LOCATION, 0] && is_output(words[at + 1])
    }) + 1];
    let functions = first(&|_, operation| operation == FUNCTION);
    let [one, zero, red] = std::array::from_fn(|more| words[3] + more as u32);
    for (at, operation) in &found {
        if *operation == STORE && words[at + 1] == colour {
            words[at + 2] = red;
        }
    }
    words[3] += 3;
    let constants = [
        vec![4 << 16 | CONSTANT, float, one, 1.0_f32.to_bits()],
        vec![4 << 16 | CONSTANT, float, zero, 0],
        vec![7 << 16 | COMPOSITE, vec4, red, one, zero, zero, one],
    ];
    words.splice(functions..functions, constants.concat());
    shader
}

/// Numbers in SPIR-V.
const TYPE_FLOAT: u32 = 22;
const TYPE_VECTOR: u32 = 23;
const CONSTANT: u32 = 43;
const COMPOSITE: u32 = 44;
const FUNCTION: u32 = 54;
const VARIABLE: u32 = 59;
const STORE: u32 = 62;
const DECORATE: u32 = 71;
const GREATER: u32 = 186;
const LESS_OR_EQUAL: u32 = 188;
const OUTPUT: u32 = 3;
const LOCATION: u32 = 30;

/// Where each instruction begins, and its operation.
fn operations(words: &[u32]) -> Vec<(usize, u32)> {
    let (mut found, mut at) = (Vec::new(), 5);
    while at < words.len() {
        found.push((at, words[at] & 0xffff));
        at += (words[at] >> 16) as usize;
    }
    found
}
