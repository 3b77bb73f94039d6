// Where a pixel of the last frame goes (TOG 2018, 3.1), shared by the stages that store motion or compute it where it is
// looked up.
//
// Accuracy: the host combines both views and both places of the object in f64 into one matrix M, rounded to f32 once. With
// u = 2^-24, x' = M0 . (x, y, depth, 1) and w' are off by at most 5u sum_j |M_ij| |v_j| (rounding of M, four products, three
// sums), which for motions of up to a third of the picture is below 5u * 4 w'; the place x' (1 / w') by twice that and 2u:
// 42u of half the picture's side, 0.002 pixels at 1280. The rounding of (x, y) is in both ends of a motion, and cancels.
#ifndef MOVED_GLSL
#define MOVED_GLSL
#include "motion.glsl"

// The pixel that stands for a texel of which all pixels are looked at later; at full size, its only one.
uvec2 middle_pixel(uvec2 texel, uint reduction, uvec2 size_px) {
    return min(texel * reduction + reduction / 2u, size_px - 1u);
}

// The motion of a pixel at depth `here`, in texels of `reduction` pixels. `fastest`: what moves farther in the canonical view
// volume (-1 to 1 in x and y, 0 to 1 in depth) is left out, because its object is drawn ahead (woc/find_rapid); 0 leaves out
// nothing.
TexelMotion motion_of(Reprojection by, uvec2 pixel, float here, uvec2 size_px, uint reduction, float fastest) {
    mat4 m = by.clip_from_last;
    vec2 size = vec2(size_px);
    precise vec2 place = (vec2(pixel) + 0.5) * (2.0 / size) - 1.0;
    precise vec4 clip = m[0] * place.x + m[1] * place.y + m[2] * here + m[3];
    precise float over_w = 1.0 / clip.w;
    precise vec2 way = clip.xy * over_w - place;
    precise vec2 offset = way * (0.5 * size / float(reduction));
    precise float depth = clip.z * over_w;
    precise float deeper = depth - here;
    precise float far_squared = way.x * way.x + way.y * way.y + deeper * deeper;
    // Said so that NaN is nothing: what has no place in the new view must hide nothing there.
    bool shows = here > DEPTH_FAR && clip.w > 0.0 && depth > DEPTH_FAR && depth <= 1.0
        && all(lessThan(abs(offset), vec2(3.0e38))) && (fastest == 0.0 || far_squared <= fastest * fastest);
    return shows ? TexelMotion(offset, depth) : TexelMotion(vec2(0.0), DEPTH_FAR);
}
#endif
