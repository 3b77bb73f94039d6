// eovc/test_singles: a fragment of the box is open, so the object may show. A ray would find the same.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(early_fragment_tests) in;

layout(location = 0) flat in uint node;
layout(location = 1) flat in uint object;

layout(set = 0, binding = 3, scalar) writeonly buffer Hits { uint items[]; } hits;
layout(set = 0, binding = 4, scalar) writeonly buffer Touched { uint items[]; } touched;
layout(push_constant, scalar) uniform Push { uint frame; } push;

void main() {
    hits.items[object] = 1u;
    touched.items[node] = push.frame;
}
