// Motion and its bounds, shared by the stages of depth warping (TOG 2018, 3.1 and 3.3).
#ifndef MOTION_GLSL
#define MOTION_GLSL
#include "pyramid.glsl"

// Where a texel of the last frame goes. A texel is a pixel, or the farthest of a block of pixels.
struct TexelMotion {
    vec2 offset;        // texels; to the right and down
    float depth;        // its depth in the new view; 0 (far): nothing there, or nothing that the new view can show
};

// The least and the greatest motions of a region, by axis, in texels; empty if low exceeds high. The axes are those of
// warp/orient_axes: some direction and, a quarter turn on, the one across.
struct MotionBound {
    vec2 low;
    vec2 high;
};

// Clip space of the new view from clip space of the last one (x, y, depth, 1): what the camera and one object did.
struct Reprojection {
    mat4 clip_from_last;
};

// How far a search may end from its texel, in texels, when its iterations are spent. Where the picture grows (by m), the
// motions of neighbours differ by m - 1 and end m apart: between them the search goes to and fro for ever, and only what
// grows by less than 1 + threshold would be found. One texel takes surfaces that grow up to twofold for whole; of two
// surfaces, it closes cracks of a texel at most.
const float WARP_CRACK = 1.0;

// How far from a texel's centre, in texels, a pixel may be that is taken from it: half a texel, as every place in the texel
// reads the same motion, and WARP_CRACK. A motion that ends farther outside the picture than this shows nowhere in it, so
// bounds leave it out.
const float WARP_REACH = 1.5;

// The depth of a texel of which the last frame knows nothing: farther than far, so that it hides nothing, and not what shows
// where nothing is.
const float DEPTH_HOLE = -1.0;

// Texels a side that an invocation of warp/erode_depth makes.
const uint ERODE_SIDE = 4u;

// A motion by its parts along an axis of length 1 and across it. Along x that is the motion itself, exactly.
vec2 turned_to(vec2 offset, vec2 axis) {
    precise vec2 parts = vec2(axis.x * offset.x + axis.y * offset.y, axis.x * offset.y - axis.y * offset.x);
    return parts;
}

// The motion from its parts.
vec2 turned_back(vec2 parts, vec2 axis) {
    precise vec2 offset = vec2(axis.x * parts.x - axis.y * parts.y, axis.x * parts.y + axis.y * parts.x);
    return offset;
}

MotionBound no_motion() {
    return MotionBound(vec2(3.0e38), vec2(-3.0e38));
}

bool has_motion(MotionBound bound) {
    return all(lessThanEqual(bound.low, bound.high));
}

MotionBound union_of(MotionBound a, MotionBound b) {
    return MotionBound(min(a.low, b.low), max(a.high, b.high));
}

MotionBound common_to(MotionBound a, MotionBound b) {
    return MotionBound(max(a.low, b.low), min(a.high, b.high));
}

// The bound along x and y of what lies in a bound along other axes. A turn is off by at most 4u of the motion's length (two
// products and a sum of each turn), which WIDER makes good.
MotionBound upright(MotionBound bound, vec2 axis) {
    const float WIDER = 8.0 / 16777216.0;
    if (axis == vec2(1.0, 0.0)) return bound;
    vec2 middle = turned_back(0.5 * (bound.low + bound.high), axis);
    precise vec2 arm = 0.5 * (bound.high - bound.low);
    precise vec2 reach = vec2(abs(axis.x) * arm.x + abs(axis.y) * arm.y, abs(axis.y) * arm.x + abs(axis.x) * arm.y);
    precise vec2 wider = reach + WIDER * (abs(middle) + reach + max(abs(middle).yx, reach.yx));
    return MotionBound(middle - wider, middle + wider);
}

// A texel's own motion as a bound: none if nothing is there or if it leaves the picture.
MotionBound bound_of(TexelMotion motion, uvec2 texel, uvec2 texels, vec2 axis) {
    vec2 end = vec2(texel) + 0.5 + motion.offset;
    bool shows = motion.depth > DEPTH_FAR && all(greaterThanEqual(end, vec2(-WARP_REACH)))
        && all(lessThanEqual(end, vec2(texels) + WARP_REACH));
    vec2 parts = turned_to(motion.offset, axis);
    return shows ? MotionBound(parts, parts) : no_motion();
}
#endif
