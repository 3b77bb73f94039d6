// eovc/cast_rays: the boxes of those groups that are open, once more (EOVC thesis III.4, figure 7). No colour, no depth is
// written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer OpenGroups { uint items[]; } open_groups;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;

layout(location = 0) flat out uint group;
layout(location = 1) flat out float nearest;    // depth that nothing in the group exceeds

invariant gl_Position;

void main() {
    group = open_groups.items[gl_InstanceIndex];
    BoxView box_view = views.items[0];
    Bounds bound = grown(nodes.items[group].bounds, box_view.view);
    ClipBox box = clip_from_bounds(bound, box_view.view);
    float w_min = box.centre.w - abs(box.axis_x.w) - abs(box.axis_y.w) - abs(box.axis_z.w) - box.error.w;
    nearest = min(farthest_along(box, vec4(0.0, 0.0, 1.0, 0.0)) / max(w_min, 1.0e-30), 1.0);
    gl_Position = clip_from_near_corner(bound, box_view, uint(gl_VertexIndex));
}
