// engine/copy_depth: a depth buffer as reversed floats, where its format is another and copying would give other bits.
// No twin: a texel is a word; tests/tests/precision.rs holds it to what the host reads.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "grid.glsl"
#include "depth.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform texture2D depth;
layout(set = 0, binding = 1, scalar) writeonly buffer Copied { float items[]; } copied;
layout(push_constant, scalar) uniform Push { uvec2 size_px; } push;

void main() {
    uint pixel = invocation_index();
    if (pixel >= push.size_px.x * push.size_px.y) return;
    ivec2 at = ivec2(pixel % push.size_px.x, pixel / push.size_px.x);
    copied.items[pixel] = reversed(texelFetch(depth, at, 0).r);
}
