// example/count_covered: how many pixels of each row show something. No method's: the example `own_stage` records it after a frame.
// Twin: culling/examples/own_stage.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "grid.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform texture2D depth;
// Of every row, from the top.
layout(set = 0, binding = 1, scalar) writeonly buffer Covered { uint items[]; } covered;
layout(push_constant, scalar) uniform Push { uvec2 size_px; } push;

void main() {
    uint row = invocation_index();
    if (row >= push.size_px.y) return;
    uint count = 0u;
    for (uint column = 0u; column < push.size_px.x; column++) {
        // The far plane is 0: there is nothing.
        count += texelFetch(depth, ivec2(column, row), 0).r > 0.0 ? 1u : 0u;
    }
    covered.items[row] = count;
}
