// What bends meshes: see world/skin_vertices.
#ifndef SKIN_GLSL
#define SKIN_GLSL
#extension GL_EXT_scalar_block_layout : require

// A vertex that joints carry, at rest.
struct RestVertex {
    vec3 position;
    vec3 normal;
    uvec4 joints;       // places of JointPlace
    vec4 weights;       // none negative; they add up to 1
};

// Where a joint puts vertices at rest, seen from their object, this frame.
struct JointPlace {
    vec3 column_x;      // linear part
    vec3 column_y;
    vec3 column_z;
    vec3 shift;
};
#endif
