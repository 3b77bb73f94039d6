// warp/tighten_bounds: which motions can bring a texel to each tile of the new view? The bound of all motions says where a
// source can lie; the bound of what lies there is narrower, and says it better; and so on (TOG 2018, 3.3, figure 5).
// Twin: culling/src/warp/twin.rs
//
// Three departures. A tile of texels shares one bound, as neighbours look at much the same region; with TILE = 1 each texel
// has its own, as in the paper. Each step keeps what the new and the old bound have in common, since the source's motion is
// in both. And where they have nothing in common, or nothing lies in the region, the tile has no source: the paper goes on
// with the old bound, to search in vain; we do so only if holes are to be filled from it (KEEP_LAST).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "motion.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// Tightening steps; with none the bound of all motions is taken.
layout(constant_id = 0) const uint STEPS = 3u;
// Texels of a tile's side.
layout(constant_id = 1) const uint TILE = 4u;
layout(constant_id = 2) const bool KEEP_LAST = false;
layout(constant_id = 3) const bool ORIENTED = false;
// Texels of the pyramid that a region may touch in each direction: 2 are the paper's four lookups; with more, long regions are
// bounded by smaller texels, as by anisotropic lookups (Kim 2015, III.1.C).
layout(constant_id = 4) const uint LOOKUPS = 2u;

layout(set = 0, binding = 0, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 1, scalar) readonly buffer Pyramid { MotionBound items[]; } pyramid;
layout(set = 0, binding = 2, scalar) writeonly buffer TileBounds { MotionBound items[]; } bounds;
layout(set = 0, binding = 3, scalar) readonly buffer Axes { vec2 items[]; } axes;
layout(push_constant, scalar) uniform Push { uvec2 texels; uvec2 tiles; uint coarsest_level; } push;

MotionBound texel_bound(PyramidLevel level, uvec2 texel) {
    return pyramid.items[level.first + texel.y * level.width + texel.x];
}

// The bound of all motions that start between two places, in texels: of as many texels as may be looked up, at the level at
// which they cover that.
MotionBound local_bound(vec2 low, vec2 high) {
    vec2 size = vec2(push.texels);
    if (any(lessThan(high, vec2(0.0))) || any(greaterThanEqual(low, size))) return no_motion();
    uvec2 first = uvec2(clamp(floor(low), vec2(0.0), size - 1.0));
    uvec2 last = uvec2(clamp(floor(high), vec2(0.0), size - 1.0));
    uvec2 span = last - first;
    // The finest level at which first and last are LOOKUPS - 1 texels apart at most: 2^level (LOOKUPS - 1) >= span.
    uint widest = (max(span.x, span.y) + LOOKUPS - 2u) / (LOOKUPS - 1u);
    uint level = widest > 2u ? min(uint(findMSB(widest - 1u)) + 1u, push.coarsest_level) : 1u;
    PyramidLevel texels = levels.items[level];
    first >>= level;
    last >>= level;
    if (LOOKUPS == 2u) {
        return union_of(union_of(texel_bound(texels, first), texel_bound(texels, uvec2(last.x, first.y))),
            union_of(texel_bound(texels, uvec2(first.x, last.y)), texel_bound(texels, last)));
    }
    MotionBound bound = no_motion();
    for (uint y = first.y; y <= last.y; y++)
        for (uint x = first.x; x <= last.x; x++) bound = union_of(bound, texel_bound(texels, uvec2(x, y)));
    return bound;
}

void main() {
    uvec2 tile = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(tile, push.tiles))) return;
    uvec2 first = tile * TILE;
    uvec2 last = min(first + TILE, push.texels) - 1u;
    MotionBound bound = texel_bound(levels.items[push.coarsest_level], uvec2(0u));
    for (uint step = 0u; step < STEPS && has_motion(bound); step++) {
        MotionBound moved = ORIENTED ? upright(bound, axes.items[0]) : bound;
        vec2 low = vec2(first) + 0.5 - moved.high - WARP_REACH;
        vec2 high = vec2(last) + 0.5 - moved.low + WARP_REACH;
        MotionBound tighter = common_to(bound, local_bound(low, high));
        if (KEEP_LAST && !has_motion(tighter)) break;
        bound = tighter;
    }
    bounds.items[tile.y * push.tiles.x + tile.x] = bound;
}
