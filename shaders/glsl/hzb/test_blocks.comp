// hzb/test_blocks: which blocks may have objects that are due in this step, and do not lie wholly behind what was drawn? In step k
// are due what the last frame saw of range k and what it did not see of range k - 1: in step 0 the former alone. A block once hidden stays
// so for the rest of the frame, as depth only comes nearer. (hzb-iterative; Haar & Aaltonen 2015 test clusters so.) Twin: culling/src/hzb/iterative/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "footprint.glsl"
#include "pyramid.glsl"
#include "steps.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint FOOTPRINT_TEXELS = 4u;
// Something was drawn before: there is a pyramid of this frame.
layout(constant_id = 1) const bool BEHIND = true;
// There are several ranges, and blocks were measured; all are due in a single one.
layout(constant_id = 2) const bool MEASURED = true;
// Blocks are tested by how near their faces are at each texel as well.
layout(constant_id = 3) const bool FRONTS = true;
layout(set = 0, binding = 0, scalar) readonly buffer BlockBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) buffer Spans { BlockSpan items[]; } spans;
layout(set = 0, binding = 2, scalar) readonly buffer Reach { uint items[]; } reach;
layout(set = 0, binding = 3, scalar) readonly buffer Views { StepView items[]; } views;
layout(set = 0, binding = 4, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 5, scalar) readonly buffer Pyramid { float items[]; } pyramid;
// By block: 1 if it is due.
layout(set = 0, binding = 6, scalar) writeonly buffer Due { uint items[]; } due;
// What the last frame saw, by object.
layout(set = 0, binding = 7, scalar) readonly buffer Seen { uint items[]; } seen;
layout(push_constant, scalar) uniform Push { uint step; } push;
#include "hidden.glsl"
#include "fronts.glsl"

bool was_seen(uint block, uint object_count) {
    uint object = block * BLOCK_OBJECTS;
    uint end = min(object + BLOCK_OBJECTS, object_count);
    while (object < end && seen.items[object] == 0u) object++;
    return object < end;
}

// True if objects of a block so far away may be due.
bool is_in_reach(BlockSpan span, StepView all) {
    float nearest = nearest_begin(reach.items[1]);
    float outermost = uintBitsToFloat(reach.items[0]) - nearest;
    return span.begin <= span.end && push.step >= range_of(span.begin - nearest, outermost, all.range_count, all.share)
        && push.step <= range_of(span.end - nearest, outermost, all.range_count, all.share) + 1u;
}

bool is_in_view(Bounds bound, CullView view) {
    return (bound.flags & OBJECT_ALWAYS_KEPT) != 0u || !outside_frustum(clip_from_bounds(bound, view), footprint_widening(bound.flags, view));
}

bool is_hidden(Bounds bound, StepView all) {
    if (!is_visible(bound, all.view, all.coarsest_level)) return true;
    return FRONTS && (bound.flags & OBJECT_ALWAYS_KEPT) == 0u && hidden_by_fronts(bound, all.view, all.coarsest_level);
}

void main() {
    uint block = invocation_index();
    StepView all = views.items[0];
    if (block >= all.block_count) return;
    bool is_due = MEASURED ? is_in_reach(spans.items[block], all) : BEHIND || is_in_view(bounds.items[block], all.view);
    if (push.step == 0u) is_due = is_due && was_seen(block, is_due ? all.object_count : 0u);
    if (BEHIND && is_due && is_hidden(bounds.items[block], all)) {
        is_due = false;
        if (MEASURED) spans.items[block] = BlockSpan(1.0, 0.0);
    }
    due.items[block] = is_due ? 1u : 0u;
}
