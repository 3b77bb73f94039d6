// engine/spin_pixels: work of a known size a pixel, for the timer's self-check.
#version 460
layout(location = 0) out vec4 colour;

void main() {
    uint value = uint(gl_FragCoord.x);
    for (uint round = 0u; round < 200u; round++) value = value * 1664525u + 1013904223u;
    colour = vec4(float(value >> 24) / 255.0);
}
