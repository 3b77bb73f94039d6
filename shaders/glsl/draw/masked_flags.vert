// draw/masked_flags: flags each masked object that shows, once draw/masked has drawn it. A stage that discards has no early tests, and would flag
// what is occluded too; depth is only tested here, so that early tests do no harm.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DETAIL
#define PASS_ITEM
#include "shade.glsl"
