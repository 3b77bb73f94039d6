// draw/masked: the colour, where there is something. No early tests: they would write the depth of what is not there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "surface.glsl"

layout(location = 0) out vec4 colour;

void main() {
    colour = surface_colour();
    if (!is_there(colour)) discard;
}
