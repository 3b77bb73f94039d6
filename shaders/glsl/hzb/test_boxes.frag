// hzb/test_boxes: a fragment of a box is open, so what is in the box may show: its command gets an instance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "types.glsl"
layout(early_fragment_tests) in;
layout(location = 0) flat in uint command;
layout(set = 0, binding = 4, scalar) writeonly buffer Drawn { DrawCommand items[]; } drawn;

void main() {
    drawn.items[command].instance_count = 1u;
}
