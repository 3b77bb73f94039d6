// farthest/fill_from_depth: the base of a farthest-depth map from a depth buffer, at its size or reduced (Kim 2015, VI): the
// farthest of the pixels that a texel stands for. Twin: culling/src/farthest/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "grid.glsl"
#include "farthest.glsl"
#include "depth.glsl"

layout(local_size_x = 64) in;
// A texel stands for 2^this pixels a side. A constant, so that loops over pixels unroll: half the time.
layout(constant_id = 0) const uint REDUCTION = 0u;
layout(set = 0, binding = 0) uniform texture2D depth;
layout(set = 0, binding = 1, scalar) writeonly buffer Base { float items[]; } base;
layout(push_constant, scalar) uniform Push { uvec2 size_px; uvec2 base_size; } push;

float farthest_of(uvec2 texel) {
    uvec2 first = texel << REDUCTION;
    float farthest = 1.0;
    for (uint y = 0u; y < 1u << REDUCTION; y++)
        for (uint x = 0u; x < 1u << REDUCTION; x++)
            farthest = min(farthest, reversed(texelFetch(depth, ivec2(min(first + uvec2(x, y), push.size_px - 1u)), 0).r));
    return farthest;
}

void main() {
    uint strips = strips_of(push.base_size.x);
    uint strip = invocation_index();
    if (strip >= strips * push.base_size.y) return;
    uint y = strip / strips;
    uint first = strip % strips * FARTHEST_STRIP;
    for (uint x = first; x < first + FARTHEST_STRIP; x++)
        if (x < push.base_size.x) base.items[y * push.base_size.x + x] = farthest_of(uvec2(x, y));
}
