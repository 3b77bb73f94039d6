// eovc/filter_occluders: whoever owns a pixel of the item buffer is an occluder of the next frame (EOVC thesis III.6.2, figures
// 12 and 13). Drawing in any order flags hidden objects too; this does not. One invocation a strip of FILTER_STRIP pixels of
// a column: what it has just flagged it need not flag again. Twin: culling/src/eovc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform utexture2D owners;
layout(set = 0, binding = 1, scalar) writeonly buffer Occluders { uint items[]; } occluders;
layout(push_constant, scalar) uniform Push { uvec2 size_px; uint strips; } push;

void main() {
    uint strip = invocation_index();
    if (strip >= push.strips * push.size_px.x) return;
    uvec2 first = uvec2(strip % push.size_px.x, strip / push.size_px.x * FILTER_STRIP);
    uint end = min(first.y + FILTER_STRIP, push.size_px.y);
    uint flagged = ITEM_NONE;
    for (uint y = first.y; y < end; y++) {
        uint owner = texelFetch(owners, ivec2(first.x, y), 0).r;
        if (owner == flagged || owner == ITEM_NONE) continue;
        occluders.items[owner] = 1u;
        flagged = owner;
    }
}
