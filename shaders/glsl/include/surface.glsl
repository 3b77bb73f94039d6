// The fragment work of stages that show materials: base colour textures from a buffer of texels, which every device binds alike
// (not every device indexes textures). Bilinear within the level whose texels are nearest to pixels. Texels and factors are
// multiplied as they are stored, as pictures are not encoded either.
// PASS_ITEM: the stage knows whose it is.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL
#extension GL_GOOGLE_include_directive : require
#include "types.glsl"

layout(location = 0) in vec4 shade;     // a: alpha of the vertices
#ifdef PASS_ITEM
layout(location = 1) flat in uint item;
#endif
layout(location = 2) in vec2 texture_at;
layout(location = 3) flat in uint material;

layout(set = 0, binding = 1, scalar) readonly buffer Materials { Material items[]; } materials;
layout(set = 0, binding = 2, scalar) readonly buffer Texels { uint items[]; } texels;

// A coordinate that means the same, near enough to the texture for its texels to be numbered.
float near_texture(float at, uint mode) {
    if (mode == WRAP_CLAMP) return clamp(at, -1.0, 2.0);
    return mode == WRAP_MIRROR ? at - 2.0 * floor(0.5 * at) : at - floor(at);
}

// The texel that shows at a place from -1 to twice the size.
int wrapped(int texel, int size, uint mode) {
    if (mode == WRAP_MIRROR) texel = texel < 0 ? -1 - texel : texel < size ? texel : 2 * size - 1 - texel;
    if (mode == WRAP_REPEAT) texel = texel < 0 ? texel + size : texel < size ? texel : texel - size;
    return clamp(texel, 0, size - 1);
}

// Interpolates between two texels. Equal texels keep their value, which mix() may miss by a rounding.
vec4 between(vec4 from, vec4 to, float t) {
    precise vec4 part = from + (to - from) * t;
    return part;
}

vec4 texture_colour(Material of, vec2 step_px) {
    vec2 size = vec2(of.width, of.height);
    float wanted = log2(max(max(step_px.x, step_px.y), 1.0)) + 0.5;
    uint level = min(uint(wanted), of.levels - 1u);
    uint first = of.first_texel;
    for (uint finer = 0u; finer < level; finer++) first += max(of.width >> finer, 1u) * max(of.height >> finer, 1u);
    ivec2 texel_count = ivec2(max(of.width >> level, 1u), max(of.height >> level, 1u));
    uvec2 mode = uvec2(of.wrap & ((1u << WRAP_BITS) - 1u), of.wrap >> WRAP_BITS);
    vec2 at = vec2(near_texture(texture_at.x, mode.x), near_texture(texture_at.y, mode.y)) * vec2(texel_count) - 0.5;
    vec2 corner = floor(at);
    vec4 rows[2];
    for (int row = 0; row < 2; row++) {
        int y = wrapped(int(corner.y) + row, texel_count.y, mode.y);
        vec4 ends[2];
        for (int column = 0; column < 2; column++) {
            int x = wrapped(int(corner.x) + column, texel_count.x, mode.x);
            ends[column] = unpackUnorm4x8(texels.items[first + uint(y * texel_count.x + x)]);
        }
        rows[row] = between(ends[0], ends[1], at.x - corner.x);
    }
    return between(rows[0], rows[1], at.y - corner.y);
}

// The colour with its alpha. An alpha that is the same for all vertices is not interpolated: a device may round it below the cutoff.
vec4 surface_colour() {
    Material of = materials.items[material];
    vec2 size = vec2(of.width, of.height);
    // Before anything differs between neighbours, which derivatives are taken over.
    vec2 step_px = vec2(length(dFdx(texture_at) * size), length(dFdy(texture_at) * size));
    vec4 texel = of.levels == 0u ? vec4(1.0) : texture_colour(of, step_px);
    float alpha = of.alpha_varies != 0u ? of.alpha * shade.a : of.alpha;
    return vec4(shade.rgb * texel.rgb, alpha * texel.a);
}

// True if there is something, of masked objects.
bool is_there(vec4 colour) {
    return colour.a >= materials.items[material].cutoff;
}
#endif
