// roc/select_boxes: which objects must prove by their box that they are hidden? All in the view volume that were not drawn
// first. A box that reaches the near plane cannot be rasterised: its object counts as visible (EOVC thesis II.2, ROC;
// Kubisch & Tavenrath 2014). Twin: culling/src/roc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "select.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) readonly buffer Drawn { uint items[]; } drawn;
layout(set = 0, binding = 2, scalar) writeonly buffer Boxes { uint items[]; } boxes;
layout(set = 0, binding = 3, scalar) writeonly buffer Newly { uint items[]; } newly;
layout(push_constant, scalar) uniform Push { CullView view; uint object_count; } push;

void main() {
    uint object = invocation_index();
    if (object >= push.object_count) return;
    uint selected = selection(bounds.items[object], drawn.items[object] != 0u, push.view);
    boxes.items[object] = selected == SELECT_TESTED ? 1u : 0u;
    newly.items[object] = selected == SELECT_SHOWN ? 1u : 0u;
}
