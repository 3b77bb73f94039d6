// engine/spin_pixels: a triangle over the whole target, for the timer's self-check.
#version 460
void main() {
    vec2 corner = vec2(float((gl_VertexIndex << 1) & 2), float(gl_VertexIndex & 2));
    gl_Position = vec4(corner * 2.0 - 1.0, 0.5, 1.0);
}
