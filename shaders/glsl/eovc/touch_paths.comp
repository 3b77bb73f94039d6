// eovc/touch_paths: what lies above an open node is open. Each node that a pixel of this frame saw into marks the way to the
// root, as far as nobody has, so that the next frame opens groups down to it. Twin: culling/src/eovc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) buffer Touched { uint items[]; } touched;
layout(push_constant, scalar) uniform Push { uint node_count; uint frame; } push;

void main() {
    uint node = invocation_index();
    if (node >= push.node_count || touched.items[node] != push.frame) return;
    uint above = nodes.items[node].parent;
    while (above != TREE_NONE && atomicExchange(touched.items[above], push.frame) != push.frame) above = nodes.items[above].parent;
}
