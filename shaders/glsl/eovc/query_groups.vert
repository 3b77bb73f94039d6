// eovc/query_groups: the boxes of occludee groups against the depth of the effective occluders; where one is open, a ray is
// cast into the group (EOVC thesis III.4, figures 6 to 8). No colour, no depth is written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Nodes { TreeNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Groups { uint items[]; } groups;
layout(set = 0, binding = 2, scalar) readonly buffer ViewBlock { BoxView items[]; } views;

layout(location = 0) flat out uint group;
layout(location = 1) flat out float nearest;    // depth that nothing in the group exceeds

invariant gl_Position;

void main() {
    group = groups.items[gl_InstanceIndex];
    BoxView box_view = views.items[0];
    CullView view = box_view.view;
    Bounds bound = grown(nodes.items[group].bounds, view);
    ClipBox box = clip_from_bounds(bound, view);
    float w_min = box.centre.w - abs(box.axis_x.w) - abs(box.axis_y.w) - abs(box.axis_z.w) - box.error.w;
    nearest = min(farthest_along(box, vec4(0.0, 0.0, 1.0, 0.0)) / max(w_min, 1.0e-30), 1.0);
    vec3 centre = relative_from_split(bound.centre_high, bound.centre_low, view.camera_high, view.camera_low);
    vec3 corner = near_faces_corner(centre, bound.half_extent, box_view.eye, uint(gl_VertexIndex));
    gl_Position = view.clip_from_relative * vec4(corner, 1.0);
}
