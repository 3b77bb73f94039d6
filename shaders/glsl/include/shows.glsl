// What the depth test of an occlusion query lets pass.
#ifndef SHOWS_GLSL
#define SHOWS_GLSL
#include "depth.glsl"

// True if a fragment at the light's depth passes the depth test against what is kept. Compared as it is kept: that is how the test does.
bool shows(float kept, float light) {
    return STANDARD_DEPTH ? 1.0 - light <= kept : light >= kept;
}
#endif
