// The vertex work of every draw/objects* stage: the same arithmetic, so that all give the same pixels.
// PASS_ITEM tells the fragment shader whose it is, DETAIL what it is made of.
#ifndef SHADE_GLSL
#define SHADE_GLSL
#include "instance.glsl"
#include "light.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 normal_snorm16;    // octahedral

#ifdef DETAIL
layout(location = 8) in vec2 coordinates;       // on the texture
layout(location = 9) in uint tint;              // RGB8, linear: the factor of the colour
layout(location = 10) in float alpha;           // the factor of the material's alpha
// By object.
layout(set = 0, binding = 0, scalar) readonly buffer ObjectMaterials { uint items[]; } object_materials;
layout(location = 2) out vec2 texture_at;
layout(location = 3) flat out uint material;
#endif

layout(push_constant, scalar) uniform Push { View view; } push;

layout(location = 0) out vec4 shade;
#ifdef PASS_ITEM
layout(location = 1) flat out uint item;
#endif

invariant gl_Position;

vec3 normal_from_octahedron(vec2 folded) {
    vec3 normal = vec3(folded, 1.0 - abs(folded.x) - abs(folded.y));
    float fold = max(-normal.z, 0.0);
    normal.x += normal.x >= 0.0 ? -fold : fold;
    normal.y += normal.y >= 0.0 ? -fold : fold;
    return normal;
}

void main() {
    Object object = drawn_object();
    gl_Position = clip_from_object(object, position, push.view.clip_from_relative, push.view.camera_high, push.view.camera_low);
    gl_PointSize = 1.0;
    // Normals turn by the cofactor matrix, which is right for mirrored and flattened transforms too.
    vec3 local = normal_from_octahedron(normal_snorm16);
    vec3 normal = cross(object.column_y, object.column_z) * local.x + cross(object.column_z, object.column_x) * local.y
        + cross(object.column_x, object.column_y) * local.z;
    float size = length(normal);
    float lambert = size > 0.0 ? abs(dot(normal, vec3(LIGHT_X, LIGHT_Y, LIGHT_Z))) / size : 1.0;
    vec4 colour = unpackUnorm4x8(object.colour);
    shade = vec4(colour.rgb * (0.25 + 0.75 * lambert), colour.a);
#ifdef DETAIL
    shade = vec4(shade.rgb * unpackUnorm4x8(tint).rgb, alpha);
    texture_at = coordinates;
    material = object_materials.items[gl_InstanceIndex];
#endif
#ifdef PASS_ITEM
    item = uint(gl_InstanceIndex);
#endif
}
#endif
