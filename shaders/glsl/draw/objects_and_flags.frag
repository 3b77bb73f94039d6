// draw/objects_and_flags: the colour, and a flag for the object. Occluded fragments stop before this shader.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(early_fragment_tests) in;

layout(location = 0) in vec4 shade;
layout(location = 1) flat in uint item;

layout(set = 0, binding = 1, scalar) writeonly buffer Visible { uint items[]; } visible;

layout(location = 0) out vec4 colour;

void main() {
    colour = shade;
    // A plain store: every writer writes the same, and an atomic costs 20 times as much.
    visible.items[item] = 1u;
}
