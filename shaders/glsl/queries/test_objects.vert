// queries/test_objects: the boxes of listed objects, counted by an occlusion query for each object, which may have several (GPU Gems
// 29.5.1): no colour, no depth is written (29.2). The boxes are grown to cover all that their objects can (include/box.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) readonly buffer Listed { uint items[]; } listed;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;

invariant gl_Position;

void main() {
    gl_Position = clip_from_grown_corner(bounds.items[listed.items[gl_InstanceIndex]], views.items[0], uint(gl_VertexIndex));
}
