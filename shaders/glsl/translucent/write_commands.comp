// translucent/write_commands: a command for every translucent object, back to front; of no instances for those that do not show
// (GPU Gems 29.4.1). Twin: culling/src/translucent/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
// By object.
layout(set = 0, binding = 0, scalar) readonly buffer Shown { uint items[]; } shown;
// Objects, back to front.
layout(set = 0, binding = 1, scalar) readonly buffer Order { uint items[]; } order;
layout(set = 0, binding = 2, scalar) readonly buffer ObjectMeshes { uint items[]; } object_meshes;
layout(set = 0, binding = 3, scalar) readonly buffer Meshes { MeshRange items[]; } meshes;
layout(set = 0, binding = 4, scalar) writeonly buffer Commands { DrawCommand items[]; } commands;
layout(push_constant, scalar) uniform Push { uint object_count; } push;

void main() {
    uint place = invocation_index();
    if (place >= push.object_count) return;
    uint object = order.items[place];
    MeshRange mesh = meshes.items[object_meshes.items[object]];
    uint instances = shown.items[object] != 0u ? 1u : 0u;
    commands.items[place] = DrawCommand(mesh.index_count, instances, mesh.first_index, mesh.vertex_offset, object);
}
