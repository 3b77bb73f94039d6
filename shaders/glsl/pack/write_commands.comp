// pack/write_commands: one indirect command per flagged object, in object order, so that equal depths resolve the same way
// each frame. Last of three steps of the ordered packing (EOVC thesis III.6.1). Twin: culling/src/pack/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Flags { uint items[]; } flags;
layout(set = 0, binding = 1, scalar) readonly buffer Starts { uint items[]; } starts;
layout(set = 0, binding = 2, scalar) readonly buffer ObjectMeshes { uint items[]; } object_meshes;
layout(set = 0, binding = 3, scalar) readonly buffer Meshes { MeshRange items[]; } meshes;
layout(set = 0, binding = 4, scalar) writeonly buffer Commands { DrawCommand items[]; } commands;
// first_object: the packed range starts there; commands of earlier ranges lie before it.
// How many objects of each chunk are flagged: most chunks have none, and no invocation looks behind the last.
layout(set = 0, binding = 5, scalar) readonly buffer Counts { uint items[]; } counts;
layout(push_constant, scalar) uniform Push { uint first_object; uint object_count; } push;

void main() {
    uint chunk = invocation_index();
    uint first = chunk * PACK_CHUNK;
    if (first >= push.object_count) return;
    uint end = min(first + PACK_CHUNK, push.object_count);
    uint slot = push.first_object + starts.items[chunk];
    uint left = counts.items[chunk];
    for (uint object = push.first_object + first; left != 0u && object < push.first_object + end; object++) {
        if (flags.items[object] == 0u) continue;
        left--;
        MeshRange mesh = meshes.items[object_meshes.items[object]];
        commands.items[slot++] = DrawCommand(mesh.index_count, 1u, mesh.first_index, mesh.vertex_offset, object);
    }
}
