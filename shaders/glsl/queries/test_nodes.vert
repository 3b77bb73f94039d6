// queries/test_nodes: the boxes of listed nodes of the hierarchy, counted by occlusion queries: several nodes a query where they
// are tested together or stand for one (CHC++, multiqueries and tight bounds). Boxes are grown as those of objects are.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Listed { uint items[]; } listed;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;

invariant gl_Position;

void main() {
    Bounds bound = nodes.items[listed.items[gl_InstanceIndex]].bounds;
    gl_Position = clip_from_grown_corner(bound, views.items[0], uint(gl_VertexIndex));
}
