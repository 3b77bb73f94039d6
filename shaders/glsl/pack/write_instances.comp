// pack/write_instances: a command for every object, which draws nothing if the object's flag is 0 (EOVC thesis III.6.1: what
// packing is compared with), in object order or (SCATTERED) spread evenly, so that those who take commands by batches all have some
// to draw (Kim 2015, IV.3). The end of the last command that draws something is what a counter read-back passes on.
// Twin: culling/src/pack/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool SCATTERED = false;
layout(set = 0, binding = 0, scalar) readonly buffer Flags { uint items[]; } flags;
layout(set = 0, binding = 1, scalar) readonly buffer ObjectMeshes { uint items[]; } object_meshes;
layout(set = 0, binding = 2, scalar) readonly buffer Meshes { MeshRange items[]; } meshes;
layout(set = 0, binding = 3, scalar) writeonly buffer Commands { DrawCommand items[]; } commands;
layout(set = 0, binding = 4, scalar) buffer End { uint items[]; } end;
// By object: where its command lies; a permutation of each range.
layout(set = 0, binding = 5, scalar) readonly buffer Places { uint items[]; } places;
// first_object: the range starts there.
layout(push_constant, scalar) uniform Push { uint first_object; uint object_count; } push;

void main() {
    uint index = invocation_index();
    if (index >= push.object_count) return;
    uint object = push.first_object + index;
    uint place = SCATTERED ? places.items[object] : index;
    bool drawn = flags.items[object] != 0u;
    MeshRange mesh = meshes.items[object_meshes.items[object]];
    commands.items[push.first_object + place] =
        DrawCommand(mesh.index_count, drawn ? 1u : 0u, mesh.first_index, mesh.vertex_offset, object);
    if (drawn && end.items[0] <= place) atomicMax(end.items[0], place + 1u);
}
