// What lies above a node that a pixel saw into is seen into as well. The stage declares nodes, touched and push.frame before.
//
// A trap of llvmpipe: fragments that the early tests have stopped still walk through the shader in their vector's other lanes,
// with loads that give 0 and atomics that do nothing. A loop that ends by what it loads goes on for them to its limit of 65,535
// iterations (measured: 9 s a frame). So loops in fragment shaders are entered by living fragments only, which are those that
// read a node with an object in it.
#ifndef TOUCH_GLSL
#define TOUCH_GLSL

bool lives(uint node) {
    return nodes.items[node].object_count != 0u;
}

// Marks the way from a node to the root, as far as nobody has.
void touch_above(uint node) {
    uint above = nodes.items[node].parent;
    while (above != TREE_NONE && atomicExchange(touched.items[above], push.frame) != push.frame) above = nodes.items[above].parent;
}
#endif
