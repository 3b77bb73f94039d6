// What else than a world box can be tested against the view volume: the sphere around it, and the box of the mesh as the object
// turns it. Both are rounded outward as cull.glsl rounds boxes.
//
// Derivation (rule 4 of DESIGN.md), u = 2^-24. A sphere around a box reaches r |row| along a plane, at least what the box does.
// Two lengths: division by the largest part (2.5 ulp, at most 5u), squares and their sum (2u under the root), the root (4.5 ulp, 9u)
// and a product are 17u each, their product one more: 35u of r |row|; we add SPHERE_ERROR = 64u of it. The row itself is a sum of
// products, 3u of sum_j |plane| |P_j| half_j, for which box.error has room: 13u of its 32u are used, and 8u for the dot products.
// An oriented box: its vertices are fl(M p) + origin, 3u + 3u of the sizes of the parts (the split difference is the same for both);
// its centre and its axes likewise, and each goes through the matrix, 4u: at most 20u of sum_j |P_j| (|origin| + sum |M| |p|)_j, and
// 8u for the dot products; we take ORIENTED_ERROR = 64u. M as it was uploaded is what both are made of, so its rounding cancels.
#ifndef SHAPE_GLSL
#define SHAPE_GLSL
#include "cull.glsl"

// What is tested: `frustum.test`.
const uint SHAPE_BOX = 0u;
const uint SHAPE_SPHERE = 1u;
const uint SHAPE_ORIENTED = 2u;
const uint SHAPE_SPHERE_BOX = 3u;

const float SPHERE_ERROR = 64.0 / 16777216.0;
const float ORIENTED_ERROR = 64.0 / 16777216.0;

// The box of a mesh in object space, rounded outward.
struct LocalBox {
    vec3 centre;
    vec3 half_extent;
};

vec4 frustum_plane(uint index, vec2 widen) {
    float turned = (index & 1u) == 0u ? 1.0 : -1.0;
    if (index < 2u) return vec4(turned, 0.0, 0.0, widen.x);
    if (index < 4u) return vec4(0.0, turned, 0.0, widen.y);
    return vec4(0.0, 0.0, turned, index == 4u ? 0.0 : 1.0);
}

// The length of a vector of any size that f32 holds: its squares may be none.
float length_of(vec3 vector) {
    float largest = max(max(abs(vector.x), abs(vector.y)), abs(vector.z));
    return largest > 0.0 ? largest * length(vector / largest) : 0.0;
}

// How far the sphere around a box reaches along a plane, rounded up.
float sphere_reach(vec3 half_extent, vec4 plane, CullView view) {
    mat4 clip = view.clip_from_relative;
    vec3 row = vec3(dot(plane, clip[0]), dot(plane, clip[1]), dot(plane, clip[2]));
    return length_of(half_extent) * length_of(row) * (1.0 + SPHERE_ERROR);
}

ClipBox clip_from_local(Object object, LocalBox local, CullView view) {
    vec3 origin = relative_from_split(object.origin_high, object.origin_low, view.camera_high, view.camera_low);
    mat4 clip = view.clip_from_relative;
    vec3 axis_x = object.column_x * local.half_extent.x;
    vec3 axis_y = object.column_y * local.half_extent.y;
    vec3 axis_z = object.column_z * local.half_extent.z;
    vec3 centre = object.column_x * local.centre.x + object.column_y * local.centre.y + object.column_z * local.centre.z + origin;
    ClipBox box;
    box.axis_x = clip[0] * axis_x.x + clip[1] * axis_x.y + clip[2] * axis_x.z;
    box.axis_y = clip[0] * axis_y.x + clip[1] * axis_y.y + clip[2] * axis_y.z;
    box.axis_z = clip[0] * axis_z.x + clip[1] * axis_z.y + clip[2] * axis_z.z;
    box.centre = clip[0] * centre.x + clip[1] * centre.y + clip[2] * centre.z + clip[3];
    vec3 size = abs(local.centre) + local.half_extent;
    vec3 reach = abs(origin) + abs(object.column_x) * size.x + abs(object.column_y) * size.y + abs(object.column_z) * size.z;
    box.error = ORIENTED_ERROR * (abs(clip[0]) * reach.x + abs(clip[1]) * reach.y + abs(clip[2]) * reach.z + abs(clip[3]));
    return box;
}

// True if a box is outside one of the planes. `planes` grows by how many it was tested against, one after the other.
bool outside_by_planes(ClipBox box, vec2 widen, inout uint planes) {
    bool outside = false;
    for (uint index = 0u; index < 6u; index++) {
        planes += outside ? 0u : 1u;
        outside = outside || farthest_along(box, frustum_plane(index, widen)) < 0.0;
    }
    return outside;
}

// The same of the sphere around a box. `inside`: it is inside all planes, whatever roundings did.
bool sphere_outside_by_planes(ClipBox box, vec3 half_extent, vec2 widen, CullView view, out bool inside, inout uint planes) {
    bool outside = false;
    inside = true;
    for (uint index = 0u; index < 6u; index++) {
        planes += outside ? 0u : 1u;
        vec4 plane = frustum_plane(index, widen);
        float middle = dot(plane, box.centre);
        float reach = sphere_reach(half_extent, plane, view) + dot(abs(plane), box.error);
        outside = outside || middle + reach < 0.0;
        inside = inside && reach - middle <= 0.0;
    }
    return outside;
}

// True if what an object is tested by is outside the view volume.
bool shape_outside(uint shape, Bounds bound, Object object, LocalBox local, CullView view, inout uint planes) {
    vec2 widen = footprint_widening(bound.flags, view);
    if (shape == SHAPE_ORIENTED) return outside_by_planes(clip_from_local(object, local, view), widen, planes);
    ClipBox box = clip_from_bounds(bound, view);
    if (shape == SHAPE_BOX) return outside_by_planes(box, widen, planes);
    bool inside;
    bool outside = sphere_outside_by_planes(box, bound.half_extent, widen, view, inside, planes);
    if (shape == SHAPE_SPHERE || outside || inside) return outside;
    return outside_by_planes(box, widen, planes);
}
#endif
