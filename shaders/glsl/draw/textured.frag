// draw/textured: the colour. Occluded fragments stop before this shader.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(early_fragment_tests) in;
#include "surface.glsl"

layout(location = 0) out vec4 colour;

void main() {
    colour = surface_colour();
}
