// roc/test_boxes: a fragment of a box is open, so what is in the box may show.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(early_fragment_tests) in;
layout(location = 0) flat in uint object;
layout(set = 0, binding = 3, scalar) writeonly buffer Newly { uint items[]; } newly;

void main() {
    newly.items[object] = 1u;
}
