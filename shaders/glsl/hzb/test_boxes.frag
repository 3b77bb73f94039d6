// hzb/test_boxes: a fragment of a box is open, so what is in the box may show: its command gets an instance, and it counts as seen.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "types.glsl"
layout(early_fragment_tests) in;
layout(location = 0) flat in uint command;
layout(location = 1) flat in uint object;
layout(set = 0, binding = 4, scalar) writeonly buffer Drawn { DrawCommand items[]; } drawn;
layout(set = 0, binding = 5, scalar) writeonly buffer Visible { uint items[]; } visible;

void main() {
    drawn.items[command].instance_count = 1u;
    visible.items[object] = 1u;
}
