// eovc/extract_groups: a node that is not visible below one that is, or the root if nothing is, is an occludee group (EOVC
// thesis III.3, figures 3 and 4). One invocation a visible node, which looks at its children. Twin: culling/src/eovc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Marked { uint items[]; } marked;
layout(set = 0, binding = 2, scalar) readonly buffer Visible { uint items[]; } visible;
layout(set = 0, binding = 3, scalar) writeonly buffer Groups { uint items[]; } groups;
layout(set = 0, binding = 4, scalar) buffer Grids { uint items[]; } grids;
layout(push_constant, scalar) uniform Push { uint frame; } push;
#include "list.glsl"

void main() {
    uint place = invocation_index();
    uint visible_count = length_of(MARKED_LIST);
    if (visible_count == 0u && place == 0u) groups.items[append_to(FIRST_CULL_LIST)] = 0u;
    if (place >= visible_count) return;
    uint node = visible.items[place];
    if (nodes.items[node].is_leaf != 0u) return;
    uint first = nodes.items[node].first_child;
    for (uint child = first; child < first + 2u; child++)
        if (marked.items[child] != push.frame) groups.items[append_to(FIRST_CULL_LIST)] = child;
}
