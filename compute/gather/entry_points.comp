// Makes the entry points of a dispatch's shadow maps, below each other in one image. A group makes 16x16 of one map, each of the
// texel in the middle of those that it stands for.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_ENTRY_POINTS_GROUP
#include "frame/blocks.glsl"
#include "gather/texel_entry.glsl"

layout(set = 0, binding = PELLUCID_BINDING_ENTRY_MAPS) readonly buffer EntryMaps { EntryMapConstants entryMaps[]; };
layout(set = 0, binding = PELLUCID_BINDING_ENTRIES_DESTINATION, rgba32ui) uniform writeonly uimage2D entriesDestination;

void main() {
  uvec3 group = goesByLists() ? unpackEntryGroup(readWord(entryList() + gl_WorkGroupID.x)) : gl_WorkGroupID;
  EntryMapConstants constants = entryMaps[group.z];
  ivec2 own = ivec2(group.xy) * GROUP_SIDE + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(own, maps[group.z].place.zw))) return;
  int side = int(constants.map.z);
  ivec2 texel = min(own * side + side / 2, ivec2(constants.map.xy) - 1);
  imageStore(entriesDestination, maps[group.z].place.xy + own, entryOf(constants, texel));
}
