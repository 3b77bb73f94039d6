// draw/objects_and_flags: draw/objects that flags each object with a fragment that passes the early tests: colour, depth and
// visibility in one pass (EOVC thesis III.2).
#version 460
#extension GL_GOOGLE_include_directive : require
#define PASS_ITEM
#include "shade.glsl"
