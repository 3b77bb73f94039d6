// pack/count_flags: how many objects of each chunk are flagged? First of three steps of the ordered packing (EOVC thesis
// III.6.1, figure 11). Twin: culling/src/pack/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Flags { uint items[]; } flags;
layout(set = 0, binding = 1, scalar) writeonly buffer Counts { uint items[]; } counts;
layout(push_constant, scalar) uniform Push { uint first_object; uint object_count; } push;

void main() {
    uint chunk = invocation_index();
    uint first = chunk * PACK_CHUNK;
    if (first >= push.object_count) return;
    uint end = min(first + PACK_CHUNK, push.object_count);
    uint flagged = 0u;
    for (uint object = push.first_object + first; object < push.first_object + end; object++)
        flagged += flags.items[object] != 0u ? 1u : 0u;
    counts.items[chunk] = flagged;
}
