// hzb/write_blocks: one indirect command per object that is drawn in this step, in object order. Those whose boxes decide have no
// instance until their box shows, but for meshes so small that a box costs as much. (hzb-iterative; as
// pack/write_commands, but of listed blocks alone.) What is drawn counts as seen until the item buffer says otherwise. Twin: culling/src/hzb/iterative/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "kinds.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Blocks { uint words[]; } blocks;
layout(set = 0, binding = 1, scalar) buffer Shown { uint items[]; } shown;
layout(set = 0, binding = 2, scalar) readonly buffer Counts { uint items[]; } counts;
layout(set = 0, binding = 3, scalar) readonly buffer Starts { uint items[]; } starts;
layout(set = 0, binding = 4, scalar) readonly buffer Views { StepView items[]; } views;
layout(set = 0, binding = 5, scalar) readonly buffer ObjectMeshes { uint items[]; } object_meshes;
layout(set = 0, binding = 6, scalar) readonly buffer Meshes { MeshRange items[]; } meshes;
// Of each kind of primitive from its first object's place on.
layout(set = 0, binding = 7, scalar) writeonly buffer Commands { DrawCommand items[]; } commands;
// What this frame sees, by object.
layout(set = 0, binding = 8, scalar) writeonly buffer Visible { uint items[]; } visible;
// small_indices: objects of no more indices are drawn without a test of their box.
layout(push_constant, scalar) uniform Push { uint small_indices; } push;

void main() {
    uint place = invocation_index();
    if (place >= blocks.words[3]) return;
    StepView all = views.items[0];
    uint next[MOST_KINDS];
    uint left = 0u;
    for (uint kind = 0u; kind < KIND_COUNT; kind++) {
        next[kind] = starts.items[kind * all.block_count + place];
        if (kind > 0u) next[kind] += all.later_kinds[kind - 1u];
        left += counts.items[kind * all.block_count + place];
    }
    uint first = blocks.words[LISTED_HEADER + place] * BLOCK_OBJECTS;
    for (uint object = first; left != 0u; object++) {
        uint becomes = shown.items[object];
        if (becomes == STEP_HIDDEN) continue;
        left--;
        MeshRange mesh = meshes.items[object_meshes.items[object]];
        if (mesh.index_count <= push.small_indices) becomes = STEP_SHOWN;
        shown.items[object] = becomes;
        if (becomes == STEP_SHOWN) visible.items[object] = 1u;
        commands.items[next[kind_of(object, all)]++] = DrawCommand(mesh.index_count, becomes == STEP_SHOWN ? 1u : 0u, mesh.first_index, mesh.vertex_offset, object);
    }
}
