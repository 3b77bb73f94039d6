// hzb/test_objects: which objects of the listed blocks are due in this step, and not hidden by what was drawn before? A work group a
// block. (hzb-iterative; the test is that of Haar & Aaltonen 2015.) Twin: culling/src/hzb/iterative/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "footprint.glsl"
#include "box.glsl"
#include "pyramid.glsl"
#include "kinds.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint FOOTPRINT_TEXELS = 4u;
// Something was drawn before: there is a pyramid of this frame.
layout(constant_id = 1) const bool BEHIND = true;
// What was not known to show must show by its box as well.
layout(constant_id = 2) const bool BOXES = true;
// It must not be hidden by how near its faces are at each texel either.
layout(constant_id = 3) const bool FRONTS = true;
layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
// What was drawn a step earlier, if it was due there.
layout(set = 0, binding = 1, scalar) readonly buffer Seen { uint items[]; } seen;
layout(set = 0, binding = 2, scalar) readonly buffer Reach { uint items[]; } reach;
layout(set = 0, binding = 3, scalar) readonly buffer Views { StepView items[]; } views;
layout(set = 0, binding = 4, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 5, scalar) readonly buffer Pyramid { float items[]; } pyramid;
layout(set = 0, binding = 6, scalar) readonly buffer Blocks { uint words[]; } blocks;
// By object, of listed blocks only: STEP_*.
layout(set = 0, binding = 7, scalar) writeonly buffer Shown { uint items[]; } shown;
// By kind of primitive and place in the list.
layout(set = 0, binding = 8, scalar) buffer Counts { uint items[]; } counts;
// What is known to show: seen, or drawn since who is seen was found out.
layout(set = 0, binding = 9, scalar) readonly buffer Known { uint items[]; } known;
layout(push_constant, scalar) uniform Push { uint step; } push;
#include "hidden.glsl"
#include "fronts.glsl"

void main() {
    uint place = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    StepView all = views.items[0];
    if (place >= blocks.words[3]) return;
    uint object = blocks.words[LISTED_HEADER + place] * BLOCK_OBJECTS + gl_LocalInvocationID.x;
    if (object >= all.object_count) return;
    Bounds bound = bounds.items[object];
    float begin = (bound.flags & OBJECT_ALWAYS_KEPT) != 0u ? 0.0
        : begin_of_box(bound, all.depth_plane, all.view.camera_high, all.view.camera_low);
    float nearest = nearest_begin(reach.items[1]);
    uint range = range_of(begin - nearest, uintBitsToFloat(reach.items[0]) - nearest, all.range_count, all.share);
    bool is_due = push.step == range + (seen.items[object] != 0u ? 0u : 1u);
    bool is_shown = false;
    if (is_due && BEHIND) is_shown = is_visible(bound, all.view, all.coarsest_level);
    else if (is_due) is_shown = (bound.flags & OBJECT_ALWAYS_KEPT) != 0u || !left_out(clip_from_bounds(bound, all.view), bound.flags, all.view);
    bool is_asked = BEHIND && is_shown && known.items[object] == 0u && (bound.flags & OBJECT_ALWAYS_KEPT) == 0u;
    if (FRONTS && is_asked) is_shown = !hidden_by_fronts(bound, all.view, all.coarsest_level);
    // A box that reaches the near plane cannot be rasterised.
    bool is_tested = BOXES && is_asked && is_shown && !crosses_near(clip_from_bounds(grown(bound, all.view), all.view));
    shown.items[object] = !is_shown ? STEP_HIDDEN : is_tested ? STEP_TESTED : STEP_SHOWN;
    if (is_shown) atomicAdd(counts.items[kind_of(object, all) * all.block_count + place], 1u);
}
