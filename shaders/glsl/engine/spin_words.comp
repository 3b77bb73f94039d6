// engine/spin_words: work of a known size, for the timer's self-check. No twin: its result is not used.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) buffer Words { uint items[]; } words;
layout(push_constant) uniform Push { uint word_count; } push;

void main() {
    uint word = invocation_index();
    if (word >= push.word_count) return;
    uint value = words.items[word];
    for (uint round = 0u; round < 8u; round++) value = value * 1664525u + 1013904223u;
    words.items[word] = value;
}
