// warp/erode_depth: each texel of a warped depth is given the farthest depth of itself and its eight neighbours (Kim 2015,
// IV.1): outlines that the warp has a texel wrong, depths taken from half a texel off on a slope, and lone texels that are
// too near, hide nothing any more. Twin: culling/src/warp/twin.rs
//
// An invocation makes a block of 4x4 texels, of which each row of the source is read once.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "motion.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Warped { float items[]; } warped;
layout(set = 0, binding = 1, scalar) writeonly buffer Eroded { float items[]; } eroded;
layout(push_constant, scalar) uniform Push { uvec2 texels; } push;

// The farthest of three neighbours in a row, for the four columns of a block; rows and columns outside the picture repeat
// the last inside, which changes no farthest depth.
vec4 farthest_of_row(ivec2 first, int row) {
    uint line = uint(clamp(first.y + row, 0, int(push.texels.y) - 1)) * push.texels.x;
    float texel[6];
    for (int column = 0; column < 6; column++)
        texel[column] = warped.items[line + uint(clamp(first.x + column - 1, 0, int(push.texels.x) - 1))];
    return min(min(vec4(texel[0], texel[1], texel[2], texel[3]), vec4(texel[1], texel[2], texel[3], texel[4])),
        vec4(texel[2], texel[3], texel[4], texel[5]));
}

void main() {
    uvec2 blocks = (push.texels + ERODE_SIDE - 1u) / ERODE_SIDE;
    uint block = invocation_index();
    if (block >= blocks.x * blocks.y) return;
    ivec2 first = ivec2(block % blocks.x, block / blocks.x) * int(ERODE_SIDE);
    vec4 above = farthest_of_row(first, -1);
    vec4 here = farthest_of_row(first, 0);
    for (int row = 0; row < int(ERODE_SIDE); row++) {
        vec4 below = farthest_of_row(first, row + 1);
        vec4 farthest = min(min(above, here), below);
        uint line = uint(first.y + row) * push.texels.x + uint(first.x);
        for (int column = 0; column < int(ERODE_SIDE); column++)
            if (first.y + row < int(push.texels.y) && first.x + column < int(push.texels.x))
                eroded.items[line + uint(column)] = farthest[column];
        above = here;
        here = below;
    }
}
