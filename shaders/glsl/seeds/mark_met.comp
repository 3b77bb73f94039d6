// seeds/mark_met: what the host's rays have met is taken for seen.
// No twin: it writes a one where a list says so; tests/tests/method_hzb_iterative/seeds.rs holds what comes of it to what the device's rays mark.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Met { uint items[]; } met;
layout(set = 0, binding = 1, scalar) writeonly buffer Seen { uint items[]; } seen;
layout(push_constant, scalar) uniform Push { uint met_count; } push;

void main() {
    uint index = invocation_index();
    if (index < push.met_count) seen.items[met.items[index]] = 1u;
}
