// engine/spread_samples: every sample of an image as a word, in a picture twice as wide and high: what the truth and all measures look at where
// pixels have four samples. Never in timed frames.
// No twin: a word is a sample; tests/tests/samples.rs holds it to pictures of one sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "grid.glsl"

layout(local_size_x = 64) in;
// The samples are floats, otherwise four bytes.
layout(constant_id = 0) const bool FLOATS = false;
layout(set = 0, binding = 0) uniform texture2DMS image;
layout(set = 0, binding = 1, scalar) writeonly buffer Spread { uint items[]; } spread;
layout(push_constant, scalar) uniform Push { uvec2 size_px; } push;

void main() {
    uint word = invocation_index();
    uvec2 spread_px = 2u * push.size_px;
    if (word >= spread_px.x * spread_px.y) return;
    uvec2 at = uvec2(word % spread_px.x, word / spread_px.x);
    vec4 texel = texelFetch(image, ivec2(at / 2u), int((at.x & 1u) + 2u * (at.y & 1u)));
    spread.items[word] = FLOATS ? floatBitsToUint(texel.r) : packUnorm4x8(texel);
}
