// hzb/list_blocks: the blocks that are due, in order, with the grids to look at them. One subgroup walks all blocks in strides, as
// pack/scan_counts does and for its reasons: 3,907 strides at 2 million objects and 8 lanes. (hzb-iterative.)
// Twin: culling/src/hzb/iterative/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "steps.glsl"

// The engine sets both to the device's subgroup size.
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SUBGROUP_SIZE = 8u;
#include "lanes.glsl"
layout(set = 0, binding = 0, scalar) readonly buffer Due { uint items[]; } due;
layout(set = 0, binding = 1, scalar) writeonly buffer Blocks { uint words[]; } blocks;
// By kind of primitive and place in the list: how many objects are drawn. Set to 0 here, counted by the next stage.
layout(set = 0, binding = 2, scalar) writeonly buffer Counts { uint items[]; } counts;
layout(push_constant, scalar) uniform Push { uint block_count; uint kind_count; } push;

void main() {
    if (gl_SubgroupID != 0u) return;
    uint lane = own_lane();
    uint lanes = all_lanes();
    uint before = 0u;
    for (uint first = 0u; first < push.block_count; first += lanes) {
        uint block = first + lane;
        uint listed = block < push.block_count ? due.items[block] : 0u;
        uint place = before + subgroupExclusiveAdd(listed);
        if (listed != 0u) {
            blocks.words[LISTED_HEADER + place] = block;
            for (uint kind = 0u; kind < push.kind_count; kind++) counts.items[kind * push.block_count + place] = 0u;
        }
        before += subgroupAdd(listed);
    }
    if (lane != 0u) return;
    blocks.words[0] = min(before, MOST_BLOCKS_ACROSS);
    blocks.words[1] = (before + MOST_BLOCKS_ACROSS - 1u) / MOST_BLOCKS_ACROSS;
    blocks.words[2] = 1u;
    blocks.words[3] = before;
    blocks.words[LISTED_GRID] = (before + 63u) / 64u;
    blocks.words[LISTED_GRID + 1u] = 1u;
    blocks.words[LISTED_GRID + 2u] = 1u;
}
