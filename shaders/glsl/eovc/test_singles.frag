// eovc/test_singles: a fragment of the box is open, so the object may show. A ray would find the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "types.glsl"
layout(early_fragment_tests) in;

layout(location = 0) flat in uint node;
layout(location = 1) flat in uint object;

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 3, scalar) writeonly buffer Hits { uint items[]; } hits;
layout(set = 0, binding = 4, scalar) buffer Touched { uint items[]; } touched;
layout(push_constant, scalar) uniform Push { uint frame; } push;
#include "touch.glsl"

void main() {
    if (!lives(node) || touched.items[node] == push.frame ||
        atomicExchange(touched.items[node], push.frame) == push.frame) return;
    hits.items[object] = 1u;
    touch_above(node);
}
