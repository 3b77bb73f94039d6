// Lens flares: the block of pixels that says how much of a light shows.
#ifndef FLARE_GLSL
#define FLARE_GLSL
#extension GL_EXT_scalar_block_layout : require

// Sides of the block, in pixels (GPU Gems 29.8.2).
const uint FLARE_BLOCK_PX = 16u;
// Sprites of a lens flare.
const uint FLARE_SPRITES = 7u;

// The part of a light's block that lies on the screen: pixels from the first corner up to, not with, the second.
struct FlareBlock {
    uvec2 from_px;
    uvec2 to_px;
    uvec2 size_px;      // of the picture
    float depth;        // the light's, reversed
};
#endif
