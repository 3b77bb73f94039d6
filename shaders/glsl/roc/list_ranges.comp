// roc/list_ranges: the commands of each depth range, in object order: what was seen and is drawn first, and all others, which
// draw nothing (no instance) until their box is found open. Last of three steps that sort objects into depth ranges (EOVC
// thesis II.2, iterative occlusion culling). Twin: culling/src/roc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "select.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Places { uint items[]; } places;
// By list and chunk, as roc/assign_ranges counts them.
layout(set = 0, binding = 1, scalar) readonly buffer Starts { uint items[]; } starts;
// By list.
layout(set = 0, binding = 2, scalar) readonly buffer Totals { uint items[]; } totals;
layout(set = 0, binding = 3, scalar) readonly buffer ObjectMeshes { uint items[]; } object_meshes;
layout(set = 0, binding = 4, scalar) readonly buffer Meshes { MeshRange items[]; } meshes;
// Each range has room for all objects.
layout(set = 0, binding = 5, scalar) writeonly buffer Early { DrawCommand items[]; } early;
layout(set = 0, binding = 6, scalar) writeonly buffer Late { DrawCommand items[]; } late;
// By range, then by kind of primitive: the draw of the boxes, one instance a command of `late`.
layout(set = 0, binding = 7, scalar) writeonly buffer Boxes { DrawCommand items[]; } boxes;
// room: commands that a range has room for. kind of kind_count: the kind of primitive that these objects are drawn with.
layout(push_constant, scalar) uniform Push {
    uint first_object;
    uint object_count;
    uint range_count;
    uint room;
    uint kind;
    uint kind_count;
} push;

void main() {
    uint chunk = invocation_index();
    uint first = chunk * PACK_CHUNK;
    if (first >= push.object_count) return;
    uint end = min(first + PACK_CHUNK, push.object_count);
    if (chunk == 0u)
        for (uint range = 0u; range < push.range_count; range++)
            boxes.items[range * push.kind_count + push.kind].instance_count = totals.items[push.range_count + range];
    uint chunk_count = (push.object_count + PACK_CHUNK - 1u) / PACK_CHUNK;
    uint next[2u * MOST_RANGES];
    for (uint list = 0u; list < 2u * push.range_count; list++) next[list] = starts.items[list * chunk_count + chunk];
    for (uint object = push.first_object + first; object < push.first_object + end; object++) {
        uint selects = places.items[object] & PLACE_SELECTION_MASK;
        if (selects == SELECT_NONE) continue;
        uint range = places.items[object] >> PLACE_RANGE_SHIFT;
        bool is_seen = selects == SELECT_SEEN;
        uint slot = range * push.room + push.first_object + next[(is_seen ? 0u : push.range_count) + range]++;
        MeshRange mesh = meshes.items[object_meshes.items[object]];
        DrawCommand command = DrawCommand(mesh.index_count, 1u, mesh.first_index, mesh.vertex_offset, object);
        if (selects == SELECT_TESTED) command.instance_count = 0u;
        if (is_seen) early.items[slot] = command;
        else late.items[slot] = command;
    }
}
