// One reduction step, shared by hzb/reduce_depth and hzb/reduce_levels: each invocation turns one 8x8 tile of the source
// into 4x4, 2x2 and 1 farthest depths. No shared memory and no barrier: on a CPU device those cost five times the work.
// The including stage declares `pyramid`, `levels` and vec4 source_depths(uvec2 texel), of two by two from there on, clamped at the border.
#ifndef REDUCE_GLSL
#define REDUCE_GLSL
#include "pyramid.glsl"
#include "finest.glsl"

void store(uint level, uvec2 texel, float farthest) {
    PyramidLevel target = levels.items[level];
    if (level >= FINEST_LEVEL && texel.x < target.width && texel.y < target.height)
        pyramid.items[target.first + texel.y * target.width + texel.x] = farthest;
}

float reduce_cell(uint level, uvec2 texel) {
    vec4 depths = source_depths(texel * 2u);
    float farthest = min(min(depths.x, depths.y), min(depths.z, depths.w));
    store(level, texel, farthest);
    return farthest;
}

float reduce_quad(uint level, uvec2 texel) {
    uvec2 finer = texel * 2u;
    float farthest = min(min(reduce_cell(level - 1u, finer), reduce_cell(level - 1u, finer + uvec2(1u, 0u))),
        min(reduce_cell(level - 1u, finer + uvec2(0u, 1u)), reduce_cell(level - 1u, finer + uvec2(1u, 1u))));
    store(level, texel, farthest);
    return farthest;
}

// Writes the texels of `last_level` - 2 .. `last_level` that the tile covers.
void reduce_tile(uint last_level, uvec2 tile) {
    uvec2 finer = tile * 2u;
    float farthest = min(min(reduce_quad(last_level - 1u, finer), reduce_quad(last_level - 1u, finer + uvec2(1u, 0u))),
        min(reduce_quad(last_level - 1u, finer + uvec2(0u, 1u)), reduce_quad(last_level - 1u, finer + uvec2(1u, 1u))));
    store(last_level, tile, farthest);
}
#endif
