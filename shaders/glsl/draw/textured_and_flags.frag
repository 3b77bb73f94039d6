// draw/textured_and_flags: the colour, and a flag for the object. Occluded fragments stop before this shader.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(early_fragment_tests) in;
#define PASS_ITEM
#include "surface.glsl"

layout(set = 0, binding = 3, scalar) writeonly buffer Visible { uint items[]; } visible;

layout(location = 0) out vec4 colour;

void main() {
    colour = surface_colour();
    // A plain store: every writer writes the same, and an atomic costs 20 times as much.
    visible.items[item] = 1u;
}
