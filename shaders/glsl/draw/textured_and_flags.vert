// draw/textured_and_flags: draw/textured that flags each object with a fragment that passes the early tests.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DETAIL
#define PASS_ITEM
#include "shade.glsl"
