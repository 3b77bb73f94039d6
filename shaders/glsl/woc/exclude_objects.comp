// woc/exclude_objects: of some objects, those that are not among others: what was culled and may be tested again (objects in
// view without those drawn), or what is still to be drawn (visible objects without those drawn first).
// Twin: culling/src/woc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Objects { uint items[]; } objects;
layout(set = 0, binding = 1, scalar) readonly buffer Excluded { uint items[]; } excluded;
layout(set = 0, binding = 2, scalar) writeonly buffer Remaining { uint items[]; } remaining;
layout(push_constant, scalar) uniform Push { uint object_count; } push;

void main() {
    uint object = invocation_index();
    if (object >= push.object_count) return;
    remaining.items[object] = objects.items[object] != 0u && excluded.items[object] == 0u ? 1u : 0u;
}
