// eovc/filter_occluders: whoever owns a pixel of the item buffer is an occluder of the next frame (EOVC thesis III.6.2, figures
// 12 and 13). Drawing in any order flags hidden objects too; this does not. One invocation a strip of two columns and FILTER_STRIP
// rows: what it has just flagged it need not flag again. Twin: culling/src/eovc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
// Gathered: on a CPU device a texture read is a call, and so four owners cost one.
layout(set = 0, binding = 0) uniform usampler2D owners;
layout(set = 0, binding = 1, scalar) writeonly buffer Occluders { uint items[]; } occluders;
// strips: how many there are across and down.
layout(push_constant, scalar) uniform Push { uvec2 size_px; uvec2 strips; } push;

void main() {
    uint strip = invocation_index();
    if (strip >= push.strips.x * push.strips.y) return;
    uvec2 first = uvec2(strip % push.strips.x * 2u, strip / push.strips.x * FILTER_STRIP);
    uint end = min(first.y + FILTER_STRIP, push.size_px.y);
    uint flagged = ITEM_NONE;
    for (uint y = first.y; y < end; y += 2u) {
        // Beyond the border the last row or column is read again.
        uvec4 four = textureGather(owners, vec2(first.x + 1u, y + 1u) / vec2(push.size_px));
        for (uint corner = 0u; corner < 4u; corner++) {
            uint owner = four[corner];
            if (owner == flagged || owner == ITEM_NONE) continue;
            occluders.items[owner] = 1u;
            flagged = owner;
        }
    }
}
