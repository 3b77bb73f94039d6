// flares/draw_sprites: a lens flare over the finished picture: a glow and a halo around the light, and its reflections in the lens along the
// line through the picture's middle. Nothing of it is hidden by a part of the scene: it is a lens's effect (GPU Gems 29.8).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "flare.glsl"

// Where the light is, x and y in -1..1; how much of it shows, 0 to 1; the picture's height over its width.
layout(push_constant, scalar) uniform Push { vec2 light; float brightness; float height_over_width; } push;

layout(location = 0) out vec2 across;           // -1..1 over the sprite
layout(location = 1) flat out vec3 colour;
layout(location = 2) flat out float hollow;     // 0 a glow, 1 a ring, between them a disc

struct Sprite {
    float along;        // 0 at the light, 1 in the picture's middle, 2 opposite the light
    float radius;       // of half the picture's height
    vec3 colour;
    float hollow;
};

const Sprite SPRITES[FLARE_SPRITES] = Sprite[FLARE_SPRITES](
    Sprite(0.0, 0.70, vec3(1.00, 0.86, 0.62), 0.0),
    Sprite(0.0, 0.42, vec3(0.30, 0.20, 0.12), 1.0),
    Sprite(0.45, 0.09, vec3(0.10, 0.22, 0.14), 0.5),
    Sprite(0.70, 0.05, vec3(0.22, 0.18, 0.08), 0.5),
    Sprite(1.25, 0.13, vec3(0.08, 0.14, 0.24), 0.5),
    Sprite(1.60, 0.07, vec3(0.24, 0.10, 0.10), 0.5),
    Sprite(2.00, 0.32, vec3(0.12, 0.16, 0.24), 1.0)
);

void main() {
    const vec2 corners[6] = vec2[6](vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0), vec2(1.0, 1.0));
    Sprite sprite = SPRITES[gl_InstanceIndex];
    across = corners[gl_VertexIndex];
    colour = sprite.colour * push.brightness;
    hollow = sprite.hollow;
    vec2 middle = push.light * (1.0 - sprite.along);
    // Nearest: whatever was drawn, it passes the depth test.
    gl_Position = vec4(middle + across * sprite.radius * vec2(push.height_over_width, 1.0), 1.0, 1.0);
}
