// draw/textured_and_items: the colour, and who owns the pixel. Occluded fragments stop before this shader.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(early_fragment_tests) in;
#define PASS_ITEM
#include "surface.glsl"

layout(location = 0) out vec4 colour;
layout(location = 1) out uint owner;

void main() {
    colour = surface_colour();
    owner = item;
}
