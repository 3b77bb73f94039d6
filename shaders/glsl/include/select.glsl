// What raster occlusion culling does with an object in a frame, and where its box begins.
#ifndef SELECT_GLSL
#define SELECT_GLSL
#include "box.glsl"

const uint SELECT_NONE = 0u;    // out of view: nothing
const uint SELECT_SEEN = 1u;    // the last frame saw it: drawn first
const uint SELECT_TESTED = 2u;  // its box is tested, and decides
const uint SELECT_SHOWN = 3u;   // drawn without a test

// All in the view volume that were not drawn first must prove by their box that they are hidden. A box that reaches the near
// plane cannot be rasterised: its object counts as visible.
uint selection(Bounds bound, bool seen, CullView view) {
    if (seen) return SELECT_SEEN;
    if ((bound.flags & OBJECT_ALWAYS_KEPT) != 0u) return SELECT_SHOWN;
    if (left_out(clip_from_bounds(bound, view), bound.flags, view)) return SELECT_NONE;
    return crosses_near(clip_from_bounds(grown(bound, view), view)) ? SELECT_SHOWN : SELECT_TESTED;
}

// At most so many depth ranges.
const uint MOST_RANGES = 8u;
// In a word of `places`, the lowest bits hold the selection and the others the depth range.
const uint PLACE_RANGE_SHIFT = 2u;
const uint PLACE_SELECTION_MASK = 3u;
#endif
