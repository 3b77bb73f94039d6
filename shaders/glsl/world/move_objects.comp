// world/move_objects: puts the transforms and bounds of this frame's moving objects in their places.
// Twin: culling/src/world/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Moves { MovedObject items[]; } moves;
layout(set = 0, binding = 1, scalar) writeonly buffer Objects { Object items[]; } objects;
layout(set = 0, binding = 2, scalar) writeonly buffer AllBounds { Bounds items[]; } bounds;
layout(push_constant, scalar) uniform Push { uint move_count; } push;

void main() {
    uint index = invocation_index();
    if (index >= push.move_count) return;
    MovedObject moved = moves.items[index];
    objects.items[moved.index] = moved.object;
    bounds.items[moved.index] = moved.bounds;
}
