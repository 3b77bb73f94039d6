// Where a box lies on the screen, in whole pixels, and how near it can be: both rounded outward.
//
// Derivation (rule 4 of DESIGN.md). For a corner with clip error e (cull.glsl) and w > e.w, the projected coordinate is off
// by at most (e.x + |x/w| e.w) / (w - e.w), plus 4u |x/w| for the division and 4u of the picture's size for the viewport
// transform. The device then snaps vertices to a grid of snap_px. A pixel is drawn only if its centre lies in the snapped
// triangle, so only pixels whose centre lies in the box's rectangle grown by that much can be touched: a box that contains
// no pixel centre draws nothing. Depth: z/w of anything in the box is at most the largest over its corners (a ratio of
// affine functions takes its extremes there), rounded as above. A pixel's depth is that of the triangle's plane at its centre,
// which may lie outside the triangle: snapping moves each vertex by up to snap_px / 2 in x and y, and so an edge by up to
// 0.71 snap_px against the plane of the unsnapped triangle (lavapipe). SwiftShader takes the plane of the snapped one, in
// which no centre lies outside, but snaps once more where it clips at the picture's border: the plane is off by 0.71 snap_px
// one way and the edge the other. So 1.42 snap_px / h times the triangle's depth range at most, for a triangle h pixels high
// at its lowest (measured over 13,000 adverse triangles: 0.49 snap_px / h on lavapipe, 1.00 on SwiftShader, there at the
// border alone). A line's pixels lie up to a pixel past its ends, and its depth goes on with its slope: at most
// (1 + 2 snap_px) / l for a line l pixels long (measured on lavapipe: 0.5 / l). DEPTH_SLACK_PER_PIXEL covers h and l >= 1/8
// pixel. Where pixels have several samples, each lies less than half a pixel from the centre: the rectangle grows by SAMPLE_REACH_PX, which the
// view has in snap_px; depths are those of the plane at the sample, and no farther off it than a centre's. A device with the fault of taking them s pixels beside
// it (SwiftShader: 0.75) is off by s / h times the range more, and the view has s in snap_px too: 12 (snap + s) is no less than (1.42 snap + s) / h. Thinner slivers and shorter lines that span most of their box's depth range are outside the documented raster
// conditions; those of a dense mesh are not, as they span little of it.
#ifndef FOOTPRINT_GLSL
#define FOOTPRINT_GLSL
#include "cull.glsl"

const float DEPTH_SLACK_PER_PIXEL = 12.0;
const float ROUNDING = 4.0 / 16777216.0;

struct Footprint {
    bool crosses_near;  // reaches in front of the near plane or behind the eye: nothing else is valid
    bool empty;         // covers no pixel centre
    uvec2 first;        // first and last pixel, within the picture
    uvec2 last;
    float nearest;      // depth that nothing in the box exceeds
};

Footprint footprint_of(ClipBox box, CullView view, uint flags) {
    Footprint result;
    result.crosses_near = farthest_along(box, vec4(0.0, 0.0, 1.0, -1.0)) > 0.0 || farthest_along(box, vec4(0.0, 0.0, 0.0, -1.0)) >= 0.0;
    vec2 low = vec2(3.0e38);
    vec2 high = vec2(-3.0e38);
    float nearest = 0.0;
    float farthest = 1.0;
    for (uint corner = 0u; corner < 8u; corner++) {
        vec4 clip = box.centre + ((corner & 1u) != 0u ? box.axis_x : -box.axis_x)
            + ((corner & 2u) != 0u ? box.axis_y : -box.axis_y) + ((corner & 4u) != 0u ? box.axis_z : -box.axis_z);
        float w_low = clip.w - box.error.w;
        vec2 projected = clip.xy / clip.w;
        vec2 slack = (box.error.xy + abs(projected) * box.error.w) / w_low + ROUNDING * abs(projected);
        low = min(low, projected - slack);
        high = max(high, projected + slack);
        nearest = max(nearest, (clip.z + box.error.z) / w_low * (1.0 + ROUNDING));
        farthest = min(farthest, clip.z / clip.w);
    }
    vec2 size = vec2(view.width_px, view.height_px);
    float wide = (flags & OBJECT_WIDE_RASTER) != 0u ? 1.0 : 0.0;
    float grow = view.snap_px + wide;
    vec2 pad = vec2(grow) + ROUNDING * size;
    vec2 first = ceil((low * 0.5 + 0.5) * size - pad - 0.5);
    vec2 last = floor((high * 0.5 + 0.5) * size + pad - 0.5);
    result.empty = any(greaterThan(first, last)) || any(lessThan(last, vec2(0.0))) || any(greaterThanEqual(first, size));
    result.first = uvec2(clamp(first, vec2(0.0), size - 1.0));
    result.last = uvec2(clamp(last, vec2(0.0), size - 1.0));
    float off_plane = grid_px(view) + wide;
    result.nearest = min(nearest + (nearest - min(farthest, nearest)) * DEPTH_SLACK_PER_PIXEL * off_plane, 1.0);
    return result;
}
#endif
