// hzb/measure_blocks: which blocks of objects are in view, where does each begin and end along it, and where do the nearest and the
// farthest begin?
// (hzb-iterative, step 1.) Twin: culling/src/hzb/iterative/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "cull.glsl"
#include "steps.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer BlockBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) writeonly buffer Spans { BlockSpan items[]; } spans;
// The bits of the largest begin, and those of the smallest inverted: floats from 0 on have the order of their bits. Must be 0 before.
layout(set = 0, binding = 2, scalar) buffer Reach { uint items[]; } reach;
layout(set = 0, binding = 3, scalar) readonly buffer Views { StepView items[]; } views;

// What the depths of a block and of an object in it may differ by, both rounded: each is a sum of five products and four sums of parts
// whose sizes add up to this at most, and a split difference (cull.glsl): 13 roundings each at most. An object that would fall between
// the ranges of its block would be looked at in no step.
float slack_of(Bounds bound, StepView all) {
    vec3 centre = relative_from_split(bound.centre_high, bound.centre_low, all.view.camera_high, all.view.camera_low);
    return CLIP_ERROR * (dot(abs(all.depth_plane.xyz), abs(centre) + bound.half_extent) + abs(all.depth_plane.w));
}

void main() {
    uint block = invocation_index();
    StepView all = views.items[0];
    if (block >= all.block_count) return;
    Bounds bound = bounds.items[block];
    BlockSpan span = BlockSpan(0.0, 3.0e38);
    if ((bound.flags & OBJECT_ALWAYS_KEPT) == 0u) {
        vec2 depth = depth_of_box(bound, all.depth_plane, all.view.camera_high, all.view.camera_low);
        float slack = slack_of(bound, all);
        span = BlockSpan(max(depth.x - depth.y - slack, 0.0), max(depth.x + depth.y + slack, 0.0));
        if (outside_frustum(clip_from_bounds(bound, all.view), footprint_widening(bound.flags, all.view))) span = BlockSpan(1.0, 0.0);
    }
    spans.items[block] = span;
    uint begin = floatBitsToUint(span.begin);
    // The looks before the atomics may be out of date, but never too large.
    if (span.begin <= span.end && begin > reach.items[0]) atomicMax(reach.items[0], begin);
    if (span.begin <= span.end && ~begin > reach.items[1]) atomicMax(reach.items[1], ~begin);
}
