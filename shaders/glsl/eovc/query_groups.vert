// eovc/query_groups: the boxes of occludee groups against the depth of the effective occluders (EOVC thesis III.4, figures 6
// and 7). No colour, no depth is written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Groups { uint items[]; } groups;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;

layout(location = 0) flat out uint group;

invariant gl_Position;

void main() {
    group = groups.items[gl_InstanceIndex];
    gl_Position = clip_from_grown_corner(nodes.items[group].bounds, views.items[0], uint(gl_VertexIndex));
}
