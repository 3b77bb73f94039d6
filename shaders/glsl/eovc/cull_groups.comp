// eovc/cull_groups: groups outside the view volume are dropped (EOVC thesis III.3, figure 5). Some groups are opened, that is,
// their children stand in for them: those that reach the near plane, which cannot be rasterised, or farther than f32 can be
// trusted with (a leaf among them counts as hit); those with too many objects for a ray; and, if COHERENT, those that a pixel of a recent frame saw into, as rays would
// be cast there again. (Of the last frame alone will not do: where a group's box shows but no box in it does, the group would
// be opened, seen hidden, closed, and rays cast into it every other frame.) Single objects go to a list of their own, as they need no ray. Without any occluder depth is empty, and
// rays would meet all there is: every object in the view volume is hit. The lists' order does not show: they are drawn without
// colour or depth. A pass goes down CULL_LEVELS levels and lists what it leaves open for the next, so that no invocation walks
// far. Twin: culling/src/eovc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "box.glsl"

layout(local_size_x = 64) in;
// Open groups by what earlier frames saw; false is the thesis.
layout(constant_id = 0) const bool COHERENT = true;
layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Starts { uint items[]; } starts;
layout(set = 0, binding = 2, scalar) writeonly buffer Unfinished { uint items[]; } unfinished;
layout(set = 0, binding = 3, scalar) buffer Grids { uint items[]; } grids;
layout(set = 0, binding = 4, scalar) writeonly buffer Groups { uint items[]; } groups;
layout(set = 0, binding = 5, scalar) buffer GroupCommand { DrawCommand items[]; } group_command;
layout(set = 0, binding = 6, scalar) writeonly buffer Singles { uint items[]; } singles;
layout(set = 0, binding = 7, scalar) buffer SingleCommand { DrawCommand items[]; } single_command;
layout(set = 0, binding = 8, scalar) writeonly buffer Hits { uint items[]; } hits;
layout(set = 0, binding = 9, scalar) readonly buffer Touched { uint items[]; } touched;
// frame counts from 2 OPEN_FRAMES on, so that 0 is long ago; list is where the pass starts.
layout(push_constant, scalar) uniform Push { CullView view; uint frame; uint list; } push;
#include "list.glsl"

// Puts a node where it belongs; true if it is to be opened.
bool sort_out(uint node, TreeNode here) {
    ClipBox box = clip_from_bounds(here.bounds, push.view);
    bool kept = (here.bounds.flags & OBJECT_ALWAYS_KEPT) != 0u;
    if (!kept && left_out(box, here.bounds.flags, push.view)) return false;
    bool nothing_hides = length_of(MARKED_LIST) == 0u;
    bool reaches_near = kept || crosses_near(clip_from_bounds(grown(here.bounds, push.view), push.view));
    if (here.is_leaf != 0u) {
        if (reaches_near || nothing_hides) hits.items[here.first_child] = 1u;
        else singles.items[atomicAdd(single_command.items[0].instance_count, 1u)] = node;
        return false;
    }
    bool seen_into = COHERENT && push.frame - touched.items[node] <= OPEN_FRAMES + node % OPEN_FRAMES;
    if (reaches_near || nothing_hides || here.object_count > RAY_OBJECTS || seen_into) return true;
    groups.items[atomicAdd(group_command.items[0].instance_count, 1u)] = node;
    return false;
}

void main() {
    uint place = invocation_index();
    if (place >= length_of(push.list)) return;
    uint start = starts.items[place];
    uint node = start;
    uint level = 0u;
    while (node != TREE_NONE) {
        TreeNode here = nodes.items[node];
        bool open = sort_out(node, here);
        if (open && level + 1u < CULL_LEVELS) {
            node = here.first_child;
            level++;
            continue;
        }
        if (open) {
            unfinished.items[append_to(push.list + 1u)] = here.first_child;
            unfinished.items[append_to(push.list + 1u)] = here.first_child + 1u;
        }
        // Children lie side by side, so the way on is known without a stack.
        while (node != start && node != nodes.items[here.parent].first_child) {
            node = here.parent;
            here = nodes.items[node];
            level--;
        }
        node = node == start ? TREE_NONE : node + 1u;
    }
}
