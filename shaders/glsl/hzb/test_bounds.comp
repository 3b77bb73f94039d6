// hzb/test_bounds: which objects does the farthest-depth pyramid not hide? Those not drawn yet are drawn now; all of them
// are drawn first in the next frame (Haar & Aaltonen 2015). Twin: culling/src/hzb/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "footprint.glsl"
#include "pyramid.glsl"

layout(local_size_x = 64) in;
// How many texels a footprint may touch in each direction before a coarser level is taken: more is tighter and slower.
layout(constant_id = 0) const uint FOOTPRINT_TEXELS = 4u;

layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) readonly buffer Levels { PyramidLevel items[]; } levels;
layout(set = 0, binding = 2, scalar) readonly buffer Pyramid { float items[]; } pyramid;
// By object: the last frame saw it, and this one does.
layout(set = 0, binding = 3, scalar) readonly buffer SeenBefore { uint items[]; } seen_before;
layout(set = 0, binding = 6, scalar) writeonly buffer Seen { uint items[]; } seen;
layout(set = 0, binding = 4, scalar) writeonly buffer Newly { uint items[]; } newly;
// The blocks in view; of the objects of others nothing is written.
layout(set = 0, binding = 5, scalar) readonly buffer Blocks { uint words[]; } blocks;
layout(push_constant, scalar) uniform Push { CullView view; uint object_count; uint coarsest_level; } push;
#include "blocks.glsl"

#include "hidden.glsl"

void main() {
    uint object = object_in_view();
    if (object >= push.object_count) return;
    bool visible = is_visible(bounds.items[object], push.view, push.coarsest_level);
    newly.items[object] = visible && seen_before.items[object] == 0u ? 1u : 0u;
    seen.items[object] = visible ? 1u : 0u;
}
