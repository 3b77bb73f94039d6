// eovc/cast_rays: from an open pixel of a group's box a ray goes through the group's part of the hierarchy and flags every
// leaf it meets before the depth buffer does. A node below which all is hit stops later rays (EOVC thesis III.4, figure 8).
// The nodes that a ray meets are touched: the next frame opens them instead of casting rays there again.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "ray.glsl"
#include "depth.glsl"
layout(early_fragment_tests) in;
// Count rays, node visits and rays stopped early: for tables, never in timed frames.
layout(constant_id = 0) const bool COUNT = false;
// What is small on the screen is left out: otherwise rays need not ask.
layout(constant_id = 1) const bool DETAIL = false;

layout(location = 0) flat in uint group;
layout(location = 1) flat in float nearest;

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;
layout(set = 0, binding = 3, scalar) buffer Full { uint items[]; } full;
layout(set = 0, binding = 4, scalar) buffer Hits { uint items[]; } hits;
layout(set = 0, binding = 5, scalar) buffer Counters { uint items[]; } counters;
layout(set = 0, binding = 6) uniform texture2D depth;
layout(set = 0, binding = 7, scalar) buffer Touched { uint items[]; } touched;
layout(push_constant, scalar) uniform Push { uint frame; } push;
#include "touch.glsl"

// A leaf is hit: so is every node above it both of whose children are. Two rays that meet at a sibling may both miss that it
// is: later rays then go on for longer, and flag the same.
void note_hit(uint leaf, uint object) {
    hits.items[object] = 1u;
    uint node = leaf;
    while (true) {
        full.items[node] = push.frame;
        if (node == group) return;
        uint parent = nodes.items[node].parent;
        uint first = nodes.items[parent].first_child;
        uint sibling = node == first ? first + 1u : first;
        if (full.items[sibling] != push.frame) return;
        node = parent;
    }
}

uint next_after(uint node) {
    while (node != group) {
        uint parent = nodes.items[node].parent;
        if (node == nodes.items[parent].first_child) return node + 1u;
        node = parent;
    }
    return TREE_NONE;
}

void main() {
    if (!lives(group)) return;
    if (full.items[group] == push.frame) {
        if (COUNT) atomicAdd(counters.items[2], 1u);
        return;
    }
    TreeNode root = nodes.items[group];
    BoxView box_view = views.items[0];
    CullView view = box_view.view;
    float open_to = reversed(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r);
    // What an object's own depth may be rounded down by, at most that of the group's nearest point.
    float open_from = max(open_to - DEPTH_ROUNDING * nearest, 0.0);
    Ray ray = ray_through(gl_FragCoord.xy, open_from, box_view);
    // No point of the group is farther along the ray than this, as |direction| is at least what a unit of distance takes.
    vec3 centre = relative_from_split(root.bounds.centre_high, root.bounds.centre_low, view.camera_high, view.camera_low);
    float reach = (length(centre - ray.origin) + 2.0 * length(root.bounds.half_extent)) / length(ray.direction);
    float far_end = min(ray.last, reach);
    ray.last = far_end * (1.0 + 1.0 / 65536.0);
    float w_far = abs(dot(vec4(ray.origin + ray.direction * far_end, 1.0), vec4(view.clip_from_relative[0].w,
        view.clip_from_relative[1].w, view.clip_from_relative[2].w, view.clip_from_relative[3].w)));
    float growth = 2.0 * pad_px(view, root.bounds.flags) * w_far / pixels_per_unit(view);
    uint visits = 0u;
    uint node = group;
    while (node != TREE_NONE) {
        visits++;
        TreeNode here = nodes.items[node];
        bool descend = full.items[node] != push.frame && meets(ray, here.bounds, view, growth);
        if (DETAIL) descend = descend && !too_small(clip_from_bounds(here.bounds, view), view);
        if (descend) touched.items[node] = push.frame;
        if (descend && here.is_leaf != 0u) {
            note_hit(node, here.first_child);
            descend = false;
        }
        node = descend ? here.first_child : next_after(node);
    }
    if (COUNT) {
        atomicAdd(counters.items[0], 1u);
        atomicAdd(counters.items[1], visits);
    }
}
