// hzb/reduce_depth: the first three levels of the farthest-depth pyramid, straight from the depth buffer (Haar & Aaltonen
// 2015; depth is reversed, so the farthest is the smallest). Twin: culling/src/hzb/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"
#include "depth.glsl"

layout(local_size_x = 64) in;
// Gathered: on a CPU device a texture read is a call, and so four depths cost one.
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 2, scalar) writeonly buffer Pyramid { float items[]; } pyramid;
layout(push_constant, scalar) uniform Push { uvec2 size_px; uvec2 tiles; } push;

// The corner that four pixels share is half a pixel from where others would be gathered: more than coordinates are rounded by.
vec4 source_depths(uvec2 first) {
    vec4 kept = textureGather(depth, vec2(first + 1u) / vec2(push.size_px));
    return vec4(reversed(kept.x), reversed(kept.y), reversed(kept.z), reversed(kept.w));
}

#include "reduce.glsl"

void main() {
    uint tile = invocation_index();
    if (tile >= push.tiles.x * push.tiles.y) return;
    reduce_tile(REDUCED_LEVELS, uvec2(tile % push.tiles.x, tile / push.tiles.x));
}
