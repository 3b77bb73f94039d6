// draw/overdraw: one count a shaded fragment, added up. For pictures, never in timed frames.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "place.glsl"
