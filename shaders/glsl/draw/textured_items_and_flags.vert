// draw/textured_items_and_flags: draw/textured_and_flags with the item buffer beside the colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DETAIL
#define PASS_ITEM
#include "shade.glsl"
