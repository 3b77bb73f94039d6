// The drawn object as attributes that go on once an instance. A device reads them once an instance and not, as a storage buffer at
// gl_InstanceIndex, once a vertex: llvmpipe gathers each word of such a buffer for each vertex by itself.
#ifndef INSTANCE_GLSL
#define INSTANCE_GLSL
#include "transform.glsl"

layout(location = 2) in vec3 instance_column_x;
layout(location = 3) in vec3 instance_column_y;
layout(location = 4) in vec3 instance_column_z;
layout(location = 5) in vec3 instance_origin_high;
layout(location = 6) in vec3 instance_origin_low;
layout(location = 7) in uint instance_colour;

Object drawn_object() {
    return Object(instance_column_x, instance_column_y, instance_column_z, instance_origin_high, instance_origin_low,
        instance_colour);
}
#endif
