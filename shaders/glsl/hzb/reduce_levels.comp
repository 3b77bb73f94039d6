// hzb/reduce_levels: three coarser levels of the farthest-depth pyramid from the one below. Twin: culling/src/hzb/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 1, scalar) buffer Pyramid { float items[]; } pyramid;
layout(push_constant, scalar) uniform Push { uint source_level; uvec2 tiles; } push;

float source_depth(uvec2 texel) {
    PyramidLevel source = levels.items[push.source_level];
    uvec2 inside = min(texel, uvec2(source.width, source.height) - 1u);
    return pyramid.items[source.first + inside.y * source.width + inside.x];
}

vec4 source_depths(uvec2 first) {
    return vec4(source_depth(first), source_depth(first + uvec2(1u, 0u)), source_depth(first + uvec2(0u, 1u)), source_depth(first + uvec2(1u, 1u)));
}

#include "reduce.glsl"

void main() {
    uint tile = invocation_index();
    if (tile >= push.tiles.x * push.tiles.y) return;
    reduce_tile(push.source_level + REDUCED_LEVELS, uvec2(tile % push.tiles.x, tile / push.tiles.x));
}
