// Which kind of draw an object belongs to: for stages of hzb-iterative that count or write by kind.
#ifndef KINDS_GLSL
#define KINDS_GLSL
#include "steps.glsl"

// How many kinds there are, at least 1: most scenes have one, and pay for no more.
layout(constant_id = 6) const uint KIND_COUNT = 1u;

uint kind_of(uint object, StepView all) {
    uint kind = 0u;
    for (uint later = 1u; later < KIND_COUNT; later++) kind += object >= all.later_kinds[later - 1u] ? 1u : 0u;
    return kind;
}
#endif
