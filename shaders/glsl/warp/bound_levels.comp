// warp/bound_levels: three coarser levels of the min/max motion pyramid from the one below. Twin: culling/src/warp/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "motion.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 1, scalar) buffer Pyramid { MotionBound items[]; } pyramid;
layout(push_constant, scalar) uniform Push { uint source_level; uvec2 tiles; } push;

MotionBound source_bound(uvec2 texel) {
    PyramidLevel source = levels.items[push.source_level];
    uvec2 inside = min(texel, uvec2(source.width, source.height) - 1u);
    return pyramid.items[source.first + inside.y * source.width + inside.x];
}

#include "bound.glsl"

void main() {
    uint tile = invocation_index();
    if (tile >= push.tiles.x * push.tiles.y) return;
    bound_tile(push.source_level + REDUCED_LEVELS, uvec2(tile % push.tiles.x, tile / push.tiles.x));
}
