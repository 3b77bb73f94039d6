// frustum/test_bounds: which objects are outside the view volume? n/p-vertex test on world boxes (Zachmann, VFC; GPU Gems
// 29.6.4), done in clip space so that perspective, parallel and oblique projections are one case. Twin: culling/src/frustum/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "cull.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) writeonly buffer Kept { uint items[]; } kept;
// The blocks in view; objects of others keep what `kept` says.
layout(set = 0, binding = 2, scalar) readonly buffer Blocks { uint words[]; } blocks;
layout(push_constant, scalar) uniform Push { CullView view; uint object_count; } push;
#include "blocks.glsl"

void main() {
    uint object = object_in_view();
    if (object >= push.object_count) return;
    Bounds bound = bounds.items[object];
    bool outside = false;
    if ((bound.flags & OBJECT_ALWAYS_KEPT) == 0u)
        outside = left_out(clip_from_bounds(bound, push.view), bound.flags, push.view);
    kept.items[object] = outside ? 0u : 1u;
}
