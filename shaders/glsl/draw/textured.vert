// draw/textured: draw/objects with base colour textures and vertex colours, with early fragment tests.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DETAIL
#include "shade.glsl"
