// flares/test_block: the block of pixels where a light is on the screen, at the light's depth, within an occlusion query: how much of it
// nothing hides (GPU Gems 29.8.2). No colour and no depth is written. Its edges are pixels' edges, so that no rule for edges decides, and its
// corners are all as deep, so that no rounding of slopes does.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "flare.glsl"

layout(push_constant, scalar) uniform Push { FlareBlock block; } push;

void main() {
    const uint corners[6] = uint[6](0u, 1u, 2u, 2u, 1u, 3u);
    uint corner = corners[gl_VertexIndex];
    uvec2 at_px = uvec2((corner & 1u) != 0u ? push.block.to_px.x : push.block.from_px.x,
        (corner & 2u) != 0u ? push.block.to_px.y : push.block.from_px.y);
    gl_Position = vec4(vec2(at_px) / vec2(push.block.size_px) * 2.0 - 1.0, push.block.depth, 1.0);
}
