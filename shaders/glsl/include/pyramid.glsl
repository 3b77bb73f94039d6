// The farthest-depth pyramid. Level l (from 1) has ceil(size / 2^l) texels a side; texel (x, y) holds the farthest depth of
// all pixels p with p >> l == (x, y), exactly, at every size: rounding up means that no odd row or column is lost.
// All levels lie behind one another in one buffer, finest first.
#ifndef PYRAMID_GLSL
#define PYRAMID_GLSL
#include "types.glsl"

// Levels that one reduction writes: an 8x8 tile of its source becomes 4x4, 2x2 and 1 texels.
const uint REDUCED_LEVELS = 3u;

// The far plane: reversed depth.
const float DEPTH_FAR = 0.0;

uvec2 level_size(uvec2 size_px, uint level) {
    return (size_px + (1u << level) - 1u) >> level;
}
#endif
