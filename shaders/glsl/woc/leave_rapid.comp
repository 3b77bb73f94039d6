// woc/leave_rapid: what was drawn first need not be drawn again, and is visible whatever the test says of it (Kim 2015, IV.1).
// Twin: culling/src/woc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Rapid { uint items[]; } rapid;
// By object: it is visible; the rapid ones are added.
layout(set = 0, binding = 1, scalar) buffer Visible { uint items[]; } visible;
// By object: it is visible and not rapid.
layout(set = 0, binding = 2, scalar) writeonly buffer Remaining { uint items[]; } remaining;
layout(push_constant, scalar) uniform Push { uint object_count; } push;

void main() {
    uint object = invocation_index();
    if (object >= push.object_count) return;
    uint first = rapid.items[object];
    uint tested = visible.items[object];
    remaining.items[object] = first != 0u ? 0u : tested;
    visible.items[object] = first | tested;
}
