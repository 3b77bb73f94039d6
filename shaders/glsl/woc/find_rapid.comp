// woc/find_rapid: which objects of the last frame have moved so far since then that warping may fail for them? Those of whose box a
// corner moved, seen by an eye that only steps and does not turn, farther than the threshold in the canonical view volume (-1 to 1
// in x and y, 0 to 1 in depth), or lies behind the eye before or after (Kim 2015, IV.1). Twin: culling/src/woc/twin.rs
//
// The thesis counts what a turn of the camera does to a corner too: then everything is rapid, and half the scene is drawn first.
// But a turn is warped exactly. What a step does stays counted: to draw that first measures better (culling/README.md).
//
// Only what the last frame drew is looked at, by its draw list: invocations stride over the commands that count.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "cull.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Commands { DrawCommand items[]; } commands;
layout(set = 0, binding = 1, scalar) readonly buffer Count { uint items[]; } count;
// By object: it is in view now.
layout(set = 0, binding = 2, scalar) readonly buffer Kept { uint items[]; } kept;
layout(set = 0, binding = 3, scalar) readonly buffer BoundsBefore { Bounds items[]; } bounds_before;
layout(set = 0, binding = 4, scalar) readonly buffer BoundsNow { Bounds items[]; } bounds_now;
// The last view, then this one.
layout(set = 0, binding = 5, scalar) readonly buffer Views { CullView items[]; } views;
// By object: 1 if it is rapid; others stay as they are.
layout(set = 0, binding = 6, scalar) buffer Rapid { uint items[]; } rapid;
layout(push_constant, scalar) uniform Push { float threshold; uint first_command; } push;

vec4 corner_of(ClipBox box, uint corner) {
    return box.centre + ((corner & 1u) != 0u ? box.axis_x : -box.axis_x) + ((corner & 2u) != 0u ? box.axis_y : -box.axis_y)
        + ((corner & 4u) != 0u ? box.axis_z : -box.axis_z);
}

bool is_rapid(Bounds before, Bounds now) {
    if ((now.flags & OBJECT_ALWAYS_KEPT) != 0u) return false;
    // How the last frame's eye would see, turned as this frame's is.
    CullView turned = views.items[1];
    turned.camera_high = views.items[0].camera_high;
    turned.camera_low = views.items[0].camera_low;
    ClipBox from = clip_from_bounds(before, turned);
    ClipBox to = clip_from_bounds(now, views.items[1]);
    bool far_enough = false;
    for (uint corner = 0u; corner < 8u; corner++) {
        vec4 start = corner_of(from, corner);
        vec4 end = corner_of(to, corner);
        vec3 way = end.xyz / end.w - start.xyz / start.w;
        // Said so that NaN is rapid: to draw an object first is always right.
        if (!(start.w > 0.0 && end.w > 0.0 && dot(way, way) <= push.threshold * push.threshold)) far_enough = true;
    }
    return far_enough;
}

void main() {
    uint commands_that_count = count.items[0];
    for (uint index = invocation_index(); index < commands_that_count; index += RAPID_INVOCATIONS) {
        uint place = push.first_command + index;
        uint object = commands.items[place].first_instance;
        if (commands.items[place].instance_count != 0u && kept.items[object] != 0u
            && is_rapid(bounds_before.items[object], bounds_now.items[object]))
            rapid.items[object] = 1u;
    }
}
