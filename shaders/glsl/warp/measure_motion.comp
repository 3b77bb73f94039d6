// warp/measure_motion: where does each pixel of the last frame go, and how deep is it then? Its depth is reprojected through
// what the camera did and, where objects move, what the pixel's object did (TOG 2018, 3.1). At reduced size the farthest
// pixel of each block stands for it, so that what is warped hides no more than what was there; or its MIDDLE one, where
// warp/search_depth looks at all of them.
// Twin: culling/src/warp/twin.rs
//
// Accuracy: the host combines both views and both places of the object in f64 into one matrix M, rounded to f32 once. With
// u = 2^-24, x' = M0 . (x, y, depth, 1) and w' are off by at most 5u sum_j |M_ij| |v_j| (rounding of M, four products, three
// sums), which for motions of up to a third of the picture is below 5u * 4 w'; the place x' / w' by twice that and u:
// 41u of half the picture's side, 0.002 pixels at 1280.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "motion.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// Objects move: `items` is read. Otherwise the camera alone moves all pixels.
layout(constant_id = 0) const bool DYNAMIC = false;
// Pixels of a texel's side.
layout(constant_id = 1) const uint REDUCTION = 1u;
layout(constant_id = 2) const bool MIDDLE = false;

layout(set = 0, binding = 0, scalar) readonly buffer Depth { float items[]; } depth;
// By pixel: its object.
layout(set = 0, binding = 1, scalar) readonly buffer Items { uint items[]; } items;
// By object: 1 + its reprojection; 0 for objects that cannot move.
layout(set = 0, binding = 2, scalar) readonly buffer Slots { uint items[]; } slots;
// Of each object that can move: what it and the camera did.
layout(set = 0, binding = 3, scalar) readonly buffer Reprojections { Reprojection items[]; } reprojections;
layout(set = 0, binding = 4, scalar) writeonly buffer Motions { TexelMotion items[]; } motions;
// `fastest`: what moves farther in the canonical view volume (-1 to 1 in x and y, 0 to 1 in depth) is left out, because its object
// is drawn ahead (woc/find_rapid); 0 leaves out nothing.
layout(push_constant, scalar) uniform Push { Reprojection camera; uvec2 size_px; uvec2 texels; float fastest; } push;

float depth_at(uvec2 pixel) {
    return depth.items[pixel.y * push.size_px.x + pixel.x];
}

// The pixel that stands for a block: the first, in reading order, that is as far as any. `farthest` is its depth.
uvec2 pixel_for(uvec2 texel, out float farthest) {
    uvec2 first = texel * REDUCTION;
    uvec2 found = MIDDLE ? min(first + REDUCTION / 2u, push.size_px - 1u) : first;
    farthest = depth_at(found);
    if (REDUCTION == 1u || MIDDLE) return found;
    uvec2 end = min(first + REDUCTION, push.size_px);
    for (uint y = first.y; y < end.y; y++) {
        for (uint x = first.x; x < end.x; x++) {
            float here = depth_at(uvec2(x, y));
            if (here < farthest) {
                found = uvec2(x, y);
                farthest = here;
            }
        }
    }
    return found;
}

TexelMotion moved(uvec2 pixel, float here) {
    mat4 m = push.camera.clip_from_last;
    if (DYNAMIC) {
        uint slot = slots.items[items.items[pixel.y * push.size_px.x + pixel.x]];
        if (slot != 0u) m = reprojections.items[slot - 1u].clip_from_last;
    }
    vec2 size = vec2(push.size_px);
    precise vec2 place = (vec2(pixel) + 0.5) / size * 2.0 - 1.0;
    precise vec4 clip = m[0] * place.x + m[1] * place.y + m[2] * here + m[3];
    precise vec2 way = clip.xy / clip.w - place;
    precise vec2 offset = way * (0.5 * size / float(REDUCTION));
    precise float depth = clip.z / clip.w;
    precise float deeper = depth - here;
    precise float far_squared = way.x * way.x + way.y * way.y + deeper * deeper;
    // Said so that NaN is nothing: what has no place in the new view must hide nothing there.
    bool shows = clip.w > 0.0 && depth > DEPTH_FAR && depth <= 1.0 && all(lessThan(abs(offset), vec2(3.0e38)))
        && (push.fastest == 0.0 || far_squared <= push.fastest * push.fastest);
    return shows ? TexelMotion(offset, depth) : TexelMotion(vec2(0.0), DEPTH_FAR);
}

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, push.texels))) return;
    float here;
    uvec2 pixel = pixel_for(texel, here);
    motions.items[texel.y * push.texels.x + texel.x] = here > DEPTH_FAR ? moved(pixel, here) : TexelMotion(vec2(0.0), DEPTH_FAR);
}
