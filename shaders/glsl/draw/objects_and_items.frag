// draw/objects_and_items: the colour, and who owns the pixel. Occluded fragments stop before this shader.
#version 460
layout(early_fragment_tests) in;

layout(location = 0) in vec4 shade;
layout(location = 1) flat in uint item;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint owner;

void main() {
    colour = shade;
    owner = item;
}
