// Lists that stages append to, and that a later dispatch walks with one invocation an entry. Their order is that of atomics,
// so it must not show. The stage declares `grids` before it includes this: GRID_WORDS words a list. The first three are the
// later dispatch's grid, folded at 65,535 work groups as grid.glsl unfolds it; the fourth is the list's length.
#ifndef LIST_GLSL
#define LIST_GLSL

// Work groups of every stage that walks a list.
const uint LIST_LOCAL_SIZE = 64u;
const uint MOST_GROUPS = 65535u;

// The slot for one more entry.
uint append_to(uint list) {
    uint first = list * GRID_WORDS;
    uint slot = atomicAdd(grids.items[first + 3u], 1u);
    uint group = slot / LIST_LOCAL_SIZE;
    atomicMax(grids.items[first], min(group + 1u, MOST_GROUPS));
    if (group >= MOST_GROUPS) atomicMax(grids.items[first + 1u], group / MOST_GROUPS + 1u);
    return slot;
}

uint length_of(uint list) {
    return grids.items[list * GRID_WORDS + 3u];
}
#endif
