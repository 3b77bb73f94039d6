// draw/overdraw: adds one where a fragment passes the early tests.
#version 460
layout(early_fragment_tests) in;
layout(location = 0) out vec4 count;

void main() {
    count = vec4(1.0);
}
