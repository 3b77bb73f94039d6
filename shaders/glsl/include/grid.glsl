// The number of this invocation in a grid that the engine folded into two dimensions: one dimension ends at 65,535 groups.
#ifndef GRID_GLSL
#define GRID_GLSL
uint invocation_index() {
    return gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
}
#endif
