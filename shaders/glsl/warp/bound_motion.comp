// warp/bound_motion: the first three levels of the min/max motion pyramid, background left out (TOG 2018, 3.3).
// Twin: culling/src/warp/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "moved.glsl"

layout(local_size_x = 64) in;
// Bounds lie along the axes that warp/orient_axes found; otherwise along x and y.
layout(constant_id = 0) const bool ORIENTED = false;
// Motions are in the buffer; otherwise they are computed from the depth of each texel's middle pixel, which the camera alone
// moves: that costs less than four words written and read.
layout(constant_id = 1) const bool STORED = true;
// Pixels of a texel's side.
layout(constant_id = 2) const uint REDUCTION = 1u;
layout(set = 0, binding = 0, scalar) readonly buffer Motions { TexelMotion items[]; } motions;
layout(set = 0, binding = 1, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 2, scalar) writeonly buffer Pyramid { MotionBound items[]; } pyramid;
layout(set = 0, binding = 3, scalar) readonly buffer Axes { vec2 items[]; } axes;
layout(set = 0, binding = 4, scalar) readonly buffer Depth { float items[]; } depth;
layout(push_constant, scalar) uniform Push { Reprojection camera; uvec2 texels; uvec2 tiles; uvec2 size_px; float fastest; } push;

TexelMotion motion_at(uvec2 texel) {
    if (STORED) return motions.items[texel.y * push.texels.x + texel.x];
    uvec2 pixel = middle_pixel(texel, REDUCTION, push.size_px);
    float here = depth.items[pixel.y * push.size_px.x + pixel.x];
    return motion_of(push.camera, pixel, here, push.size_px, REDUCTION, push.fastest);
}

MotionBound source_bound(uvec2 texel) {
    uvec2 inside = min(texel, push.texels - 1u);
    return bound_of(motion_at(inside), inside, push.texels, ORIENTED ? axes.items[0] : vec2(1.0, 0.0));
}

#include "bound.glsl"

void main() {
    uint tile = invocation_index();
    if (tile >= push.tiles.x * push.tiles.y) return;
    bound_tile(REDUCED_LEVELS, uvec2(tile % push.tiles.x, tile / push.tiles.x));
}
