// warp/measure_motion: where does each pixel of the last frame go, and how deep is it then? Its depth is reprojected through
// what the camera did and, where objects move, what the pixel's object did (TOG 2018, 3.1). At reduced size the farthest
// pixel of each block stands for it, so that what is warped hides no more than what was there; or its MIDDLE one, where
// warp/search_depth looks at all of them.
// Twin: culling/src/warp/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "moved.glsl"

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
layout(push_constant, scalar) uniform Push { Reprojection camera; uvec2 size_px; uvec2 texels; float fastest; } push;

float depth_at(uvec2 pixel) {
    return depth.items[pixel.y * push.size_px.x + pixel.x];
}

// The pixel that stands for a block: the first, in reading order, that is as far as any. `farthest` is its depth.
uvec2 pixel_for(uvec2 texel, out float farthest) {
    uvec2 first = texel * REDUCTION;
    uvec2 found = MIDDLE ? middle_pixel(texel, REDUCTION, push.size_px) : first;
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

Reprojection reprojection_of(uvec2 pixel) {
    if (DYNAMIC) {
        uint item = items.items[pixel.y * push.size_px.x + pixel.x];
        // No object owns the background: its number would be read far outside the slots.
        uint slot = item == ITEM_NONE ? 0u : slots.items[item];
        if (slot != 0u) return reprojections.items[slot - 1u];
    }
    return push.camera;
}

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, push.texels))) return;
    float here;
    uvec2 pixel = pixel_for(texel, here);
    motions.items[texel.y * push.texels.x + texel.x] =
        motion_of(reprojection_of(pixel), pixel, here, push.size_px, REDUCTION, push.fastest);
}
