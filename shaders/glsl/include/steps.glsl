// hzb-iterative: what its stages share. Blocks of objects are looked at step by step, near to far; those of a step are listed in
// order, so that commands are as well.
#ifndef STEPS_GLSL
#define STEPS_GLSL
#include "blocks.glsl"
#include "ranges.glsl"

// At most so many depth ranges; there is one step more.
const uint MOST_STEP_RANGES = 5u;
// At most so many kinds of draw, by primitive, surface and sides: each has a draw of its own.
const uint MOST_KINDS = 8u;
const uint LATER_KINDS = MOST_KINDS - 1u;

// A list of blocks, then: its first words are a grid of a work group a block, and their number; then a grid of an invocation a block.
const uint LISTED_GRID = 4u;
const uint LISTED_HEADER = 8u;

// Where the objects of a block lie along the view, metres. Out of view, or known to be hidden: it ends before it begins.
struct BlockSpan {
    float begin;
    float end;
};

// What a frame's steps look through: more than push constants hold.
struct StepView {
    CullView view;
    vec4 depth_plane;       // see ranges.glsl
    uint object_count;
    uint block_count;
    uint coarsest_level;    // of the pyramid
    uint range_count;       // 1 to MOST_STEP_RANGES
    float share;            // where a range ends, as a share of where the next one does
    uint later_kinds[LATER_KINDS];  // the first object of the second kind, the third and so on; beyond all objects if there is none
};

// Where the nearest block in view begins, from its inverted bits: ranges are counted from there, as what a view from above sees, say,
// begins far from the eye. Differences keep the order of depths, so that an object stays in the ranges of its block.
float nearest_begin(uint inverted) {
    return uintBitsToFloat(~inverted);
}

// What becomes of an object in a step.
const uint STEP_HIDDEN = 0u;    // not due, or not seen: nothing
const uint STEP_SHOWN = 1u;     // drawn
const uint STEP_TESTED = 2u;    // drawn if its box, rasterised, shows
#endif
