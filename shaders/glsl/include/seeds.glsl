// What rays meet first, roughly: a small tree over objects' boxes and, for each mesh, which cells of its box hold triangles.
#ifndef SEEDS_GLSL
#define SEEDS_GLSL
#include "types.glsl"

// A node of the tree. Children lie side by side. Positions are relative to the tree's own origin.
struct SeedNode {
    vec3 low;
    uint first;         // child, or the object of a leaf
    vec3 high;
    uint is_leaf;
};

// Bits of a mesh's shape: its box is halved so often, across the longest side of its cells each time.
const uint SHAPE_HALVINGS = 12u;
const uint SHAPE_WORDS = 128u;

// The box of a mesh and its cells. Bit x + cells.x (y + cells.y z) of the mesh's SHAPE_WORDS says whether a cell holds triangles.
struct MeshShape {
    vec3 low;           // of its box, in object space
    vec3 size;          // > 0 in each axis
    uint cells[3];
};

// A picture's rays: origin[0] + x origin[1] + y origin[2] and likewise for directions, x and y in -1..1.
struct SeedView {
    vec3 camera_high;
    vec3 camera_low;
    vec3 tree_from_camera;  // the camera, seen from the tree's origin
    vec3 origin[3];         // relative to the camera
    vec3 direction[3];
    uint width_px;
    uint height_px;
    uint finest_px;         // tiles are not cut any further
    float usual_size;       // of objects, metres
    float px_per_unit;      // how wide a unit is on the screen where a ray's parameter is 1
};

// Words of a level's grid: work groups in x, y and z, then how many tiles are listed.
const uint SEED_GRID_WORDS = 4u;

// A finer level of more tiles than this is not cast: such a crowd costs more rays than it hides.
const uint SEED_MOST_TILES = 16384u;

// Objects that rays wait for are kept in so many places at most; beyond that they are forgotten.
const uint SEED_STACK = 48u;
// Nodes a ray looks at, at most: worlds in which more overlap are not worth looking for.
const uint SEED_VISITS = 2048u;
#endif
