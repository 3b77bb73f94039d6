// warp/bound_motion: the first three levels of the min/max motion pyramid, background left out (TOG 2018, 3.3).
// Twin: culling/src/warp/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "motion.glsl"

layout(local_size_x = 64) in;
// Bounds lie along the axes that warp/orient_axes found; otherwise along x and y.
layout(constant_id = 0) const bool ORIENTED = false;
layout(set = 0, binding = 0, scalar) readonly buffer Motions { TexelMotion items[]; } motions;
layout(set = 0, binding = 1, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 2, scalar) writeonly buffer Pyramid { MotionBound items[]; } pyramid;
layout(set = 0, binding = 3, scalar) readonly buffer Axes { vec2 items[]; } axes;
layout(push_constant, scalar) uniform Push { uvec2 texels; uvec2 tiles; } push;

MotionBound source_bound(uvec2 texel) {
    uvec2 inside = min(texel, push.texels - 1u);
    return bound_of(motions.items[inside.y * push.texels.x + inside.x], inside, push.texels, ORIENTED ? axes.items[0] : vec2(1.0, 0.0));
}

#include "bound.glsl"

void main() {
    uint tile = invocation_index();
    if (tile >= push.tiles.x * push.tiles.y) return;
    bound_tile(REDUCED_LEVELS, uvec2(tile % push.tiles.x, tile / push.tiles.x));
}
