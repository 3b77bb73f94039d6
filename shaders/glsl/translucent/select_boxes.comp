// translucent/select_boxes: which translucent objects lie in the view volume, and which of those must prove by their box that they
// are hidden by what has been drawn? TEST_BOXES off: none must. The list's order is that of atomics, and does not show: its boxes
// only set flags. Twin: culling/src/translucent/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "select.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool TEST_BOXES = true;
layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
// By object.
layout(set = 0, binding = 1, scalar) writeonly buffer Shown { uint items[]; } shown;
layout(set = 0, binding = 2, scalar) writeonly buffer Listed { uint items[]; } listed;
// The draw of the listed boxes, one instance each.
layout(set = 0, binding = 3, scalar) buffer Boxes { DrawCommand items[]; } boxes;
layout(push_constant, scalar) uniform Push { CullView view; uint first_object; uint object_count; } push;

void main() {
    uint index = invocation_index();
    if (index >= push.object_count) return;
    uint object = push.first_object + index;
    uint selected = selection(bounds.items[object], false, push.view);
    bool tested = TEST_BOXES && selected == SELECT_TESTED;
    shown.items[object] = !tested && selected != SELECT_NONE ? 1u : 0u;
    if (tested) listed.items[atomicAdd(boxes.items[0].instance_count, 1u)] = object;
}
