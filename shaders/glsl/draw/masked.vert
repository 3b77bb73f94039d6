// draw/masked: objects that are not there where their alpha is low. Depth is written late, by what is left.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DETAIL
#include "shade.glsl"
