// Depth buffers as stages see them: reversed, 1 near and 0 far.
#ifndef DEPTH_GLSL
#define DEPTH_GLSL
// The buffer keeps standard depth, 0 near: only where depth formats are studied.
layout(constant_id = 8) const bool STANDARD_DEPTH = false;

float reversed(float kept) {
    return STANDARD_DEPTH ? 1.0 - kept : kept;
}
#endif
