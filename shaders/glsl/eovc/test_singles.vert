// eovc/test_singles: the boxes of occludee groups of one object against the depth of the effective occluders (EOVC thesis
// III.4). No colour, no depth is written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Singles { uint items[]; } singles;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;

layout(location = 0) flat out uint node;
layout(location = 1) flat out uint object;

invariant gl_Position;

void main() {
    node = singles.items[gl_InstanceIndex];
    object = nodes.items[node].first_child;
    gl_Position = clip_from_grown_corner(nodes.items[node].bounds, views.items[0], uint(gl_VertexIndex));
}
