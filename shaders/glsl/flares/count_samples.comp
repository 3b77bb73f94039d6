// flares/count_samples: flares/count_block where pixels have several samples: each of them counts, as it does in the query.
// Twin: culling/src/flares/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "flare.glsl"
#include "shows.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform texture2DMS depth;
layout(set = 0, binding = 1, scalar) buffer Visible { uint items[]; } visible;
layout(push_constant, scalar) uniform Push { FlareBlock block; uint samples; } push;

void main() {
    uvec2 at_px = push.block.from_px + gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at_px, push.block.to_px))) return;
    uint showing = 0u;
    for (int index = 0; index < int(push.samples); index++) {
        showing += shows(texelFetch(depth, ivec2(at_px), index).r, push.block.depth) ? 1u : 0u;
    }
    atomicAdd(visible.items[0], showing);
}
