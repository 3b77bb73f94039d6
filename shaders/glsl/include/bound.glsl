// One step of the motion pyramid, shared by warp/bound_motion and warp/bound_levels: each invocation turns one 8x8 tile of the
// source into 4x4, 2x2 and 1 bounds, without shared memory or barriers (reduce.glsl says why).
// The including stage declares `levels`, `pyramid` and MotionBound source_bound(uvec2 texel), which clamps at the border.
#ifndef BOUND_GLSL
#define BOUND_GLSL
#include "motion.glsl"

void store(uint level, uvec2 texel, MotionBound bound) {
    PyramidLevel target = levels.items[level];
    if (texel.x < target.width && texel.y < target.height)
        pyramid.items[target.first + texel.y * target.width + texel.x] = bound;
}

MotionBound bound_cell(uint level, uvec2 texel) {
    uvec2 source = texel * 2u;
    MotionBound bound = union_of(union_of(source_bound(source), source_bound(source + uvec2(1u, 0u))),
        union_of(source_bound(source + uvec2(0u, 1u)), source_bound(source + uvec2(1u, 1u))));
    store(level, texel, bound);
    return bound;
}

MotionBound bound_quad(uint level, uvec2 texel) {
    uvec2 finer = texel * 2u;
    MotionBound bound = union_of(union_of(bound_cell(level - 1u, finer), bound_cell(level - 1u, finer + uvec2(1u, 0u))),
        union_of(bound_cell(level - 1u, finer + uvec2(0u, 1u)), bound_cell(level - 1u, finer + uvec2(1u, 1u))));
    store(level, texel, bound);
    return bound;
}

// Writes the texels of `last_level` - 2 .. `last_level` that the tile covers.
void bound_tile(uint last_level, uvec2 tile) {
    uvec2 finer = tile * 2u;
    MotionBound bound = union_of(union_of(bound_quad(last_level - 1u, finer), bound_quad(last_level - 1u, finer + uvec2(1u, 0u))),
        union_of(bound_quad(last_level - 1u, finer + uvec2(0u, 1u)), bound_quad(last_level - 1u, finer + uvec2(1u, 1u))));
    store(last_level, tile, bound);
}
#endif
