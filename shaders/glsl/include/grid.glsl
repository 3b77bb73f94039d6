// The number of this invocation in a grid that the engine folded into two dimensions: one dimension ends at 65,535 groups.
#ifndef GRID_GLSL
#define GRID_GLSL
// A macro, because a function that stands before the stage's `layout(local_size_x = ...)` takes gl_WorkGroupSize as 1.
#define invocation_index() (gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x)
#endif
