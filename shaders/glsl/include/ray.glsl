// A pixel's ray, and where it meets boxes. The ray stands for all that the rasteriser can put in the pixel: boxes are grown by
// what pad_px spans at the far end of the ray (box.glsl derives the pad), which also covers the rounding of the slab test (3u
// of the distance, against at least 2 / (64 * 16,384) of it).
#ifndef RAY_GLSL
#define RAY_GLSL
#include "box.glsl"

struct Ray {
    vec3 origin;
    vec3 direction;
    vec3 inverse;
    float last;     // nothing behind it can show: the depth buffer is nearer
};

// Where a ray has the depth given: z/w is a ratio of linear functions of the distance. Infinite if nowhere ahead.
float distance_at_depth(mat4 clip, vec3 origin, vec3 direction, float depth) {
    vec4 start = clip * vec4(origin, 1.0);
    vec4 step = clip * vec4(direction, 0.0);
    float along = depth * step.w - step.z;
    float distance = (start.z - depth * start.w) / along;
    return along > 0.0 && distance >= 0.0 ? distance : 3.0e38;
}

Ray ray_through(vec2 centre_px, float depth, BoxView box_view) {
    CullView view = box_view.view;
    vec2 at = centre_px / vec2(view.width_px, view.height_px) * 2.0 - 1.0;
    Ray ray;
    ray.origin = box_view.origin[0] + at.x * box_view.origin[1] + at.y * box_view.origin[2];
    ray.direction = box_view.direction[0] + at.x * box_view.direction[1] + at.y * box_view.direction[2];
    // A direction of exactly 0 would give 0 times infinity; this one misses nothing that 0 would hit.
    vec3 safe = mix(ray.direction, vec3(1.0e-30), lessThan(abs(ray.direction), vec3(1.0e-30)));
    ray.inverse = 1.0 / safe;
    ray.last = distance_at_depth(view.clip_from_relative, ray.origin, ray.direction, depth);
    return ray;
}

bool meets(Ray ray, Bounds bounds, CullView view, float growth) {
    vec3 centre = relative_from_split(bounds.centre_high, bounds.centre_low, view.camera_high, view.camera_low) - ray.origin;
    vec3 half_extent = bounds.half_extent + growth;
    vec3 one = (centre - half_extent) * ray.inverse;
    vec3 other = (centre + half_extent) * ray.inverse;
    vec3 enter = min(one, other);
    vec3 leave = max(one, other);
    float first = max(max(enter.x, enter.y), max(enter.z, 0.0));
    float last = min(min(leave.x, leave.y), min(leave.z, ray.last));
    return first <= last;
}
#endif
