// The finest level of the farthest-depth pyramid that is kept, 1 to REDUCED_LEVELS: tests begin there.
#ifndef FINEST_GLSL
#define FINEST_GLSL
layout(constant_id = 7) const uint FINEST_LEVEL = 1u;
#endif
