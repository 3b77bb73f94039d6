// queries/test_nodes: the boxes of listed nodes of the hierarchy, counted by occlusion queries: several nodes a query where they
// are tested together or stand for one (CHC++, multiqueries and tight bounds), and several boxes for a leaf where its object has such
// (GPU Gems 29.5.1). Boxes are grown as those of objects are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Listed { uint items[]; } listed;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;
layout(set = 0, binding = 3, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;

invariant gl_Position;

void main() {
    // Numbers go on after those of nodes with those of boxes of objects.
    uint number = listed.items[gl_InstanceIndex];
    uint node_count = uint(nodes.items.length());
    Bounds bound;
    if (number < node_count) {
        bound = nodes.items[number].bounds;
    } else {
        bound = bounds.items[number - node_count];
    }
    gl_Position = clip_from_grown_corner(bound, views.items[0], uint(gl_VertexIndex));
}
