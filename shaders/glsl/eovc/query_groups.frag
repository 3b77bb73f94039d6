// eovc/query_groups: a fragment of the box is open, so the group may show: the next stage casts rays into it. The group and
// what lies above it are touched, and the next frame opens them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "types.glsl"
layout(early_fragment_tests) in;

layout(location = 0) flat in uint group;

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 3, scalar) buffer Touched { uint items[]; } touched;
layout(set = 0, binding = 4, scalar) writeonly buffer OpenGroups { uint items[]; } open_groups;
layout(set = 0, binding = 5, scalar) buffer OpenCommand { DrawCommand items[]; } open_command;
layout(push_constant, scalar) uniform Push { uint frame; } push;
#include "touch.glsl"

void main() {
    // The first of many open fragments does it all; a plain look keeps the others from the atomic.
    if (!lives(group) || touched.items[group] == push.frame ||
        atomicExchange(touched.items[group], push.frame) == push.frame) return;
    open_groups.items[atomicAdd(open_command.items[0].instance_count, 1u)] = group;
    touch_above(group);
}
