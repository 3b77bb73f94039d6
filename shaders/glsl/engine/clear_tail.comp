// engine/clear_tail: commands behind a list's end get no instance, so that they draw nothing: for devices that cannot read the number
// of commands on the GPU, and draw all that there is room for (Kim 2015, IV.3). What is before the end is not touched.
// Twin: tests/tests/without.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "types.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Count { uint items[]; } count;
layout(set = 0, binding = 1, scalar) writeonly buffer Commands { uint words[]; } commands;
// count_word, first_word: where the number lies, and where the list begins, in words of their buffers.
layout(push_constant, scalar) uniform Push { uint count_word; uint first_word; uint command_count; } push;

// Of a command: its words, and which of them is its instance count.
const uint COMMAND_WORDS = 5u;
const uint INSTANCE_COUNT = 1u;

void main() {
    uint index = invocation_index();
    if (index >= push.command_count || index < count.items[push.count_word]) return;
    commands.words[push.first_word + COMMAND_WORDS * index + INSTANCE_COUNT] = 0u;
}
