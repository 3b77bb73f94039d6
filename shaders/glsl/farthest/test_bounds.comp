// farthest/test_bounds: which objects in the view volume does a farthest-depth map not hide? An object is hidden if the
// nearest depth of its proxy lies behind the farthest depth within its image-space bound (Kim 2015, III.2; Lee et al. 2018, 5.2).
// Twin: culling/src/farthest/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "farthest.glsl"
#include "footprint.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
// 1: in the view volume.
layout(set = 0, binding = 1, scalar) readonly buffer Kept { uint items[]; } kept;
layout(set = 0, binding = 2, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 3, scalar) readonly buffer Texels { float items[]; } texels;
// The blocks in view; of the objects of others nothing is written.
layout(set = 0, binding = 5, scalar) readonly buffer Blocks { uint words[]; } blocks;
// 1: in the view volume and not hidden.
layout(set = 0, binding = 4, scalar) writeonly buffer Visible { uint items[]; } visible;
layout(push_constant, scalar) uniform Push { CullView view; FarthestShape shape; uint object_count; } push;
#include "blocks.glsl"

uint level_within(uvec2 sides) {
    return uint(findMSB(min(sides.x, sides.y)));
}

// The farthest depth of a region of a x b texels, by level floor(log2 min(a, b)), or the coarsest, and as many lookups as its squares need to
// cover the region: ceil(a / 2^level) x ceil(b / 2^level). Squares of an N-buffer begin anywhere, so the last of each row and
// column is moved back to end with the region. Texels of a mip level do not, and may reach out of it: that is conservative.
float farthest_within(uvec2 first_px, uvec2 last_px) {
    uvec2 first = first_px >> push.shape.reduction;
    uvec2 last = last_px >> push.shape.reduction;
    uint mip = min(level_within(last - first + 1u), push.shape.mip_levels);
    first >>= mip;
    last >>= mip;
    uvec2 sides = last - first + 1u;
    uint square = mip < push.shape.mip_levels ? 0u : min(level_within(sides), push.shape.coarsest_square);
    PyramidLevel level = levels.items[square == 0u ? mip : push.shape.squares_after + square];
    uvec2 squares = (sides + (1u << square) - 1u) >> square;
    uvec2 last_square = last + 1u - (1u << square);
    float farthest = 1.0;
    for (uint row = 0u; row < squares.y; row++) {
        uint y = min(first.y + (row << square), last_square.y);
        for (uint column = 0u; column < squares.x; column++) {
            uint x = min(first.x + (column << square), last_square.x);
            farthest = min(farthest, texels.items[level.first + y * level.width + x]);
        }
    }
    return farthest;
}

bool is_visible(Bounds bound) {
    if ((bound.flags & OBJECT_ALWAYS_KEPT) != 0u) return true;
    Footprint footprint = footprint_of(clip_from_bounds(bound, push.view), push.view, bound.flags);
    if (footprint.crosses_near) return true;
    return !footprint.empty && footprint.nearest >= farthest_within(footprint.first, footprint.last);
}

void main() {
    uint object = object_in_view();
    if (object >= push.object_count) return;
    visible.items[object] = kept.items[object] != 0u && is_visible(bounds.items[object]) ? 1u : 0u;
}
