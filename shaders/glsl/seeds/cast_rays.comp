// seeds/cast_rays: a ray through the middle of each tile of the picture; the object that it meets first is taken for seen. What is met is
// not exact: the cells of a mesh's box that hold triangles stand for the triangles. Nothing depends on it but what is drawn early.
// (The rays are those of EOVC thesis III.4, to find occluders where no last frame tells of them.) Twin: culling/src/seeds/twin.rs
#version 460
#extension GL_GOOGLE_include_directive : require
#include "grid.glsl"
#include "transform.glsl"
#include "seeds.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) readonly buffer Nodes { SeedNode items[]; } nodes;
layout(set = 0, binding = 1, scalar) readonly buffer Shapes { MeshShape items[]; } shapes;
layout(set = 0, binding = 2, scalar) readonly buffer ObjectMeshes { uint items[]; } object_meshes;
layout(set = 0, binding = 3, scalar) readonly buffer Objects { Object items[]; } objects;
layout(set = 0, binding = 4, scalar) readonly buffer Views { SeedView items[]; } views;
layout(set = 0, binding = 5, scalar) buffer Seen { uint items[]; } seen;
// The corners of the tiles of this level, x in the lower half. Not used by level 0: that has all tiles of the picture.
layout(set = 0, binding = 6, scalar) readonly buffer Tiles { uint items[]; } tiles;
// Those of the next level.
layout(set = 0, binding = 7, scalar) writeonly buffer Finer { uint items[]; } finer;
// SEED_GRID_WORDS a level.
layout(set = 0, binding = 8, scalar) buffer Grids { uint words[]; } grids;
layout(set = 0, binding = 9, scalar) readonly buffer Filled { uint words[]; } filled;
layout(push_constant, scalar) uniform Push { uint level; uint tile_px; } push;

const float MISSED = 3.0e38;

struct Ray {
    vec3 origin;        // relative to the camera
    vec3 direction;
    vec3 from_tree;     // the origin, relative to the tree's
    vec3 inverse;
};

// A direction of exactly 0 would give 0 times infinity.
vec3 inverse_of(vec3 direction) {
    return 1.0 / mix(direction, vec3(1.0e-30), lessThan(abs(direction), vec3(1.0e-30)));
}

// Where a ray enters a box, and where it leaves it; it misses if it enters after it leaves.
vec2 through(vec3 low, vec3 high, vec3 origin, vec3 inverse) {
    vec3 one = (low - origin) * inverse;
    vec3 other = (high - origin) * inverse;
    vec3 enter = min(one, other);
    vec3 leave = max(one, other);
    return vec2(max(max(enter.x, enter.y), max(enter.z, 0.0)), min(min(leave.x, leave.y), leave.z));
}

float enters(SeedNode node, Ray ray) {
    vec2 along = through(node.low, node.high, ray.from_tree, ray.inverse);
    return along.x <= along.y ? along.x : MISSED;
}

bool is_filled(uint mesh, uvec3 cells, ivec3 cell) {
    uint bit = uint(cell.x) + cells.x * (uint(cell.y) + cells.y * uint(cell.z));
    return (filled.words[mesh * SHAPE_WORDS + bit / 32u] >> (bit % 32u) & 1u) != 0u;
}

// Where a ray first meets a filled cell of an object's mesh, if before `nearest`.
float meets(uint index, Ray ray, float nearest) {
    Object object = objects.items[index];
    uint mesh = object_meshes.items[index];
    vec3 from = ray.origin
        - relative_from_split(object.origin_high, object.origin_low, views.items[0].camera_high, views.items[0].camera_low);
    // The rows of the inverse, times the determinant.
    vec3 row_x = cross(object.column_y, object.column_z);
    vec3 row_y = cross(object.column_z, object.column_x);
    vec3 row_z = cross(object.column_x, object.column_y);
    float determinant = dot(object.column_x, row_x);
    if (determinant == 0.0) return MISSED;
    uvec3 count = uvec3(shapes.items[mesh].cells[0], shapes.items[mesh].cells[1], shapes.items[mesh].cells[2]);
    vec3 cells = vec3(count) / shapes.items[mesh].size;
    vec3 origin = (vec3(dot(row_x, from), dot(row_y, from), dot(row_z, from)) / determinant - shapes.items[mesh].low) * cells;
    vec3 direction = vec3(dot(row_x, ray.direction), dot(row_y, ray.direction), dot(row_z, ray.direction)) / determinant * cells;
    vec3 inverse = inverse_of(direction);
    vec2 along = through(vec3(0.0), vec3(count), origin, inverse);
    float at = along.x;
    float last = min(along.y, nearest);
    ivec3 cell = clamp(ivec3(floor(origin + direction * at)), ivec3(0), ivec3(count) - 1);
    ivec3 step = ivec3(mix(vec3(-1.0), vec3(1.0), greaterThanEqual(inverse, vec3(0.0))));
    vec3 next = (vec3(cell + max(step, ivec3(0))) - origin) * inverse;
    while (at <= last) {
        // The eye stands in a cell that is filled in part: what of it is in view is not known.
        if (at > 0.0 && is_filled(mesh, count, cell)) return at;
        at = min(next.x, min(next.y, next.z));
        uint axis = next.x == at ? 0u : next.y == at ? 1u : 2u;
        cell[axis] += step[axis];
        next[axis] += abs(inverse[axis]);
        if (uint(cell[axis]) >= count[axis]) break;
    }
    return MISSED;
}

// What a ray meets first; TREE_NONE for nothing.
struct Hit {
    uint object;
    float at;
    float across;       // the middle one of the sides of its box
};

// Goes down the hierarchy, nearer children first: to the next leaf, which all invocations of a subgroup then look at together.
Hit first_hit(Ray ray) {
    Hit hit = Hit(TREE_NONE, MISSED, MISSED);
    uint waiting[SEED_STACK];
    float from[SEED_STACK];
    uint count = 1u;
    waiting[0] = 0u;
    from[0] = enters(nodes.items[0], ray);
    uint visits = 0u;
    while (count > 0u && visits < SEED_VISITS) {
        uint leaf = TREE_NONE;
        while (count > 0u && leaf == TREE_NONE && visits < SEED_VISITS) {
            visits++;
            count--;
            uint node = waiting[count];
            if (from[count] >= hit.at) continue;
            uint first = nodes.items[node].first;
            if (nodes.items[node].is_leaf != 0u) {
                leaf = node;
                continue;
            }
            float one = enters(nodes.items[first], ray);
            float other = enters(nodes.items[first + 1u], ray);
            uint turned = other < one ? 1u : 0u;
            float near = min(one, other);
            float far = max(one, other);
            if (far < hit.at && count + 1u < SEED_STACK) {
                waiting[count] = first + 1u - turned;
                from[count++] = far;
            }
            if (near < hit.at && count < SEED_STACK) {
                waiting[count] = first + turned;
                from[count++] = near;
            }
        }
        if (leaf == TREE_NONE) break;
        SeedNode here = nodes.items[leaf];
        float at = meets(here.first, ray, hit.at);
        if (at < hit.at) {
            vec3 size = here.high - here.low;
            hit = Hit(here.first, at, max(min(size.x, size.y), min(max(size.x, size.y), size.z)));
        }
    }
    return hit;
}

Ray ray_through(SeedView view, vec2 px) {
    vec2 at = px / vec2(view.width_px, view.height_px) * 2.0 - 1.0;
    Ray ray;
    ray.origin = view.origin[0] + at.x * view.origin[1] + at.y * view.origin[2];
    ray.direction = view.direction[0] + at.x * view.direction[1] + at.y * view.direction[2];
    ray.from_tree = ray.origin + view.tree_from_camera;
    ray.inverse = inverse_of(ray.direction);
    return ray;
}

// Takes an object for seen. True if no larger tile had met it: rays of a level leave a mark of their own, so that none takes for known
// what another has just met.
bool note_hit(uint object) {
    uint mark = push.level + 2u;
    uint before = seen.items[object];
    bool is_new = before == 0u || before == mark;
    if (is_new) seen.items[object] = mark;
    return is_new;
}

void quarter(uvec2 corner, uint half_px) {
    uint header = (push.level + 1u) * SEED_GRID_WORDS;
    for (uint part = 0u; part < 4u; part++) {
        uvec2 own = corner + half_px * uvec2(part & 1u, part >> 1u);
        if (own.x >= views.items[0].width_px || own.y >= views.items[0].height_px) continue;
        uint place = atomicAdd(grids.words[header + 3u], 1u);
        if (place % 64u == 0u) atomicAdd(grids.words[header], 1u);
        finer.items[place] = own.x | own.y << 16u;
    }
}

void main() {
    SeedView view = views.items[0];
    uint index = invocation_index();
    uint tiles_x = (view.width_px + push.tile_px - 1u) / push.tile_px;
    uint tiles_y = (view.height_px + push.tile_px - 1u) / push.tile_px;
    uint listed = grids.words[push.level * SEED_GRID_WORDS + 3u];
    uint tile_count = push.level == 0u ? tiles_x * tiles_y : listed > SEED_MOST_TILES ? 0u : listed;
    if (index >= tile_count) return;
    uvec2 corner = uvec2(index % tiles_x, index / tiles_x) * push.tile_px;
    if (push.level > 0u) corner = uvec2(tiles.items[index] & 0xffffu, tiles.items[index] >> 16u);
    Ray ray = ray_through(view, vec2(corner) + 0.5 * float(push.tile_px));
    Hit hit = first_hit(ray);
    bool is_new = push.level == 0u;
    if (hit.object != TREE_NONE) is_new = note_hit(hit.object);
    // Without a hit it is as far as there is anything.
    else hit.at = through(nodes.items[0].low, nodes.items[0].high, ray.from_tree, ray.inverse).y;
    bool is_small = min(hit.across, view.usual_size) * view.px_per_unit < float(push.tile_px) * hit.at;
    if (is_small && is_new && push.tile_px / 2u >= view.finest_px) quarter(corner, push.tile_px / 2u);
}
