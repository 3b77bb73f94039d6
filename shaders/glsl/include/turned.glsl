// The mesh of an object that can turn inside out: see world/turn_objects.
#ifndef TURNED_GLSL
#define TURNED_GLSL
#extension GL_EXT_scalar_block_layout : require

struct TurnedObject {
    uint object;
    uint mesh;          // its mesh this frame
};
#endif
