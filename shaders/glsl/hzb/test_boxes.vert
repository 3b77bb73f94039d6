// hzb/test_boxes: the boxes of what the last frame did not see and the pyramid does not hide, against the depth of all that was drawn:
// to the pixel, where the pyramid knows texels. No colour, no depth is written (hzb-iterative; EOVC thesis II.2, ROC).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "box.glsl"
#include "steps.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
// A command of each object, of which only the object is read; the same buffer as `drawn`.
layout(set = 0, binding = 1, scalar) readonly buffer Commands { DrawCommand items[]; } commands;
layout(set = 0, binding = 2, scalar) readonly buffer Shown { uint items[]; } shown;
layout(set = 0, binding = 3, scalar) readonly buffer ViewBlock { BoxView items[]; } views;

layout(location = 0) flat out uint command;
layout(location = 1) flat out uint object;

invariant gl_Position;

void main() {
    command = gl_InstanceIndex;
    object = commands.items[command].first_instance;
    if (shown.items[object] == STEP_TESTED) {
        gl_Position = clip_from_grown_corner(bounds.items[object], views.items[0], uint(gl_VertexIndex));
    } else {
        // Drawn without a test: a box that reaches the near plane has no picture. This point is outside the view volume.
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    }
}
