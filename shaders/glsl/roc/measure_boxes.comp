// roc/measure_boxes: what becomes of each object, how far from the eye its box begins, and how far the farthest of those in
// view does. First of three steps that sort objects into depth ranges (EOVC thesis II.2, iterative occlusion culling).
// Twin: culling/src/roc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "select.glsl"
#include "ranges.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
// What the last frame saw.
layout(set = 0, binding = 1, scalar) readonly buffer Seen { uint items[]; } seen;
// SELECT_* of each object.
layout(set = 0, binding = 2, scalar) writeonly buffer Selected { uint items[]; } selected;
// Metres, from 0 on.
layout(set = 0, binding = 3, scalar) writeonly buffer Depths { float items[]; } depths;
// The bits of the largest depth: floats from 0 on have the order of their bits. Must be 0 before.
layout(set = 0, binding = 4, scalar) buffer Farthest { uint items[]; } farthest;
// dot(depth_plane, vec4(p, 1)) is how far p, relative to the camera, lies in front of the eye (of a parallel view: behind the
// near plane), in metres.
layout(push_constant, scalar) uniform Push { CullView view; vec4 depth_plane; uint object_count; } push;

void main() {
    uint object = invocation_index();
    if (object >= push.object_count) return;
    Bounds bound = bounds.items[object];
    uint selects = selection(bound, seen.items[object] != 0u, push.view);
    float depth = (bound.flags & OBJECT_ALWAYS_KEPT) != 0u ? 0.0
        : begin_of_box(bound, push.depth_plane, push.view.camera_high, push.view.camera_low);
    selected.items[object] = selects;
    depths.items[object] = depth;
    bool in_view = selects == SELECT_SEEN
        ? !left_out(clip_from_bounds(bound, push.view), bound.flags, push.view)
        : selects != SELECT_NONE;
    // What the last frame saw counts like the rest, so that the ranges of a view do not depend on its history. The look
    // before the atomic may be out of date, but never too large; without it all objects queue for one word.
    if (in_view && floatBitsToUint(depth) > farthest.items[0]) atomicMax(farthest.items[0], floatBitsToUint(depth));
}
