// roc/test_boxes: the boxes of objects not drawn yet, against the depth of those that were. No colour, no depth is written
// (EOVC thesis II.2, ROC).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) readonly buffer Listed { uint items[]; } listed;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;

layout(location = 0) flat out uint object;

invariant gl_Position;

void main() {
    object = listed.items[gl_InstanceIndex];
    gl_Position = clip_from_grown_corner(bounds.items[object], views.items[0], uint(gl_VertexIndex));
}
