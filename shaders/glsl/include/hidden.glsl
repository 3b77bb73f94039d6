// What the farthest-depth pyramid hides. The stage declares `pyramid`, `levels` and FOOTPRINT_TEXELS before it includes this.
#ifndef HIDDEN_GLSL
#define HIDDEN_GLSL
#include "finest.glsl"

// True if every texel that the footprint touches is nearer than the box can be.
bool hidden_by_pyramid(Footprint footprint, uint coarsest_level) {
    uint level = FINEST_LEVEL;
    while (level < coarsest_level
        && any(greaterThanEqual((footprint.last >> level) - (footprint.first >> level), uvec2(FOOTPRINT_TEXELS)))) level++;
    PyramidLevel texels = levels.items[level];
    uvec2 first = footprint.first >> level;
    uvec2 last = footprint.last >> level;
    for (uint y = first.y; y <= last.y; y++) {
        for (uint x = first.x; x <= last.x; x++) {
            if (footprint.nearest >= pyramid.items[texels.first + y * texels.width + x]) return false;
        }
    }
    return true;
}

bool is_visible(Bounds bound, CullView view, uint coarsest_level) {
    if ((bound.flags & OBJECT_ALWAYS_KEPT) != 0u) return true;
    ClipBox box = clip_from_bounds(bound, view);
    if (left_out(box, bound.flags, view)) return false;
    Footprint footprint = footprint_of(box, view, bound.flags);
    if (footprint.crosses_near) return true;
    return !footprint.empty && !hidden_by_pyramid(footprint, coarsest_level);
}
#endif
