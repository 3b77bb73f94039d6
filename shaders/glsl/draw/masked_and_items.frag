// draw/masked_and_items: the colour and who owns the pixel, where there is something.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PASS_ITEM
#include "surface.glsl"

layout(location = 0) out vec4 colour;
layout(location = 1) out uint owner;

void main() {
    colour = surface_colour();
    owner = item;
    if (!is_there(colour)) discard;
}
