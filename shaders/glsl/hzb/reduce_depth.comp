// hzb/reduce_depth: the first three levels of the farthest-depth pyramid, straight from the depth buffer (Haar & Aaltonen
// 2015; depth is reversed, so the farthest is the smallest). Twin: culling/src/hzb/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "grid.glsl"
#include "types.glsl"
#include "depth.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform texture2D depth;
layout(set = 0, binding = 1, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 2, scalar) writeonly buffer Pyramid { float items[]; } pyramid;
layout(push_constant, scalar) uniform Push { uvec2 size_px; uvec2 tiles; } push;

float source_depth(uvec2 texel) {
    return reversed(texelFetch(depth, ivec2(min(texel, push.size_px - 1u)), 0).r);
}

#include "reduce.glsl"

void main() {
    uint tile = invocation_index();
    if (tile >= push.tiles.x * push.tiles.y) return;
    reduce_tile(REDUCED_LEVELS, uvec2(tile % push.tiles.x, tile / push.tiles.x));
}
