// frustum/count_planes: against how many planes are objects tested, one plane after the other until they are outside of one? Runs in
// frames that count work alone, and decides nothing. Twin: culling/src/frustum/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "shape.glsl"

layout(local_size_x = 64) in;
// SHAPE_*.
layout(constant_id = 0) const uint SHAPE = 0u;
// Looks at every one of `bounds`, instead of those in blocks in view.
layout(constant_id = 1) const bool ALL = false;
layout(set = 0, binding = 0, scalar) readonly buffer AllBounds { Bounds items[]; } bounds;
layout(set = 0, binding = 1, scalar) readonly buffer Blocks { uint words[]; } blocks;
layout(set = 0, binding = 2, scalar) readonly buffer Objects { Object items[]; } objects;
layout(set = 0, binding = 3, scalar) readonly buffer ObjectMeshes { uint items[]; } object_meshes;
layout(set = 0, binding = 4, scalar) readonly buffer LocalBoxes { LocalBox items[]; } local_boxes;
layout(set = 0, binding = 5, scalar) buffer Planes { uint items[]; } planes;
layout(push_constant, scalar) uniform Push { CullView view; uint count; } push;
#include "blocks.glsl"

void main() {
    uint object = ALL ? invocation_index() : object_in_view();
    if (object >= push.count) return;
    Bounds bound = bounds.items[object];
    if ((bound.flags & OBJECT_ALWAYS_KEPT) != 0u) return;
    LocalBox local = LocalBox(vec3(0.0), vec3(0.0));
    Object placed = objects.items[SHAPE == SHAPE_ORIENTED ? object : 0u];
    if (SHAPE == SHAPE_ORIENTED) local = local_boxes.items[object_meshes.items[object]];
    uint tested = 0u;
    shape_outside(SHAPE, bound, placed, local, push.view, tested);
    atomicAdd(planes.items[0], tested);
}
