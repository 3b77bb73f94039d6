// roc/assign_ranges: which depth range does each object belong to, and how many objects of each chunk does each range's list
// hold? The last range ends at `outermost`; each range before ends at `share` of the next one's end. Second of three steps
// that sort objects into depth ranges (EOVC thesis II.2, iterative occlusion culling). Twin: culling/src/roc/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "select.glsl"
#include "ranges.glsl"

layout(local_size_x = 64) in;
// What begins past the last range is drawn without a test (the thesis); otherwise it belongs to the last range.
layout(constant_id = 0) const bool SHOW_BEYOND = false;
layout(set = 0, binding = 0, scalar) readonly buffer Selected { uint items[]; } selected;
layout(set = 0, binding = 1, scalar) readonly buffer Depths { float items[]; } depths;
// The bits of a float, as roc/measure_boxes leaves them.
layout(set = 0, binding = 2, scalar) readonly buffer Farthest { uint items[]; } farthest;
// The range of each object, and its selection in the lowest bits.
layout(set = 0, binding = 3, scalar) writeonly buffer Places { uint items[]; } places;
// By list and chunk. First the lists of what was seen, by range, then those of all others.
layout(set = 0, binding = 4, scalar) writeonly buffer Counts { uint items[]; } counts;
// range_count: 1 to MOST_RANGES. outermost: metres, or 0 for where the farthest object in view begins. share: 0 to 1.
layout(push_constant, scalar) uniform Push {
    uint first_object;
    uint object_count;
    uint range_count;
    float outermost;
    float share;
} push;

void main() {
    uint chunk = invocation_index();
    uint first = chunk * PACK_CHUNK;
    if (first >= push.object_count) return;
    uint end = min(first + PACK_CHUNK, push.object_count);
    float outermost = push.outermost > 0.0 ? push.outermost : uintBitsToFloat(farthest.items[0]);
    uint list_counts[2u * MOST_RANGES];
    for (uint list = 0u; list < 2u * push.range_count; list++) list_counts[list] = 0u;
    for (uint object = push.first_object + first; object < push.first_object + end; object++) {
        uint selects = selected.items[object];
        uint place = SELECT_NONE;
        if (selects != SELECT_NONE) {
            float depth = depths.items[object];
            bool is_seen = selects == SELECT_SEEN;
            if (SHOW_BEYOND && depth > outermost && !is_seen) selects = SELECT_SHOWN;
            uint range = range_of(depth, outermost, push.range_count, push.share);
            place = range << PLACE_RANGE_SHIFT | selects;
            list_counts[(is_seen ? 0u : push.range_count) + range]++;
        }
        places.items[object] = place;
    }
    uint chunk_count = (push.object_count + PACK_CHUNK - 1u) / PACK_CHUNK;
    for (uint list = 0u; list < 2u * push.range_count; list++)
        counts.items[list * chunk_count + chunk] = list_counts[list];
}
