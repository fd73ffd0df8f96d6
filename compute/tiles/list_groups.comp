// Lists the groups of each pass that have work: an invocation asks for one group whether there is material in its part of the
// image, or lists the entry points that the surfaces of one block need.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#define GROUP_SIDE PELLUCID_LIST_GROUP
#include "tiles/tile_commands.glsl"
#include "tiles/cells.glsl"
#include "tiles/block_entries.glsl"

const uint kInvocations = uint(PELLUCID_LIST_GROUP * PELLUCID_LIST_GROUP);

shared uint listed, firstInList;
shared uint someMaterial; // in the image

// Looks at all blocks.
void findSomeMaterial(uint invocation) {
  for (uint i = invocation; i < frame.blocks.x * frame.blocks.y; i += kInvocations)
    if ((readTileWord(uint(PELLUCID_BLOCK_WORDS) * i) | readTileWord(uint(PELLUCID_BLOCK_WORDS) * i + 1u)) != 0u)
      someMaterial = 1u; // whoever writes, writes this
}

// Whether a group runs, and whether all that it reads of the pass before has been written.
Material materialOf(GroupList groups, uvec2 place) {
  ivec2 first = groups.places.xy + ivec2(place) * groups.places.zw;
  ivec4 part = ivec4(first, first + groups.size.xy);
  if (groups.size.z == PELLUCID_RUNS_WITH_ANY) return Material(someMaterial != 0u, false);
  if (groups.size.z == PELLUCID_RUNS_WITH_BLOCKS) return materialOfBlocks(blocksOf(part));
  Material cells = materialOfCells(part);
  if (groups.size.z == PELLUCID_RUNS_BESIDE_BLOCKS) cells.some = materialOfBlocks(withNeighbors(blocksOf(part))).some;
  return cells;
}

void main() {
  uint group = gl_WorkGroupID.x, invocation = gl_LocalInvocationIndex, list = PELLUCID_LIST_TILES;
  // Alike in all invocations.
  [[unroll]] for (uint i = 1u; i < uint(PELLUCID_LISTS); ++i)
    if (group >= frame.listGroups[i >> 2][i & 3u]) list = i;
  GroupList groups = tiles.groups[list];
  uint index = (group - frame.listGroups[list >> 2][list & 3u]) * kInvocations + invocation;
  if (invocation == 0u) listed = someMaterial = 0u;
  barrier();
  if (groups.size.z == PELLUCID_RUNS_WITH_ANY) findSomeMaterial(invocation);
  barrier();
  uvec2 place = uvec2(index % max(groups.count.x, 1u), index / max(groups.count.x, 1u));
  Material material = Material(false, false);
  if (list < PELLUCID_LIST_ENTRY_POINTS && place.y < groups.count.y) material = materialOf(groups, place);
  uint at = material.some ? atomicAdd(listed, 1u) : 0u;
  barrier();
  if (invocation == 0u && listed != 0u) firstInList = addToList(list, listed);
  barrier();
  if (material.some) writeTileWord(listPlace(list) + firstInList + at, packGroup(place, material.all));
  if (list == PELLUCID_LIST_ENTRY_POINTS) {
    // An invocation does a row of the groups of a map for a block; blocks and their marks come first.
    uint blocks = frame.blocks.x * frame.blocks.y;
    if (index < blocks) {
      markNear(index);
    } else if (index < blocks * (1u + kEntryGroupRows * tiles.maps.x)) {
      uint row = (index - blocks) % kEntryGroupRows, rest = (index - blocks) / kEntryGroupRows;
      listEntryGroups(rest / blocks, rest % blocks, int(row));
    }
  }
}
