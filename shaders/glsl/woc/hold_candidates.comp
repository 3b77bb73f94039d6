// woc/hold_candidates: costly objects that the image-space test leaves visible are not drawn yet: their boxes are to prove that
// they show (Kim 2015, IV.2, hybrid occlusion query). A box that reaches the near plane cannot be rasterised: its object is
// drawn with the others. Twin: culling/src/woc/twin.rs
//
// One invocation, so that the boxes are listed in order: candidates are few.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0, scalar) readonly buffer Candidates { uint items[]; } candidates;
layout(set = 0, binding = 1, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
// By object: it is to be drawn.
layout(set = 0, binding = 2, scalar) buffer Shown { uint items[]; } shown;
layout(set = 0, binding = 3, scalar) writeonly buffer Listed { uint items[]; } listed;
layout(set = 0, binding = 4, scalar) writeonly buffer Command { DrawCommand items[]; } command;
layout(push_constant, scalar) uniform Push { CullView view; uint candidate_count; } push;

bool has_box(Bounds bound) {
    return (bound.flags & OBJECT_ALWAYS_KEPT) == 0u && !crosses_near(clip_from_bounds(grown(bound, push.view), push.view));
}

void main() {
    uint boxes = 0u;
    for (uint index = 0u; index < push.candidate_count; index++) {
        uint object = candidates.items[index];
        if (shown.items[object] != 0u && has_box(bounds.items[object])) {
            shown.items[object] = 0u;
            listed.items[boxes++] = object;
        }
    }
    command.items[0].instance_count = boxes;
}
