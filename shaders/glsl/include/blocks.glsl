// Blocks of objects that lie side by side, of which a stage looks only at those in view: a work group a block. The stage declares
// `blocks` before it includes this: a grid of three words, folded at 65,535 work groups, the number of blocks listed, and they.
#ifndef BLOCKS_GLSL
#define BLOCKS_GLSL
#include "types.glsl"

const uint MOST_BLOCKS_ACROSS = 65535u;

// The object of this invocation; none (beyond all objects) if the folded grid has more work groups than there are blocks.
// A macro for the reason given in grid.glsl.
#define object_in_view() \
    (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x < blocks.words[3] \
        ? blocks.words[4u + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] * BLOCK_OBJECTS + gl_LocalInvocationID.x \
        : 0xffffffffu)
#endif
