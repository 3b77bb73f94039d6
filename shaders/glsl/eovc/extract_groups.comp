// eovc/extract_groups: a node that is not visible below one that is (or the root, if nothing is) is an occludee group. Groups
// outside the view volume are dropped (EOVC thesis III.3, figures 4 and 5). Some groups are opened, that is, their children
// stand in for them: those that reach the near plane, which cannot be rasterised (a leaf among them counts as hit); and, if
// COHERENT, those that a pixel of the last frame saw into, as rays would be cast there again, and large ones. Single objects go to a list of their own, as they need no ray. The lists' order does not show: they are drawn
// without colour or depth. Twin: culling/src/eovc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "footprint.glsl"
#include "box.glsl"

layout(local_size_x = 64) in;
// Open groups by what the last frame saw; false is the thesis.
layout(constant_id = 0) const bool COHERENT = true;
layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Marked { uint items[]; } marked;
layout(set = 0, binding = 2, scalar) writeonly buffer Groups { uint items[]; } groups;
layout(set = 0, binding = 3, scalar) buffer GroupCommand { DrawCommand items[]; } group_command;
layout(set = 0, binding = 4, scalar) writeonly buffer Singles { uint items[]; } singles;
layout(set = 0, binding = 5, scalar) buffer SingleCommand { DrawCommand items[]; } single_command;
layout(set = 0, binding = 6, scalar) writeonly buffer Hits { uint items[]; } hits;
layout(set = 0, binding = 7, scalar) buffer Tested { uint items[]; } tested;
layout(set = 0, binding = 8, scalar) readonly buffer Touched { uint items[]; } touched;
// frame counts from 2 on; most_pixels is what a group of which nothing is known may cover.
layout(push_constant, scalar) uniform Push { CullView view; uint node_count; uint frame; uint most_pixels; } push;

bool is_group(uint node) {
    if (marked.items[node] != 0u) return false;
    uint parent = nodes.items[node].parent;
    return parent == TREE_NONE || marked.items[parent] != 0u;
}

// Nodes of the tree in depth-first order below one node, without a stack: children lie side by side, so the way back is known.
uint next_after(uint node, uint root) {
    while (node != root) {
        uint parent = nodes.items[node].parent;
        if (node == nodes.items[parent].first_child) return node + 1u;
        node = parent;
    }
    return TREE_NONE;
}

// How many times more pixels a group may cover that the last frame found hidden: it is likely to be so again.
const uint TRUST_IN_HIDDEN = 16u;

bool covers_more_than(uint most_pixels, Bounds bounds, ClipBox box) {
    Footprint footprint = footprint_of(box, push.view, bounds.flags);
    uvec2 pixels = footprint.last - footprint.first + 1u;
    return pixels.x * pixels.y > most_pixels;
}

// Whether the last frame tells us to look at the children instead: rays would be cast for each open pixel.
bool should_open(uint node, Bounds bounds, ClipBox box) {
    if (!COHERENT) return false;
    uint last_frame = push.frame - 1u;
    if (touched.items[node] == last_frame) return true;
    bool hidden_before = tested.items[node] == last_frame;
    return covers_more_than(hidden_before ? push.most_pixels * TRUST_IN_HIDDEN : push.most_pixels, bounds, box);
}

void main() {
    uint root = invocation_index();
    if (root >= push.node_count || !is_group(root)) return;
    uint node = root;
    while (node != TREE_NONE) {
        TreeNode here = nodes.items[node];
        ClipBox box = clip_from_bounds(here.bounds, push.view);
        bool open = false;
        if (!outside_frustum(box, footprint_widening(here.bounds.flags, push.view))) {
            bool reaches_near = crosses_near(clip_from_bounds(grown(here.bounds, push.view), push.view));
            if (reaches_near && here.is_leaf != 0u) {
                hits.items[here.first_child] = 1u;
            } else if (here.is_leaf != 0u) {
                singles.items[atomicAdd(single_command.items[0].instance_count, 1u)] = node;
            } else if (reaches_near || should_open(node, here.bounds, box)) {
                open = true;
            } else {
                groups.items[atomicAdd(group_command.items[0].instance_count, 1u)] = node;
            }
            tested.items[node] = push.frame;
        }
        node = open ? here.first_child : next_after(node, root);
    }
}
