// world/skin_vertices: displaces each vertex of a deformed mesh by morph targets, then bends it by the mean place of its joints (glTF 2.0, 3.7.2.2 and 3.7.3.3).
// Bounds allow for this rounding: scenes/src/moving/bent.rs and morphed.rs count the operations. Twin: culling/src/world/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "skin.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Rest { RestVertex items[]; } rest;
layout(set = 0, binding = 1, scalar) readonly buffer Influences { Influence items[]; } influences;
layout(set = 0, binding = 2, scalar) readonly buffer Displacements { Displacement items[]; } displacements;
layout(set = 0, binding = 3, scalar) readonly buffer Places { JointPlace items[]; } places;
// Weights of morph targets, indexed by weight.
layout(set = 0, binding = 4, scalar) readonly buffer Weights { float items[]; } weights;
// Vertices that begin with a position and a normal, whatever follows.
layout(set = 0, binding = 5, scalar) writeonly buffer Vertices { uint words[]; } vertices;
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
    precise vec3 position = vertex.position;
    vec3 normal = vertex.normal;
    for (uint at = 0u; at < vertex.displacement_count; at++) {
        Displacement displacement = displacements.items[vertex.first_displacement + at];
        float weight = weights.items[displacement.weight];
        position = position + displacement.position * weight;
        normal += displacement.normal * weight;
    }
    if (vertex.influence_count > 0u) {
        precise vec3 x = vec3(0.0);
        precise vec3 y = vec3(0.0);
        precise vec3 z = vec3(0.0);
        precise vec3 shift = vec3(0.0);
        for (uint at = 0u; at < vertex.influence_count; at++) {
            Influence influence = influences.items[vertex.first_influence + at];
            JointPlace place = places.items[influence.place];
            x = x + place.column_x * influence.share;
            y = y + place.column_y * influence.share;
            z = z + place.column_z * influence.share;
            shift = shift + place.shift * influence.share;
        }
        position = x * position.x + y * position.y + z * position.z + shift;
        // The cofactors are right for mirrored and flattened places too, as in draw/objects.
        normal = cross(y, z) * normal.x + cross(z, x) * normal.y + cross(x, y) * normal.z;
    }
    uint at = push.first_word + index * push.stride_words;
    vertices.words[at] = floatBitsToUint(position.x);
    vertices.words[at + 1u] = floatBitsToUint(position.y);
    vertices.words[at + 2u] = floatBitsToUint(position.z);
    vertices.words[at + 3u] = octahedron(normal);
}
