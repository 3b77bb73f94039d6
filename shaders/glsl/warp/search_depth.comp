// warp/search_depth: the depth that the new view will have at each texel, as far as the last frame shows it. From seeds
// spread over the motions that can lead here, a fixed point of q = p - motion(q) is searched: the texel that moves to p. Of
// several the nearest is in front (TOG 2018, 3.2, figure 3). Where surfaces are searched and none is found the last frame knows
// nothing: that is a hole, which hides nothing, or gets (FILL) the nearest depth at the extremes of the bound (AWOC, TOG 2018,
// 5.3). Where a search ends in the background there may be background.
// Twin: culling/src/warp/twin/search.rs
//
// FOOTPRINT erodes by what was really there (ours; for Kim 2015, IV.1): what is found gets the farthest depth of the pixels that
// the texel's square covers where it came from, and of MARGIN pixels around them. The 3x3 texels of warp/erode_depth are 12x12
// pixels at a quarter of the size: safer, and they hide far less.
//
// Two departures. A search whose iterations are spent is given the tolerance of WARP_CRACK (motion.glsl says why). And
// searches stay in the picture. A source outside it is then as far from the texel read as it is from the border, and no
// fixed point: the border is not smeared over what comes into view beside it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "moved.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint SEEDS = 4u;
layout(constant_id = 1) const uint ITERATIONS = 5u;
// How close to p a texel must come, in texels: above 0, at most 0.5.
layout(constant_id = 2) const float THRESHOLD = 0.5;
// Texels of the side of a tile that shares a bound.
layout(constant_id = 3) const uint TILE = 4u;
// A bound no wider than this, in texels, is sampled once: all that lies there moves alike.
layout(constant_id = 4) const float NARROW = 1.0;
layout(constant_id = 5) const bool FILL = false;
layout(constant_id = 6) const bool ORIENTED = false;
layout(constant_id = 7) const bool FOOTPRINT = false;
// Objects move: `items` is read.
layout(constant_id = 8) const bool DYNAMIC = false;
// Pixels of a texel's side.
layout(constant_id = 9) const uint REDUCTION = 1u;
// Pixels around a footprint that count too.
layout(constant_id = 10) const uint MARGIN = 0u;
// Motions are in the buffer; otherwise they are computed where they are looked up, as in warp/bound_motion.
layout(constant_id = 11) const bool STORED = true;

layout(set = 0, binding = 0, scalar) readonly buffer Motions { TexelMotion items[]; } motions;
layout(set = 0, binding = 1, scalar) readonly buffer TileBounds { MotionBound items[]; } bounds;
layout(set = 0, binding = 2, scalar) writeonly buffer Warped { float items[]; } warped;
layout(set = 0, binding = 3, scalar) readonly buffer Axes { vec2 items[]; } axes;
// What FOOTPRINT and motions that are not stored read, as warp/measure_motion does.
layout(set = 0, binding = 4, scalar) readonly buffer Depth { float items[]; } last_depth;
layout(set = 0, binding = 5, scalar) readonly buffer Items { uint items[]; } items;
layout(set = 0, binding = 6, scalar) readonly buffer Slots { uint items[]; } slots;
layout(set = 0, binding = 7, scalar) readonly buffer Reprojections { Reprojection items[]; } reprojections;
layout(push_constant, scalar) uniform Push { Reprojection camera; uvec2 texels; uvec2 tiles; uvec2 size_px; float fastest; } push;

vec2 inside(vec2 place) {
    return clamp(place, vec2(0.5), vec2(push.texels) - 0.5);
}

TexelMotion motion_at(vec2 place) {
    uvec2 texel = uvec2(place);
    if (STORED) return motions.items[texel.y * push.texels.x + texel.x];
    uvec2 pixel = middle_pixel(texel, REDUCTION, push.size_px);
    float here = last_depth.items[pixel.y * push.size_px.x + pixel.x];
    return motion_of(push.camera, pixel, here, push.size_px, REDUCTION, push.fastest);
}

// The depth that a pixel of the last frame has in the new view; what has none there is far.
float new_depth(uvec2 pixel, float here) {
    mat4 m = push.camera.clip_from_last;
    if (DYNAMIC) {
        uint item = items.items[pixel.y * push.size_px.x + pixel.x];
        // No object owns the background: its number would be read far outside the slots.
        uint slot = item == ITEM_NONE ? 0u : slots.items[item];
        if (slot != 0u) m = reprojections.items[slot - 1u].clip_from_last;
    }
    precise vec2 place = (vec2(pixel) + 0.5) * (2.0 / vec2(push.size_px)) - 1.0;
    precise vec2 clip = vec2(m[0].z, m[0].w) * place.x + vec2(m[1].z, m[1].w) * place.y + vec2(m[2].z, m[2].w) * here
        + vec2(m[3].z, m[3].w);
    precise float depth = clip.x / clip.y;
    return clip.y > 0.0 && depth > DEPTH_FAR && depth <= 1.0 ? depth : DEPTH_FAR;
}

// The new depth of the farthest of the pixels that a texel's square around `source` touches, or `found` if that is farther.
float farthest_around(vec2 source, float found) {
    if (!FOOTPRINT) return found;
    precise vec2 low = (source - 0.5) * float(REDUCTION) - float(MARGIN);
    precise vec2 high = (source + 0.5) * float(REDUCTION) + float(MARGIN);
    ivec2 most = ivec2(push.size_px) - 1;
    uvec2 first = uvec2(clamp(ivec2(floor(low)), ivec2(0), most));
    uvec2 last = uvec2(clamp(ivec2(ceil(high)) - 1, ivec2(0), most));
    uvec2 pixel = first;
    float farthest = 1.0;
    for (uint y = first.y; y <= last.y; y++) {
        for (uint x = first.x; x <= last.x; x++) {
            float here = last_depth.items[y * push.size_px.x + x];
            if (here < farthest) {
                farthest = here;
                pixel = uvec2(x, y);
            }
        }
    }
    return farthest == DEPTH_FAR ? DEPTH_FAR : min(found, new_depth(pixel, farthest));
}

// Figure 3: the depth of what moves to p, searched from where the motion `seed` would come from. What is found is looked around
// behind the loop: a CPU runs all that stands in it as often as the slowest of the invocations that it runs side by side.
float fixed_point_search(vec2 p, vec2 seed) {
    vec2 place = inside(p - seed);
    TexelMotion motion = motion_at(place);
    vec2 source = place;
    bool found = false;
    for (uint k = 1u; motion.depth > DEPTH_FAR; k++) {
        source = p - motion.offset;
        precise vec2 miss = place - source;
        precise float distance_squared = miss.x * miss.x + miss.y * miss.y;
        float tolerance = k < ITERATIONS ? THRESHOLD : WARP_CRACK;
        found = distance_squared < tolerance * tolerance;
        if (found || k >= ITERATIONS) break;
        place = inside(source);
        motion = motion_at(place);
    }
    if (found) return farthest_around(source, motion.depth);
    return motion.depth > DEPTH_FAR ? DEPTH_HOLE : DEPTH_FAR;
}

// Point `index` of `count`, one in each of `count` strips across and, for powers of two, down (Hammersley).
vec2 stratified(uint index, uint count) {
    float down = float(bitfieldReverse(index)) / 4294967296.0;
    precise vec2 point = vec2((float(index) + 0.5) / float(count), down + 0.5 / float(count));
    return min(point, vec2(1.0));
}

// A motion of a bound, along x and y.
vec2 from_parts(vec2 parts) {
    return ORIENTED ? turned_back(parts, axes.items[0]) : parts;
}

float depth_from(vec2 p, vec2 parts) {
    return motion_at(inside(p - from_parts(parts))).depth;
}

float fill_hole(vec2 p, MotionBound bound) {
    float left = max(depth_from(p, bound.low), depth_from(p, vec2(bound.low.x, bound.high.y)));
    float right = max(depth_from(p, bound.high), depth_from(p, vec2(bound.high.x, bound.low.y)));
    return max(left, right);
}

float warped_depth(uvec2 texel) {
    uvec2 tile = texel / TILE;
    MotionBound bound = bounds.items[tile.y * push.tiles.x + tile.x];
    if (!has_motion(bound)) return DEPTH_FAR;
    vec2 p = vec2(texel) + 0.5;
    vec2 extent = bound.high - bound.low;
    uint seeds = all(lessThanEqual(extent, vec2(NARROW))) ? 1u : SEEDS;
    float nearest = DEPTH_HOLE;
    for (uint index = 0u; index < seeds; index++) {
        precise vec2 seed = bound.low + extent * stratified(index, seeds);
        nearest = max(nearest, fixed_point_search(p, from_parts(seed)));
    }
    return FILL && nearest == DEPTH_HOLE ? fill_hole(p, bound) : nearest;
}

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, push.texels))) return;
    warped.items[texel.y * push.texels.x + texel.x] = warped_depth(texel);
}
