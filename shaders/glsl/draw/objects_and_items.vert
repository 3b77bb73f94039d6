// draw/objects_and_items: draw/objects with the item buffer beside the colour. For the truth and for methods that need it.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PASS_ITEM
#include "shade.glsl"
