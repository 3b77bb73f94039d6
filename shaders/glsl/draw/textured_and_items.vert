// draw/textured_and_items: draw/textured with the item buffer beside the colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DETAIL
#define PASS_ITEM
#include "shade.glsl"
