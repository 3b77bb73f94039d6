// A box rasterised instead of what is in it: grown so that it covers every pixel, and lies before every depth, that anything
// inside can give.
//
// Derivation (rule 4 of DESIGN.md). A rasteriser evaluates coverage and depth of the true primitive at a point at most one
// grid step (snap_px in x and y, so 1.42 snap_px) from the pixel's centre: once for the object, once for the box's own faces.
// So the box must still cover what it contains after a shift of 2.83 snap_px on the screen; we take BOX_PAD_SNAPS = 4, plus a
// pixel for lines and points. A ball of radius r around a point at clip w projects to at least r f / w pixels in every
// direction, f being the smaller of half the picture's sides times the length of the matrix's x and y row, less what a change
// of w takes back, which halves it at most (|row_w| r < w / 2, as w > near > r for a box in front of the near plane). A box
// grown by r contains the ball around each of its points, so r = 2 pad w_max / f will do. The same shift argument holds for
// depth: at every shifted point the grown box has a point before each point of the object. Clip errors (cull.glsl) are far
// smaller: 32u w against 2 w / (64 f) for pictures up to 16,384 pixels.
// A rasteriser evaluates depth as a start value plus slopes times pixels. The slopes' rounding is a shift of less than 1e-4
// pixel, within what 4 snaps leave over 2.83. The start value's is DEPTH_ROUNDING of the nearest depth of the face, which at the
// far end of a long box can be more than the shift gives: depth changes there by |row_z - depth row_w| / w a unit, so the box
// grows by the quotient as well. (Found as a wall flush with the face of a group that reached from 2 m to 300 m.)
#ifndef BOX_GLSL
#define BOX_GLSL
#include "cull.glsl"

const float BOX_PAD_SNAPS = 4.0;
const float DEPTH_ROUNDING = 16.0 / 16777216.0;

// The least number of pixels that a step of one unit across the view moves a point at w = 1.
float pixels_per_unit(CullView view) {
    mat4 clip = view.clip_from_relative;
    vec3 row_x = vec3(clip[0].x, clip[1].x, clip[2].x);
    vec3 row_y = vec3(clip[0].y, clip[1].y, clip[2].y);
    return 0.5 * min(float(view.width_px) * length(row_x), float(view.height_px) * length(row_y));
}

float pad_px(CullView view, uint flags) {
    return BOX_PAD_SNAPS * grid_px(view) + ((flags & OBJECT_WIDE_RASTER) != 0u ? 1.0 : 0.0);
}

// How far a box must reach out for the rounding of its own faces' depth.
float depth_growth(ClipBox box, CullView view, float w_max) {
    mat4 clip = view.clip_from_relative;
    vec4 spread = abs(box.axis_x) + abs(box.axis_y) + abs(box.axis_z) + box.error;
    float nearest = min((box.centre.z + spread.z) / max(box.centre.w - spread.w, 1.0e-30), 1.0);
    float farthest = max((box.centre.z - spread.z) / w_max, 0.0);
    vec3 change = vec3(clip[0].z, clip[1].z, clip[2].z) - farthest * vec3(clip[0].w, clip[1].w, clip[2].w);
    return DEPTH_ROUNDING * nearest * w_max / max(length(change), 1.0e-30);
}

// How much a box must grow on every side.
float growth(ClipBox box, CullView view, uint flags) {
    float w_max = box.centre.w + abs(box.axis_x.w) + abs(box.axis_y.w) + abs(box.axis_z.w) + box.error.w;
    return 2.0 * pad_px(view, flags) * w_max / pixels_per_unit(view) + depth_growth(box, view, w_max);
}

Bounds grown(Bounds bounds, CullView view) {
    bounds.half_extent += vec3(growth(clip_from_bounds(bounds, view), view, bounds.flags));
    return bounds;
}

// True if the box, once grown, reaches in front of the near plane or behind the eye: it cannot be rasterised whole.
bool crosses_near(ClipBox box) {
    return farthest_along(box, vec4(0.0, 0.0, 1.0, -1.0)) > 0.0 || farthest_along(box, vec4(0.0, 0.0, 0.0, -1.0)) >= 0.0;
}

// Corner `corner` of the three faces that can face the eye: bit i set means the side away from the eye on axis i, so corner
// 0 is nearest and corner 7 never drawn. `eye` is the eye relative to the camera, w = 0 for a parallel projection.
vec3 near_faces_corner(vec3 centre, vec3 half_extent, vec4 eye, uint corner) {
    vec3 towards = mix(vec3(-1.0), vec3(1.0), greaterThanEqual(eye.xyz - centre * eye.w, vec3(0.0)));
    vec3 away = vec3((corner & 1u) != 0u, (corner & 2u) != 0u, (corner & 4u) != 0u);
    return centre + half_extent * towards * (1.0 - 2.0 * away);
}

// The clip position of such a corner of a box that has been grown.
vec4 clip_from_near_corner(Bounds bound, BoxView box_view, uint corner) {
    CullView view = box_view.view;
    vec3 centre = relative_from_split(bound.centre_high, bound.centre_low, view.camera_high, view.camera_low);
    return view.clip_from_relative * vec4(near_faces_corner(centre, bound.half_extent, box_view.eye, corner), 1.0);
}

// The clip position of such a corner of the grown box.
vec4 clip_from_grown_corner(Bounds bounds, BoxView box_view, uint corner) {
    return clip_from_near_corner(grown(bounds, box_view.view), box_view, corner);
}
#endif
