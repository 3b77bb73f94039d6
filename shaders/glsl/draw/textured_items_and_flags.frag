// draw/textured_items_and_flags: the colour, who owns the pixel, and a flag for the object.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(early_fragment_tests) in;
#define PASS_ITEM
#include "surface.glsl"

layout(set = 0, binding = 3, scalar) writeonly buffer Visible { uint items[]; } visible;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint owner;

void main() {
    colour = surface_colour();
    owner = item;
    // A plain store: every writer writes the same, and an atomic costs 20 times as much.
    visible.items[item] = 1u;
}
