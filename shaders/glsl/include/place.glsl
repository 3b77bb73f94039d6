// The vertex work of stages that shade nothing: the place alone, by the same arithmetic as draw/objects, so that they touch
// the same pixels at the same depths.
#ifndef PLACE_GLSL
#define PLACE_GLSL
#include "instance.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 normal_snorm16;    // octahedral; not used

layout(push_constant, scalar) uniform Push { View view; } push;

invariant gl_Position;

void main() {
    Object object = drawn_object();
    gl_Position = clip_from_object(object, position, push.view.clip_from_relative, push.view.camera_high, push.view.camera_low);
    gl_PointSize = 1.0;
}
#endif
