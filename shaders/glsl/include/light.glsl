// Towards the light that surfaces are shaded by: a direction, of length 1 within 3e-4.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL
const float LIGHT_X = 0.40;
const float LIGHT_Y = 0.82;
const float LIGHT_Z = 0.41;
#endif
