// draw/masked_flags: a flag for the object, where there is something. Occluded fragments stop before this shader.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(early_fragment_tests) in;
#define PASS_ITEM
#include "surface.glsl"

layout(set = 0, binding = 3, scalar) writeonly buffer Visible { uint items[]; } visible;

void main() {
    if (is_there(surface_colour())) visible.items[item] = 1u;
}
