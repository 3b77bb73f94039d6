// world/turn_objects: gives objects that have turned inside out the index range whose triangles go the other way round (glTF 2.0, 3.7.4).
// Twin: culling/src/world/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "turned.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Turned { TurnedObject items[]; } turned;
layout(set = 0, binding = 1, scalar) readonly buffer Meshes { MeshRange items[]; } meshes;
// The mesh of each object, indexed by object.
layout(set = 0, binding = 2, scalar) writeonly buffer ObjectMeshes { uint items[]; } object_meshes;
// A command for each object, indexed by object. Both ranges of an object have the same vertices and as many indices.
layout(set = 0, binding = 3, scalar) writeonly buffer AllCommands { DrawCommand items[]; } all_commands;
layout(push_constant, scalar) uniform Push { uint object_count; } push;

void main() {
    uint index = invocation_index();
    if (index >= push.object_count) return;
    TurnedObject now = turned.items[index];
    object_meshes.items[now.object] = now.mesh;
    all_commands.items[now.object].first_index = meshes.items[now.mesh].first_index;
}
