// draw/depth: every drawn object's depth and nothing else, the same to the bit as that of draw/objects: a depth prepass.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "place.glsl"
