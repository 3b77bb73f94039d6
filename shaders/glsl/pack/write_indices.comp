// pack/write_indices: the indices of flagged objects, in order, and how many there are as the instances of one draw. Last step
// of packing a list that is drawn instanced. Twin: culling/src/pack/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Flags { uint items[]; } flags;
layout(set = 0, binding = 1, scalar) readonly buffer Starts { uint items[]; } starts;
layout(set = 0, binding = 2, scalar) readonly buffer Total { uint items[]; } total;
layout(set = 0, binding = 3, scalar) writeonly buffer Listed { uint items[]; } listed;
layout(set = 0, binding = 4, scalar) writeonly buffer Command { DrawCommand items[]; } command;
layout(push_constant, scalar) uniform Push { uint object_count; } push;

void main() {
    uint chunk = invocation_index();
    uint first = chunk * PACK_CHUNK;
    if (first >= push.object_count) return;
    if (chunk == 0u) command.items[0].instance_count = total.items[0];
    uint end = min(first + PACK_CHUNK, push.object_count);
    uint slot = starts.items[chunk];
    for (uint object = first; object < end; object++)
        if (flags.items[object] != 0u) listed.items[slot++] = object;
}
