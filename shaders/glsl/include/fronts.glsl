// How near a box can be at each place of the picture, by the planes of its faces, where a footprint has one depth for all of it. A wall that
// recedes hides what recedes behind it; the nearest corner of that is in front of most of the wall.
//
// Derivation. Let L(p) = base + gradient . p, over pixels p. Over the points of a box with w > 0, z/w - gradient . p is a ratio of affine functions and takes its
// largest value at a corner: if L is no less than the depth of each corner, nothing in the box is nearer than L where it is seen. So any gradient
// will do, and `base` is raised until it holds: the gradient of a face's plane makes the bound tight, and a bad one (of a face on edge) makes it loose,
// never wrong. A clip position's error moves a corner by `slack_px` and its depth by `depth_error` at most (footprint.glsl, each at its worst corner), and
// with them L by |gradient| . slack_px + depth_error. L and base are sums of products no larger than |gradient| . R + nearest, R pixels the
// farthest from the middle that is asked: 16 roundings of that are allowed for. A fragment's depth is that of a triangle's plane as far
// off the triangle as footprint.glsl says, so the same slack is added; the place of the triangle that it is off from lies no farther from the pixel's centre than the footprint was grown by.
// Twin: culling/src/hzb/fronts.rs
#ifndef FRONTS_GLSL
#define FRONTS_GLSL
#include "footprint.glsl"

// Pyramid texels that a test against fronts may look at.
const uint FRONT_TEXELS = 256u;

struct Fronts {
    vec2 middle_px;     // what pixels are relative to
    vec2 pad_px;        // how far beside a pixel what it shows may be
    vec2 gradient[3];   // depth a pixel, of a face of each axis
    float base[3];
};

// The footprint is that of the box, which does not cross the near plane.
Fronts fronts_of(ClipBox box, Footprint footprint, CullView view, uint flags) {
    vec2 size = vec2(view.width_px, view.height_px);
    float wide = (flags & OBJECT_WIDE_RASTER) != 0u ? 1.0 : 0.0;
    Fronts fronts;
    fronts.middle_px = 0.5 * vec2(footprint.first + footprint.last);
    fronts.pad_px = vec2(view.snap_px + wide) + ROUNDING * size;
    vec2 reach_px = 0.5 * vec2(footprint.last - footprint.first) + 1.0 + fronts.pad_px;
    vec2 place[8];
    float depth[8];
    vec2 slack_px = vec2(0.0);
    float depth_error = 0.0;
    float nearest = 0.0;
    float farthest = 1.0;
    for (uint corner = 0u; corner < 8u; corner++) {
        vec4 clip = box.centre + ((corner & 1u) != 0u ? box.axis_x : -box.axis_x)
            + ((corner & 2u) != 0u ? box.axis_y : -box.axis_y) + ((corner & 4u) != 0u ? box.axis_z : -box.axis_z);
        float w_low = clip.w - box.error.w;
        vec2 projected = clip.xy / clip.w;
        vec2 slack = (box.error.xy + abs(projected) * box.error.w) / w_low + ROUNDING * abs(projected);
        place[corner] = (projected * 0.5 + 0.5) * size - fronts.middle_px;
        depth[corner] = clip.z / clip.w;
        slack_px = max(slack_px, (0.5 * slack + ROUNDING) * size);
        depth_error = max(depth_error, (clip.z + box.error.z) / w_low * (1.0 + ROUNDING) - depth[corner]);
        reach_px = max(reach_px, abs(place[corner]));
        nearest = max(nearest, depth[corner]);
        farthest = min(farthest, depth[corner]);
    }
    float off_plane = (nearest + depth_error - min(farthest, nearest)) * DEPTH_SLACK_PER_PIXEL * (grid_px(view) + wide);
    for (uint axis = 0u; axis < 3u; axis++) {
        fronts.gradient[axis] = vec2(0.0);
        fronts.base[axis] = footprint.nearest;
        uint along = 1u << (axis + 1u) % 3u;
        uint across = 1u << (axis + 2u) % 3u;
        for (uint side = 0u; side < 2u; side++) {
            uint origin = side << axis;
            vec2 one = place[origin | along] - place[origin];
            vec2 other = place[origin | across] - place[origin];
            float deeper = depth[origin | along] - depth[origin];
            float other_deeper = depth[origin | across] - depth[origin];
            vec2 gradient = vec2(deeper * other.y - other_deeper * one.y, one.x * other_deeper - other.x * deeper) / (one.x * other.y - one.y * other.x);
            float base = -3.0e38;
            for (uint corner = 0u; corner < 8u; corner++) base = max(base, depth[corner] - dot(gradient, place[corner]));
            float steep = dot(abs(gradient), reach_px);
            base += dot(abs(gradient), slack_px) + depth_error + off_plane + 4.0 * ROUNDING * (steep + nearest);
            // Not so of a face whose plane has no gradient, as nothing is comparable then.
            if (steep < 3.0e38 && base < fronts.base[axis]) {
                fronts.gradient[axis] = gradient;
                fronts.base[axis] = base;
            }
        }
    }
    return fronts;
}

// Depth that nothing of the box exceeds at the pixels from `first` to `last`.
float nearest_of_fronts(Fronts fronts, float nearest, vec2 first, vec2 last) {
    vec2 low = first - fronts.pad_px - fronts.middle_px;
    vec2 high = last + 1.0 + fronts.pad_px - fronts.middle_px;
    for (uint axis = 0u; axis < 3u; axis++) {
        vec2 farther = max(fronts.gradient[axis] * low, fronts.gradient[axis] * high);
        nearest = min(nearest, fronts.base[axis] + (farther.x + farther.y));
    }
    return nearest;
}

// True if the box is behind every texel where its faces are, though its footprint is not. The stage declares `pyramid` and `levels` before
// it includes this.
bool hidden_by_fronts(Bounds bound, CullView view, uint coarsest_level) {
    ClipBox box = clip_from_bounds(bound, view);
    Footprint footprint = footprint_of(box, view, bound.flags);
    if (footprint.crosses_near) return false;
    uint level = FINEST_LEVEL;
    uvec2 span = (footprint.last >> level) - (footprint.first >> level) + 1u;
    while (level < coarsest_level && span.x * span.y > FRONT_TEXELS) {
        level++;
        span = (footprint.last >> level) - (footprint.first >> level) + 1u;
    }
    Fronts fronts = fronts_of(box, footprint, view, bound.flags);
    PyramidLevel texels = levels.items[level];
    uvec2 begin = footprint.first >> level;
    for (uint place = 0u; place < span.x * span.y; place++) {
        uvec2 texel = begin + uvec2(place % span.x, place / span.x);
        vec2 first = vec2(max(texel << level, footprint.first));
        vec2 last = vec2(min(((texel + 1u) << level) - 1u, footprint.last));
        if (nearest_of_fronts(fronts, footprint.nearest, first, last) >= pyramid.items[texels.first + texel.y * texels.width + texel.x])
            return false;
    }
    return true;
}
#endif
