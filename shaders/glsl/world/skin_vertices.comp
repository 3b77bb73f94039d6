// world/skin_vertices: puts each vertex that joints carry where the mean of their places puts it, and turns its normal (glTF 2.0, 3.7.3.3).
// Bounds allow for what this rounds: scenes/src/moving/bent.rs counts the operations. Twin: culling/src/world/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "skin.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Rest { RestVertex items[]; } rest;
layout(set = 0, binding = 1, scalar) readonly buffer Places { JointPlace items[]; } places;
// Vertices that begin with a position and a normal, whatever follows.
layout(set = 0, binding = 2, scalar) writeonly buffer Vertices { uint words[]; } vertices;
layout(push_constant, scalar) uniform Push {
    uint vertex_count;
    uint first_word;        // of the first that is written; they lie side by side
    uint stride_words;
} push;

uint snorm16(float part) {
    return uint(int(floor(clamp(part, -1.0, 1.0) * 32767.0 + 0.5))) & 0xffffu;
}

// A direction folded onto an octahedron; +z if it has none.
uint octahedron(vec3 normal) {
    float sum = abs(normal.x) + abs(normal.y) + abs(normal.z);
    vec2 folded = sum > 0.0 ? normal.xy / sum : vec2(0.0);
    if (normal.z < 0.0)
        folded = vec2(normal.x < 0.0 ? abs(folded.y) - 1.0 : 1.0 - abs(folded.y), normal.y < 0.0 ? abs(folded.x) - 1.0 : 1.0 - abs(folded.x));
    return snorm16(folded.x) | snorm16(folded.y) << 16u;
}

void main() {
    uint index = invocation_index();
    if (index >= push.vertex_count) return;
    RestVertex vertex = rest.items[index];
    JointPlace a = places.items[vertex.joints.x];
    JointPlace b = places.items[vertex.joints.y];
    JointPlace c = places.items[vertex.joints.z];
    JointPlace d = places.items[vertex.joints.w];
    vec4 w = vertex.weights;
    precise vec3 x = a.column_x * w.x + b.column_x * w.y + c.column_x * w.z + d.column_x * w.w;
    precise vec3 y = a.column_y * w.x + b.column_y * w.y + c.column_y * w.z + d.column_y * w.w;
    precise vec3 z = a.column_z * w.x + b.column_z * w.y + c.column_z * w.z + d.column_z * w.w;
    precise vec3 shift = a.shift * w.x + b.shift * w.y + c.shift * w.z + d.shift * w.w;
    precise vec3 position = x * vertex.position.x + y * vertex.position.y + z * vertex.position.z + shift;
    // By the cofactors, which is right for mirrored and flattened places too, as in draw/objects.
    vec3 normal = cross(y, z) * vertex.normal.x + cross(z, x) * vertex.normal.y + cross(x, y) * vertex.normal.z;
    uint at = push.first_word + index * push.stride_words;
    vertices.words[at] = floatBitsToUint(position.x);
    vertices.words[at + 1u] = floatBitsToUint(position.y);
    vertices.words[at + 2u] = floatBitsToUint(position.z);
    vertices.words[at + 3u] = octahedron(normal);
}
