// flares/draw_sprites: the light of one sprite, which is added to the picture.
#version 460
layout(location = 0) in vec2 across;
layout(location = 1) flat in vec3 colour;
layout(location = 2) flat in float hollow;
layout(location = 0) out vec4 light;

void main() {
    float radius = length(across);
    float edge = 1.0 - smoothstep(0.85, 1.0, radius);
    float falloff = max(1.0 - radius, 0.0);
    float glow = falloff * falloff * falloff;
    float ring = smoothstep(0.55, 0.9, radius) * edge;
    float shape = hollow < 0.25 ? glow : hollow > 0.75 ? ring : edge;
    light = vec4(colour * shape, 0.0);
}
