// frustum/test_shapes: which objects are outside the view volume, by the sphere around their world box, by the box of their mesh as
// the object turns it, or by the sphere first and the box where that cannot tell (Zachmann, VFC; GPU Gems 29.6.4)? World boxes
// alone are frustum/test_bounds. Twin: culling/src/frustum/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shape.glsl"

layout(local_size_x = 64) in;
// SHAPE_*.
layout(constant_id = 0) const uint SHAPE = 1u;
layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) writeonly buffer Kept { uint items[]; } kept;
// The blocks in view; objects of others keep what `kept` says.
layout(set = 0, binding = 2, scalar) readonly buffer Blocks { uint words[]; } blocks;
layout(set = 0, binding = 3, scalar) readonly buffer Objects { Object items[]; } objects;
layout(set = 0, binding = 4, scalar) readonly buffer ObjectMeshes { uint items[]; } object_meshes;
// By mesh; looked at by oriented boxes alone.
layout(set = 0, binding = 5, scalar) readonly buffer LocalBoxes { LocalBox items[]; } local_boxes;
layout(push_constant, scalar) uniform Push { CullView view; uint object_count; } push;
#include "blocks.glsl"

void main() {
    uint object = object_in_view();
    if (object >= push.object_count) return;
    Bounds bound = bounds.items[object];
    bool left_out = false;
    if ((bound.flags & OBJECT_ALWAYS_KEPT) == 0u) {
        LocalBox local = LocalBox(vec3(0.0), vec3(0.0));
        if (SHAPE == SHAPE_ORIENTED) local = local_boxes.items[object_meshes.items[object]];
        uint planes = 0u;
        left_out = shape_outside(SHAPE, bound, objects.items[object], local, push.view, planes)
            || too_small(clip_from_bounds(bound, push.view), push.view);
    }
    kept.items[object] = left_out ? 0u : 1u;
}
