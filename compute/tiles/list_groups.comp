// Lists the groups of each pass that have work: an invocation asks for one group whether there is material in its part of the
// image, or lists the entry points that the surfaces of one block need.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_LIST_GROUP
#include "tiles/tile_commands.glsl"
#include "tiles/group_material.glsl"
#include "tiles/block_entries.glsl"

shared uint listed, firstInList;

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
