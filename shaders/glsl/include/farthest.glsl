// Farthest-depth maps: N-buffers (Decoret 2005), Y-maps (Schwarz & Stamminger 2008) and plain mip pyramids in one form, as
// depth warping tests against them (Kim 2015, III.2; Lee et al. 2018, 5.2).
//
// The base, mip level 0, holds the farthest depth of 2^reduction x 2^reduction pixels a texel. Mip level l has half the texels
// of level l - 1 a side, rounded up: texel (x, y) holds the farthest depth of all base texels t with t >> l == (x, y). Square
// level n has the resolution of the last mip level: texel t holds the farthest depth of the 2^n x 2^n texels whose first is t.
// It ends where such a square would leave the picture; the papers' textures go on and hold less there. So no mip levels after
// the base is an N-buffer, some a Y-map, and mip levels down to a single texel, which leave no square but that, a pyramid.
//
// Square levels end where a whole picture takes FARTHEST_LOOKUPS squares at most: coarser ones cost as much to make as all
// others do, and few boxes on the screen are so large; these take more lookups, and get the same farthest depth.
//
// All levels lie behind one another in one buffer: the base, mip levels, square levels.
#ifndef FARTHEST_GLSL
#define FARTHEST_GLSL
#include "types.glsl"

// Texels of a row that one invocation writes: an invocation for each costs more than the work.
const uint FARTHEST_STRIP = 16u;

// Squares that cover a whole picture, at most.
const uint FARTHEST_LOOKUPS = 256u;

// What a farthest-depth map consists of.
struct FarthestShape {
    uint reduction;     // the base has a texel for 2^this pixels a side
    uint mip_levels;    // mip levels after the base
    uint squares_after; // square level n >= 1 is entry squares_after + n of the table of levels
    uint coarsest_square; // the last square level
};

uint strips_of(uint width) {
    return (width + FARTHEST_STRIP - 1u) / FARTHEST_STRIP;
}
#endif
