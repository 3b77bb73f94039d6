// warp/orient_axes: along which axes are bounds of motion narrowest? Most of a frame moves alike, so bounds along that
// direction and across it are narrower than along x and y: the principal axes of some 64 motions (PCA; TOG 2018, 3.3). Where
// they bound these motions in no smaller area, x and y are kept (4.2). Twin: culling/src/warp/axes.rs
//
// One invocation: so few samples are not worth more.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "motion.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0, scalar) readonly buffer Motions { TexelMotion items[]; } motions;
layout(set = 0, binding = 1, scalar) writeonly buffer Axes { vec2 items[]; } axes;
layout(push_constant, scalar) uniform Push { uvec2 texels; } push;

// Samples a side, in the middle of equal parts of the picture.
const uint SAMPLED_SIDE = 8u;

TexelMotion sampled(uint index) {
    uvec2 part = uvec2(index % SAMPLED_SIDE, index / SAMPLED_SIDE);
    uvec2 texel = (part * 2u + 1u) * push.texels / (2u * SAMPLED_SIDE);
    return motions.items[texel.y * push.texels.x + texel.x];
}

// The area of the samples' bound along an axis and across it.
float bounded_area(vec2 axis) {
    vec2 low = vec2(3.0e38);
    vec2 high = vec2(-3.0e38);
    for (uint index = 0u; index < SAMPLED_SIDE * SAMPLED_SIDE; index++) {
        TexelMotion motion = sampled(index);
        if (motion.depth > DEPTH_FAR) {
            low = min(low, turned_to(motion.offset, axis));
            high = max(high, turned_to(motion.offset, axis));
        }
    }
    precise vec2 extent = high - low;
    return extent.x * extent.y;
}

// The direction in which the samples differ most: the larger eigenvector of their covariance.
vec2 principal_axis() {
    float count = 0.0;
    precise vec2 sum = vec2(0.0);
    precise vec3 products = vec3(0.0);
    for (uint index = 0u; index < SAMPLED_SIDE * SAMPLED_SIDE; index++) {
        TexelMotion motion = sampled(index);
        if (motion.depth > DEPTH_FAR) {
            count += 1.0;
            sum += motion.offset;
            products += vec3(motion.offset.x * motion.offset.x, motion.offset.x * motion.offset.y, motion.offset.y * motion.offset.y);
        }
    }
    precise vec2 mean = sum / max(count, 1.0);
    precise vec3 covariance = products - count * vec3(mean.x * mean.x, mean.x * mean.y, mean.y * mean.y);
    // Of a symmetric matrix (a b; b c): the eigenvector is (d + sqrt(d^2 + b^2), b) with d = (a - c) / 2, or the other
    // form where that would cancel.
    precise float difference = 0.5 * (covariance.x - covariance.z);
    precise float radius = sqrt(difference * difference + covariance.y * covariance.y);
    precise vec2 axis = difference >= 0.0 ? vec2(difference + radius, covariance.y) : vec2(covariance.y, radius - difference);
    precise float length_squared = axis.x * axis.x + axis.y * axis.y;
    // Said so that infinities and NaN keep x.
    return length_squared > 0.0 && length_squared < 3.0e38 ? axis / sqrt(length_squared) : vec2(1.0, 0.0);
}

void main() {
    vec2 axis = principal_axis();
    axes.items[0] = bounded_area(axis) < bounded_area(vec2(1.0, 0.0)) ? axis : vec2(1.0, 0.0);
}
