// draw/masked_overdraw: one count a fragment that draw/masked shades and keeps. For pictures, never in timed frames.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DETAIL
#include "shade.glsl"
