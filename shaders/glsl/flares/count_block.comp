// flares/count_block: how many pixels of a light's block the finished depth leaves visible: the truth that the query of flares/test_block
// is held to. Whole numbers are added, so that their order does not show. Never in timed frames.
// Twin: culling/src/flares/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "flare.glsl"
#include "shows.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform texture2D depth;
layout(set = 0, binding = 1, scalar) buffer Visible { uint items[]; } visible;
layout(push_constant, scalar) uniform Push { FlareBlock block; } push;

void main() {
    uvec2 at_px = push.block.from_px + gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at_px, push.block.to_px))) return;
    if (shows(texelFetch(depth, ivec2(at_px), 0).r, push.block.depth)) atomicAdd(visible.items[0], 1u);
}
