// eovc/mark_paths: from each effective occluder up to the root, every node on the way is visible; a node that another occluder
// has marked ends the climb (EOVC thesis III.3, figure 3). Right under concurrency: whoever exchanges first goes on. A mark is
// the frame's number, so that nothing need be cleared. Marked nodes are listed for the next stage, in no order.
// Twin: culling/src/eovc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Occluders { uint items[]; } occluders;
layout(set = 0, binding = 1, scalar) readonly buffer Leaves { uint items[]; } leaves;
layout(set = 0, binding = 2, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 3, scalar) buffer Marked { uint items[]; } marked;
layout(set = 0, binding = 4, scalar) writeonly buffer Visible { uint items[]; } visible;
layout(set = 0, binding = 5, scalar) buffer Grids { uint items[]; } grids;
layout(push_constant, scalar) uniform Push { uint object_count; uint frame; } push;
#include "list.glsl"

void climb(uint leaf) {
    uint node = leaf;
    while (node != TREE_NONE && atomicExchange(marked.items[node], push.frame) != push.frame) {
        visible.items[append_to(MARKED_LIST)] = node;
        node = nodes.items[node].parent;
    }
}

// An invocation looks at MARK_CHUNK objects, of which few are occluders. Occluders are neighbours in the list, and each waits for the climbs
// before it: so chunks are short.
void main() {
    uint first = invocation_index() * MARK_CHUNK;
    if (first >= push.object_count) return;
    uint end = min(first + MARK_CHUNK, push.object_count);
    for (uint object = first; object < end; object++)
        if (occluders.items[object] != 0u) climb(leaves.items[object]);
}
