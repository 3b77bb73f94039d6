// draw/owners: four bytes that a colour keeps exactly. Occluded fragments stop before this shader.
#version 460
layout(early_fragment_tests) in;

layout(location = 1) flat in uint item;

layout(location = 0) out vec4 owner;

void main() {
    owner = unpackUnorm4x8(item);
}
