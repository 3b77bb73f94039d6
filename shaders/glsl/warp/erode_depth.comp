// warp/erode_depth: the refinement of a warped depth by what is around each texel.
// ERODE gives a texel the farthest depth of itself and its eight neighbours (Kim 2015, IV.1): outlines that the warp has a
// texel wrong, depths taken from half a texel off on a slope, and lone texels that are too near, hide nothing any more.
// CLOSE gives a hole that surfaces surround the farthest of them, and lets no hole erode them (TOG 2018, 3.4, dilation): the
// searches around it succeeded, so at most two texels are not known. What comes into view there and is nearer than all
// around it still shows. Where background is among the neighbours, the hole becomes background.
// MERGE takes what was drawn ahead of this frame's objects, where it is nearer (Kim 2015, IV.1, rapid objects): the farthest of
// a texel's pixels, which the picture will show or something nearer. Twin: culling/src/warp/twin.rs
//
// An invocation makes a block of 4x4 texels, of which each row of the source is read once.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "motion.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool ERODE = true;
layout(constant_id = 1) const bool CLOSE = true;
layout(constant_id = 2) const bool MERGE = false;
// Pixels of a texel's side.
layout(constant_id = 3) const uint REDUCTION = 1u;
layout(set = 0, binding = 0, scalar) readonly buffer Warped { float items[]; } warped;
layout(set = 0, binding = 1, scalar) writeonly buffer Eroded { float items[]; } eroded;
// The depth drawn so far, by pixel.
layout(set = 0, binding = 2, scalar) readonly buffer Drawn { float items[]; } drawn;
layout(push_constant, scalar) uniform Push { uvec2 texels; uvec2 size_px; } push;

// Nearer than all depths: what a hole counts as among its neighbours, if it is to be closed.
const float LEFT_OUT = 2.0;

// The depths of a row of a block, with those beside it. Rows and columns outside the picture repeat the last inside, which
// changes no farthest depth.
struct Row {
    float texels[6];
};

Row row_of(ivec2 first, int row) {
    uint line = uint(clamp(first.y + row, 0, int(push.texels.y) - 1)) * push.texels.x;
    Row result;
    for (int column = 0; column < 6; column++) {
        float depth = warped.items[line + uint(clamp(first.x + column - 1, 0, int(push.texels.x) - 1))];
        result.texels[column] = CLOSE && depth == DEPTH_HOLE ? LEFT_OUT : depth;
    }
    return result;
}

// Of each column of the block and its two neighbours the farthest depth.
vec4 farthest_of_three(Row row) {
    vec4 left = vec4(row.texels[0], row.texels[1], row.texels[2], row.texels[3]);
    vec4 right = vec4(row.texels[2], row.texels[3], row.texels[4], row.texels[5]);
    return min(min(left, right), vec4(row.texels[1], row.texels[2], row.texels[3], row.texels[4]));
}

float drawn_in(uvec2 texel) {
    if (REDUCTION == 1u) return drawn.items[texel.y * push.size_px.x + texel.x];
    float farthest = 1.0;
    for (uint y = 0u; y < REDUCTION; y++) {
        for (uint x = 0u; x < REDUCTION; x++) {
            uvec2 pixel = min(texel * REDUCTION + uvec2(x, y), push.size_px - 1u);
            farthest = min(farthest, drawn.items[pixel.y * push.size_px.x + pixel.x]);
        }
    }
    return farthest;
}

void main() {
    uvec2 block = gl_GlobalInvocationID.xy;
    ivec2 first = ivec2(block * ERODE_SIDE);
    if (any(greaterThanEqual(uvec2(first), push.texels))) return;
    vec4 above = farthest_of_three(row_of(first, -1));
    Row row = row_of(first, 0);
    vec4 here = farthest_of_three(row);
    for (int y = 0; y < int(ERODE_SIDE); y++) {
        Row next = row_of(first, y + 1);
        vec4 below = farthest_of_three(next);
        vec4 farthest = min(min(above, here), below);
        uint line = uint(first.y + y) * push.texels.x + uint(first.x);
        for (int x = 0; x < int(ERODE_SIDE); x++) {
            float own = row.texels[x + 1];
            float depth = ERODE || own == LEFT_OUT ? farthest[x] : own;
            if (first.y + y < int(push.texels.y) && first.x + x < int(push.texels.x)) {
                float refined = depth == LEFT_OUT ? DEPTH_HOLE : depth;
                eroded.items[line + uint(x)] = MERGE ? max(refined, drawn_in(uvec2(first + ivec2(x, y)))) : refined;
            }
        }
        above = here;
        here = below;
        row = next;
    }
}
