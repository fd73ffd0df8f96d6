// The buffer of lists of blocks.
#ifndef PELLUCID_LISTS_GLSL
#define PELLUCID_LISTS_GLSL

#include "frame/blocks.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LISTS) buffer Lists {
  BlockLists lists;
  uint listWords[]; // counters of blocks, then for each map a bit for each group of its entry points that is listed
};

uint counterWords() { return (blockCount() + 1u) / 2u; }

#endif
