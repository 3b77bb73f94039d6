// The lanes that do a prefix sum. The work group is meant to be one full subgroup of SUBGROUP_SIZE, which the stage declares before it
// includes this, and where the engine can ask for that it is. Elsewhere a device may make several subgroups of the group, or one that
// is wider than it: the first subgroup does all the work, with as many lanes as there are.
#ifndef LANES_GLSL
#define LANES_GLSL

uint all_lanes() {
    return gl_NumSubgroups == 1u ? SUBGROUP_SIZE : subgroupAdd(1u);
}

uint own_lane() {
    return subgroupExclusiveAdd(1u);
}
#endif
