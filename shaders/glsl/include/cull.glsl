// Bounds tests in clip space, rounded outward. Shared by every stage that asks where a box lies.
//
// Derivation of the rounding (rule 4 of DESIGN.md). u = 2^-24. A clip coordinate of a vertex is
//   fl( sum_j P_ij x_j + P_i3 ),  x = fl( fl(M p) + fl(origin - camera) ).
// Error of M p: in the box already (host, scenes::bounds). Error of the split difference: 2u |x| for each of box centre
// and vertex origin, as both high parts are multiples of their own ulp. Error of the sum for x: u |x|. Error of the
// matrix product: 3 roundings of products and 3 of sums, at most 4u (1 + small) sum_j |P_ij| |x_j| + |P_i3|, once for the
// vertex and once for the box. Rounding of P itself to f32 is the same for both and cancels. Together at most
// 13u sum_j |P_ij| |x_j|; we take 32u, which covers contraction to fma and reassociation by the compiler.
#ifndef CULL_GLSL
#define CULL_GLSL
#include "transform.glsl"

const float CLIP_ERROR = 32.0 / 16777216.0;

// Invocations that stride over a draw list in woc/find_rapid.
const uint RAPID_INVOCATIONS = 1024u;

// The vertex grid of a view, whose snap_px may have the reach of samples in it, and how far beside a sample the device takes its depth if it does.
// A grid has 1/16 pixel at most.
float grid_px(CullView view) {
    return view.snap_px >= SAMPLE_REACH_PX ? view.snap_px - SAMPLE_REACH_PX : view.snap_px;
}

struct ClipBox {
    vec4 centre;    // clip position of the box's centre
    vec4 axis_x;    // half extents, as clip vectors
    vec4 axis_y;
    vec4 axis_z;
    vec4 error;     // how far each clip coordinate of anything in the box may be off
};

ClipBox clip_from_bounds(Bounds bounds, CullView view) {
    vec3 centre = relative_from_split(bounds.centre_high, bounds.centre_low, view.camera_high, view.camera_low);
    mat4 clip = view.clip_from_relative;
    ClipBox box;
    box.axis_x = clip[0] * bounds.half_extent.x;
    box.axis_y = clip[1] * bounds.half_extent.y;
    box.axis_z = clip[2] * bounds.half_extent.z;
    box.centre = clip[0] * centre.x + clip[1] * centre.y + clip[2] * centre.z + clip[3];
    vec3 reach = abs(centre) + bounds.half_extent;
    box.error = CLIP_ERROR * (abs(clip[0]) * reach.x + abs(clip[1]) * reach.y + abs(clip[2]) * reach.z + abs(clip[3]));
    return box;
}

// The largest value that dot(plane, clip) takes over the box, rounded up: the p-vertex test.
float farthest_along(ClipBox box, vec4 plane) {
    return dot(plane, box.centre) + abs(dot(plane, box.axis_x)) + abs(dot(plane, box.axis_y)) + abs(dot(plane, box.axis_z))
        + dot(abs(plane), box.error);
}

// True if the box is wholly outside one plane of the view volume. `widen` is 1 plus how much of the half picture a
// footprint may reach beyond its geometry, for lines and points.
bool outside_frustum(ClipBox box, vec2 widen) {
    return farthest_along(box, vec4(1.0, 0.0, 0.0, widen.x)) < 0.0 || farthest_along(box, vec4(-1.0, 0.0, 0.0, widen.x)) < 0.0
        || farthest_along(box, vec4(0.0, 1.0, 0.0, widen.y)) < 0.0 || farthest_along(box, vec4(0.0, -1.0, 0.0, widen.y)) < 0.0
        || farthest_along(box, vec4(0.0, 0.0, 1.0, 0.0)) < 0.0 || farthest_along(box, vec4(0.0, 0.0, -1.0, 1.0)) < 0.0;
}

// True if all that the box may hold is smaller on the screen, in both directions, than is asked for: detail culling (Zachmann
// 2008). With c the centre, a the arms of the box by axis and w' the least w in it: |x/w - cx/cw| <= (ax + |cx/cw| aw) / w'.
// A box that reaches the eye's plane is large.
bool too_small(ClipBox box, CullView view) {
    vec4 arms = abs(box.axis_x) + abs(box.axis_y) + abs(box.axis_z) + box.error;
    float w_low = box.centre.w - arms.w;
    vec2 across = (arms.xy + abs(box.centre.xy / box.centre.w) * arms.w) / w_low * vec2(view.width_px, view.height_px);
    return w_low > 0.0 && max(across.x, across.y) < view.detail_px;
}

// How much of the half picture an object's footprint may reach beyond its geometry, plus one.
vec2 footprint_widening(uint flags, CullView view) {
    return (flags & OBJECT_WIDE_RASTER) != 0u ? vec2(1.0) + 2.0 / vec2(view.width_px, view.height_px) : vec2(1.0);
}

// True if nothing in the box is to be drawn, whatever hides it.
bool left_out(ClipBox box, uint flags, CullView view) {
    return outside_frustum(box, footprint_widening(flags, view)) || too_small(box, view);
}
#endif
