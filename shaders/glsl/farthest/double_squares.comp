// farthest/double_squares: the next level of an N-buffer: of squares twice as wide, each the farthest of four that tile it
// (Decoret 2005; Kim 2015, III.2). Twin: culling/src/farthest/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "farthest.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) buffer Texels { float items[]; } texels;
// `side`: texels a side of the source's squares.
layout(push_constant, scalar) uniform Push { PyramidLevel source; PyramidLevel doubled; uint side; } push;

void main() {
    uint strips = strips_of(push.doubled.width);
    uint strip = invocation_index();
    if (strip >= strips * push.doubled.height) return;
    uint y = strip / strips;
    uint first = strip % strips * FARTHEST_STRIP;
    uint end = min(first + FARTHEST_STRIP, push.doubled.width);
    uint upper = push.source.first + y * push.source.width;
    uint lower = upper + push.side * push.source.width;
    for (uint x = first; x < end; x++) {
        float left = min(texels.items[upper + x], texels.items[lower + x]);
        float right = min(texels.items[upper + x + push.side], texels.items[lower + x + push.side]);
        texels.items[push.doubled.first + y * push.doubled.width + x] = min(left, right);
    }
}
