// eovc/select_occludees: what the rays hit and has not been drawn yet is drawn now (EOVC thesis III.5).
// Twin: culling/src/eovc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Hits { uint items[]; } hits;
layout(set = 0, binding = 1, scalar) readonly buffer Drawn { uint items[]; } drawn;
layout(set = 0, binding = 2, scalar) writeonly buffer Newly { uint items[]; } newly;
layout(push_constant, scalar) uniform Push { uint object_count; } push;

void main() {
    uint object = invocation_index();
    if (object >= push.object_count) return;
    newly.items[object] = hits.items[object] != 0u && drawn.items[object] == 0u ? 1u : 0u;
}
