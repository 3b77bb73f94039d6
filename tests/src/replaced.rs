//! Shaders to put in the place of those built in, without a compiler.

use shaders::reload::NewShader;
use shaders::{ShaderKind, ShaderModule, STAGES};

/// A shader as it was built in.
///
/// # Panics
/// If there is none.
pub fn built_in(stage: &str, kind: ShaderKind) -> NewShader {
    let info = STAGES.iter().find(|info| info.name == stage).unwrap_or_else(|| panic!("no stage '{stage}'"));
    let is_it = |module: &&ShaderModule| module.kind == kind;
    let module = info.modules.iter().find(is_it).unwrap_or_else(|| panic!("no {kind:?} shader in '{stage}'"));
    let words = module.spirv.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    NewShader { stage: stage.to_owned(), kind, words: words.collect() }
}

/// `example/count_covered` with its comparison turned round: it counts what is not covered.
pub fn count_uncovered() -> NewShader {
    const GREATER: u32 = 186;
    const LESS_OR_EQUAL: u32 = 188;
    let mut shader = built_in("example/count_covered", ShaderKind::Compute);
    let mut at = 5;
    while at < shader.words.len() {
        let [length, operation] = [shader.words[at] >> 16, shader.words[at] & 0xffff];
        if operation == GREATER {
            shader.words[at] = length << 16 | LESS_OR_EQUAL;
        }
        at += length as usize;
    }
    shader
}

/// A fragment shader for a stage that writes a colour: all red. Its entry point has a name of four letters; the right one is `main`.
pub fn red(stage: &str, entry: &[u8; 4]) -> NewShader {
    let op = |operation: u32, operands: &[u32]| -> Vec<u32> {
        let first = (operands.len() as u32 + 1) << 16 | operation;
        std::iter::once(first).chain(operands.iter().copied()).collect()
    };
    let [main, colour, void, function, float, vec4, pointer, one, zero, red, label, bound] =
        std::array::from_fn(|id| 1 + id as u32);
    let words = [
        vec![0x0723_0203, 0x0001_0600, 0, bound, 0],
        op(17, &[1]),                                              // OpCapability Shader
        op(14, &[0, 1]),                                           // OpMemoryModel Logical GLSL450
        op(15, &[4, main, u32::from_le_bytes(*entry), 0, colour]), // OpEntryPoint Fragment
        op(16, &[main, 7]),                                        // OpExecutionMode OriginUpperLeft
        op(16, &[main, 9]),                                        // OpExecutionMode EarlyFragmentTests
        op(71, &[colour, 30, 0]),                                  // OpDecorate Location 0
        op(19, &[void]),                                           // OpTypeVoid
        op(33, &[function, void]),                                 // OpTypeFunction
        op(22, &[float, 32]),                                      // OpTypeFloat
        op(23, &[vec4, float, 4]),                                 // OpTypeVector
        op(32, &[pointer, 3, vec4]),                               // OpTypePointer Output
        op(59, &[pointer, colour, 3]),                             // OpVariable Output
        op(43, &[float, one, 1.0_f32.to_bits()]),                  // OpConstant
        op(43, &[float, zero, 0]),                                 // OpConstant
        op(44, &[vec4, red, one, zero, zero, one]),                // OpConstantComposite
        op(54, &[void, main, 0, function]),                        // OpFunction
        op(248, &[label]),                                         // OpLabel
        op(62, &[colour, red]),                                    // OpStore
        op(253, &[]),                                              // OpReturn
        op(56, &[]),                                               // OpFunctionEnd
    ];
    NewShader { stage: stage.to_owned(), kind: ShaderKind::Fragment, words: words.concat() }
}
