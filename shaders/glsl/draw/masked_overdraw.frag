// draw/masked_overdraw: adds one where there is something.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "surface.glsl"

layout(location = 0) out vec4 count;

void main() {
    if (!is_there(surface_colour())) discard;
    count = vec4(1.0);
}
