// world/move_transforms: puts the transforms of moving objects in their places whose bounds stay: those that hold more than one place.
// Twin: culling/src/world/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Moves { MovedTransform items[]; } moves;
layout(set = 0, binding = 1, scalar) writeonly buffer Objects { Object items[]; } objects;
layout(push_constant, scalar) uniform Push { uint move_count; } push;

void main() {
    uint index = invocation_index();
    if (index >= push.move_count) return;
    MovedTransform moved = moves.items[index];
    objects.items[moved.index] = moved.object;
}
