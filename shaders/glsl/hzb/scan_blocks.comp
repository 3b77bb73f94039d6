// hzb/scan_blocks: where do the commands of each listed block begin, and how many are there? One subgroup walks one kind of primitive
// after the other, as pack/scan_counts does. Where there are none, the pyramid need not be reduced again. (hzb-iterative.) Twin: culling/src/hzb/iterative/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "steps.glsl"

// The engine sets both to the device's subgroup size.
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SUBGROUP_SIZE = 8u;
#include "lanes.glsl"
layout(set = 0, binding = 0, scalar) readonly buffer Blocks { uint words[]; } blocks;
layout(set = 0, binding = 1, scalar) readonly buffer Counts { uint items[]; } counts;
layout(set = 0, binding = 2, scalar) writeonly buffer Starts { uint items[]; } starts;
// By kind of primitive.
layout(set = 0, binding = 3, scalar) writeonly buffer Totals { uint items[]; } totals;
// By kind of primitive: the draw of boxes, one instance a command.
layout(set = 0, binding = 4, scalar) writeonly buffer Boxes { DrawCommand items[]; } boxes;
// Three words a reduction: the grid of one that is needed, and that of one that may not be.
layout(set = 0, binding = 5, scalar) readonly buffer FullGrids { uint items[]; } full_grids;
layout(set = 0, binding = 6, scalar) writeonly buffer Grids { uint items[]; } grids;
layout(push_constant, scalar) uniform Push { uint block_count; uint kind_count; uint reductions; } push;

void main() {
    if (gl_SubgroupID != 0u) return;
    uint lane = own_lane();
    uint lanes = all_lanes();
    uint listed = blocks.words[3];
    uint all = 0u;
    for (uint kind = 0u; kind < push.kind_count; kind++) {
        uint before = 0u;
        for (uint first = 0u; first < listed; first += lanes) {
            uint place = kind * push.block_count + first + lane;
            uint count = first + lane < listed ? counts.items[place] : 0u;
            uint start = before + subgroupExclusiveAdd(count);
            if (first + lane < listed) starts.items[place] = start;
            before += subgroupAdd(count);
        }
        all += before;
        if (lane != 0u) continue;
        totals.items[kind] = before;
        boxes.items[kind].instance_count = before;
    }
    if (lane != 0u) return;
    for (uint word = 0u; word < 3u * push.reductions; word++) grids.items[word] = all == 0u && word % 3u == 0u ? 0u : full_grids.items[word];
}
