// Structs that deform meshes: see world/skin_vertices.
#ifndef SKIN_GLSL
#define SKIN_GLSL
#extension GL_EXT_scalar_block_layout : require

// A vertex of a deformed mesh at rest. Its influences and displacements lie side by side in buffers that all vertices share.
struct RestVertex {
    vec3 position;
    vec3 normal;
    uint first_influence;
    uint influence_count;       // 0: no skeleton bends it
    uint first_displacement;
    uint displacement_count;
};

// One joint that carries a vertex.
struct Influence {
    uint place;                 // index of its JointPlace
    float share;                // greater than 0; those of a vertex add up to 1
};

// The effect of one morph target on one vertex, at weight 1.
struct Displacement {
    uint weight;                // index of its target's weight
    vec3 position;
    vec3 normal;
};

// The place of a joint this frame: object from rest.
struct JointPlace {
    vec3 column_x;              // linear part
    vec3 column_y;
    vec3 column_z;
    vec3 shift;
};
#endif
