// pack/scan_counts: where does each chunk's first command go? One subgroup walks a list's chunk counts in strides and writes
// their exclusive prefix sum, then the total; each work group does one list. Deliberately one subgroup a list: it needs no
// barrier and no look-back (both fail or cost 20 times more on a CPU device), and with PACK_CHUNK objects a chunk it is 19,532
// strides at 10^7 objects and 8 lanes, far under the 65,535 iterations after which lavapipe ends a loop without a word. Second
// of three steps of the ordered packing. Twin: culling/src/pack/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "types.glsl"

// The engine sets both to the device's subgroup size.
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SUBGROUP_SIZE = 8u;
#include "lanes.glsl"

// By list and chunk; totals by list.
layout(set = 0, binding = 0, scalar) readonly buffer Counts { uint items[]; } counts;
layout(set = 0, binding = 1, scalar) writeonly buffer Starts { uint items[]; } starts;
layout(set = 0, binding = 2, scalar) writeonly buffer Total { uint items[]; } total;
layout(push_constant, scalar) uniform Push { uint chunk_count; } push;

void main() {
    if (gl_SubgroupID != 0u) return;
    uint lane = own_lane();
    uint lanes = all_lanes();
    uint list = gl_WorkGroupID.x;
    uint before = 0u;
    for (uint first = 0u; first < push.chunk_count; first += lanes) {
        uint chunk = first + lane;
        uint place = list * push.chunk_count + chunk;
        uint flagged = chunk < push.chunk_count ? counts.items[place] : 0u;
        uint start = before + subgroupExclusiveAdd(flagged);
        if (chunk < push.chunk_count) starts.items[place] = start;
        before += subgroupAdd(flagged);
    }
    if (lane == 0u) total.items[list] = before;
}
