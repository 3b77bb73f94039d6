// draw/owners: the item buffer of a picture of several samples a pixel: the bytes of whose each sample is. For the truth, never in timed frames.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PASS_ITEM
#include "shade.glsl"
