// Motion and its bounds, shared by the stages of depth warping (TOG 2018, 3.1 and 3.3).
#ifndef MOTION_GLSL
#define MOTION_GLSL
#include "pyramid.glsl"

// Where a texel of the last frame goes. A texel is a pixel, or the farthest of a block of pixels.
struct TexelMotion {
    vec2 offset;        // texels; to the right and down
    float depth;        // its depth in the new view; 0 (far): nothing there, or nothing that the new view can show
};

// The least and the greatest motions of a region, by axis, in texels; empty if low exceeds high.
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

// A texel's own motion as a bound: none if nothing is there or if it leaves the picture.
MotionBound bound_of(TexelMotion motion, uvec2 texel, uvec2 texels) {
    vec2 end = vec2(texel) + 0.5 + motion.offset;
    bool shows = motion.depth > DEPTH_FAR && all(greaterThanEqual(end, vec2(-WARP_REACH)))
        && all(lessThanEqual(end, vec2(texels) + WARP_REACH));
    return shows ? MotionBound(motion.offset, motion.offset) : no_motion();
}
#endif
