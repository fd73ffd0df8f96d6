// Decides which groups run.
#ifndef PELLUCID_GROUP_MATERIAL_GLSL
#define PELLUCID_GROUP_MATERIAL_GLSL

#include "tiles/cells.glsl"

const uint kInvocations = uint(PELLUCID_LIST_GROUP * PELLUCID_LIST_GROUP);

shared uint someMaterial; // in the image

// Looks at all blocks.
void findSomeMaterial(uint invocation) {
  for (uint i = invocation; i < frame.blocks.x * frame.blocks.y; i += kInvocations)
    if (bitsOfBlock(uint(PELLUCID_BLOCK_WORDS) * i) != 0u) someMaterial = 1u; // whoever writes, writes this
}

// Material of a group's part: some makes it run, and all says that all it reads of the pass before has been written.
Material materialOf(GroupList groups, uvec2 place) {
  ivec2 first = groups.places.xy + ivec2(place) * groups.places.zw;
  ivec4 part = ivec4(first, first + groups.size.xy);
  if (groups.size.z == PELLUCID_RUNS_WITH_ANY) return Material(someMaterial != 0u, false);
  if (groups.size.z == PELLUCID_RUNS_WITH_BLOCKS) return materialOfBlocks(blocksOf(part));
  Material cells = materialOfCells(part);
  if (groups.size.z == PELLUCID_RUNS_BESIDE_BLOCKS) cells.some = materialOfBlocks(withNeighbors(blocksOf(part))).some;
  return cells;
}

#endif
