// engine/resolve_depth: one depth a pixel, of those of its samples: the farthest, so that what is behind it is behind all of them. As it is
// kept, whichever way around.
// No twin: it is the least or the greatest of some numbers; tests/tests/samples.rs holds it to the samples that the host reads.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 8, local_size_y = 8) in;
// The least is kept, otherwise the greatest.
layout(constant_id = 0) const bool LEAST = true;
layout(set = 0, binding = 0) uniform texture2DMS depth;
layout(set = 0, binding = 1, scalar) writeonly buffer Resolved { float items[]; } resolved;
layout(push_constant, scalar) uniform Push { uvec2 size_px; uint samples; } push;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.size_px))) return;
    float kept = texelFetch(depth, at, 0).r;
    for (int index = 1; index < int(push.samples); index++) {
        float other = texelFetch(depth, at, index).r;
        kept = LEAST ? min(kept, other) : max(kept, other);
    }
    resolved.items[gl_GlobalInvocationID.y * push.size_px.x + gl_GlobalInvocationID.x] = kept;
}
