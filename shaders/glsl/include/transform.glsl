// The one way from object to clip space. Every pass that must agree on a depth or pixel uses it, with gl_Position invariant.
#ifndef TRANSFORM_GLSL
#define TRANSFORM_GLSL
#include "types.glsl"

// Position relative to the camera. `precise` keeps the two differences apart: summed otherwise they lose the low part.
vec3 relative_from_split(vec3 high, vec3 low, vec3 camera_high, vec3 camera_low) {
    precise vec3 coarse = high - camera_high;
    precise vec3 fine = low - camera_low;
    precise vec3 sum = coarse + fine;
    return sum;
}

vec4 clip_from_object(Object object, vec3 position, mat4 clip_from_relative, vec3 camera_high, vec3 camera_low) {
    precise vec3 turned = object.column_x * position.x + object.column_y * position.y + object.column_z * position.z;
    vec3 origin = relative_from_split(object.origin_high, object.origin_low, camera_high, camera_low);
    precise vec3 relative = turned + origin;
    precise vec4 clip = clip_from_relative[0] * relative.x + clip_from_relative[1] * relative.y
        + clip_from_relative[2] * relative.z + clip_from_relative[3];
    return clip;
}
#endif
