// Structs that more than one stage reads, and the constants that GLSL and Rust share. Scalar layout everywhere.
#ifndef TYPES_GLSL
#define TYPES_GLSL
#extension GL_EXT_scalar_block_layout : require

// Objects whose raster footprint is wider than their geometry: lines and points cover a pixel around them.
const uint OBJECT_WIDE_RASTER = 1u;
// Moves: its transform and bounds are written again each frame.
const uint OBJECT_DYNAMIC = 2u;
// Bounds without a meaning (NaN, infinite): never tested, always kept.
const uint OBJECT_ALWAYS_KEPT = 4u;

// Objects that lie side by side and have bounds in common.
const uint BLOCK_OBJECTS = 64u;

// How many visibility flags one invocation of the packing stages walks.
const uint PACK_CHUNK = 64u;

// How many objects one invocation of eovc/mark_paths looks at.
const uint MARK_CHUNK = 8u;

// Pixels of a column that one invocation of eovc/filter_occluders looks at.
const uint FILTER_STRIP = 16u;

// No object: the item buffer where nothing was drawn.
const uint ITEM_NONE = 0xffffffffu;

// One mesh primitive in the world. The translation is split in two floats (origin_high + origin_low), so that the
// difference to the camera keeps about 48 bits: nothing shakes 10^6 m from the origin.
struct Object {
    vec3 column_x;      // linear part of world-from-object
    vec3 column_y;
    vec3 column_z;
    vec3 origin_high;
    vec3 origin_low;
    uint colour;        // RGBA8, linear, red in the lowest byte
};

// World bounds of an object: a box rounded outward on the host by the error of transforming its vertices on the GPU.
struct Bounds {
    vec3 centre_high;
    vec3 centre_low;
    vec3 half_extent;
    uint flags;         // OBJECT_*
};

// What lies beyond a texture's borders.
const uint WRAP_REPEAT = 0u;
const uint WRAP_MIRROR = 1u;
const uint WRAP_CLAMP = 2u;
// Bits of Material.wrap for x; those for y follow.
const uint WRAP_BITS = 2u;

// Where a base colour texture lies among the texels, and where its surface has holes.
struct Material {
    uint first_texel;   // of level 0; each level follows the one before, with half of its texels a side
    uint width, height; // of level 0, in texels
    uint levels, wrap;  // levels: 0 for no texture; wrap: WRAP_*, x in the lowest bits
    float alpha;        // alpha of the material, times that of the vertices if it is the same for the whole mesh
    uint alpha_varies;  // 1 where the vertices of a mesh differ in alpha
    float cutoff;       // The surface is there where alpha is at least this. Allows for the rounding of alpha.
};

// Where a mesh lies in the shared index and vertex buffers.
struct MeshRange {
    uint first_index;
    uint index_count;
    int vertex_offset;
};

// A moving object's place this frame.
struct MovedObject {
    uint index;
    Object object;
    Bounds bounds;
};

// The same where its bounds stay as they were.
struct MovedTransform {
    uint index;
    Object object;
};

// VkDrawIndexedIndirectCommand. first_instance is the object's index.
struct DrawCommand {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

// What one frame looks through. Positions that the matrix takes are relative to the camera and unrotated.
struct View {
    mat4 clip_from_relative;
    vec3 camera_high;
    vec3 camera_low;
};

// How far a sample may lie from its pixel's centre, where pixels have several.
const float SAMPLE_REACH_PX = 0.5;

// A view as bounds tests need it: the matrix, the target's size and how exactly the device snaps vertices.
struct CullView {
    mat4 clip_from_relative;
    vec3 camera_high;
    vec3 camera_low;
    uint width_px;
    uint height_px;
    float snap_px;      // the device rounds vertex positions to this grid, pixels; 0.5 more where pixels have several samples, and their stray
    float detail_px;    // what is smaller on the screen is left out; 0 leaves out nothing
};

// Where a level of the farthest-depth pyramid lies in its buffer.
struct PyramidLevel {
    uint first;
    uint width;
    uint height;
};

// What box rasterisation and ray casting look through: more than push constants hold.
struct BoxView {
    CullView view;
    vec4 eye;               // the eye relative to the camera: (0, 0, 0, 1), or a direction with w = 0
    vec3 origin[3];         // a pixel's ray starts at origin[0] + x origin[1] + y origin[2], x and y in -1..1
    vec3 direction[3];      // and goes along direction[0] + x direction[1] + y direction[2]
};

// A node of the geometry-level hierarchy. Children lie side by side: first_child and first_child + 1.
struct TreeNode {
    Bounds bounds;
    uint first_child;       // or the object of a leaf
    uint parent;            // TREE_NONE for the root
    uint is_leaf;
    uint object_count;      // leaves below, itself included
};

const uint TREE_NONE = 0xffffffffu;

// Groups of more objects are opened, so that a ray meets few enough nodes: lavapipe ends the loops of an invocation at
// 65,535 iterations without a word. A ray looks at 2 x this nodes at most, climbs as often, and notes hits as often.
const uint RAY_OBJECTS = 4096u;

// Levels of the hierarchy that one pass of eovc/cull_groups goes down: 31 nodes an invocation at most.
const uint CULL_LEVELS = 4u;

// Frames for which a group that a pixel has seen into stays open, at least; at most twice as many, so that not all close at once.
const uint OPEN_FRAMES = 32u;

// Words of a pass's grid: work groups in x, y and z, then how many nodes are listed.
const uint GRID_WORDS = 4u;

// EOVC's lists by number: marked nodes, then what the passes of eovc/cull_groups start from.
const uint MARKED_LIST = 0u;
const uint FIRST_CULL_LIST = 1u;
#endif
