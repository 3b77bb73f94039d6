// frustum/test_blocks: which blocks of objects that lie side by side are not outside the view volume? Only objects of those need
// tests of their own: a hierarchy of one level, in the order that the scene came in. The blocks are listed in the order of
// atomics, which nothing shows: later stages write by object. Twin: culling/src/frustum/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "cull.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer BlockBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) buffer Blocks { uint words[]; } blocks;
layout(push_constant, scalar) uniform Push { CullView view; uint block_count; } push;
#include "blocks.glsl"

void main() {
    uint block = invocation_index();
    if (block >= push.block_count) return;
    Bounds bound = bounds.items[block];
    if ((bound.flags & OBJECT_ALWAYS_KEPT) == 0u
        && outside_frustum(clip_from_bounds(bound, push.view), footprint_widening(bound.flags, push.view))) return;
    uint slot = atomicAdd(blocks.words[3], 1u);
    blocks.words[4u + slot] = block;
    atomicMax(blocks.words[0], min(slot + 1u, MOST_BLOCKS_ACROSS));
    atomicMax(blocks.words[1], slot / MOST_BLOCKS_ACROSS + 1u);
}
