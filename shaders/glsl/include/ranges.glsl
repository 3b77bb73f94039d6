// Depth ranges: where a box lies along the view, in metres from the eye, and which range that is.
#ifndef RANGES_GLSL
#define RANGES_GLSL
#include "transform.glsl"

// How far the middle of a box lies along the view, and how far the box reaches before and behind that. dot(plane, vec4(p, 1)) is how
// far p, relative to the camera, lies in front of the eye (of a parallel view: behind the near plane).
vec2 depth_of_box(Bounds bound, vec4 plane, vec3 camera_high, vec3 camera_low) {
    vec3 centre = relative_from_split(bound.centre_high, bound.centre_low, camera_high, camera_low);
    precise float middle = plane.x * centre.x + plane.y * centre.y + plane.z * centre.z + plane.w;
    precise float reach =
        abs(plane.x) * bound.half_extent.x + abs(plane.y) * bound.half_extent.y + abs(plane.z) * bound.half_extent.z;
    return vec2(middle, reach);
}

// Where a box begins: 0 if it reaches the eye, or is so large that this is no number.
float begin_of_box(Bounds bound, vec4 plane, vec3 camera_high, vec3 camera_low) {
    vec2 depth = depth_of_box(bound, plane, camera_high, camera_low);
    precise float begin = depth.x - depth.y;
    return begin > 0.0 ? begin : 0.0;
}

// The range of a depth. The last of `range_count` ends at `outermost`, each before it at `share` of the next one's end.
uint range_of(float depth, float outermost, uint range_count, float share) {
    uint range = range_count - 1u;
    float end = outermost * share;
    while (range > 0u && depth <= end) {
        range--;
        end *= share;
    }
    return range;
}
#endif
