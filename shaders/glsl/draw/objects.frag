// draw/objects: the colour. Occluded fragments stop before this shader.
#version 460
layout(early_fragment_tests) in;

layout(location = 0) in vec4 shade;
layout(location = 0) out vec4 colour;

void main() {
    colour = shade;
}
