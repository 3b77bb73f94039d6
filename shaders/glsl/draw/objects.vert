// draw/objects: every drawn object, Lambert-shaded, with early fragment tests.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shade.glsl"
