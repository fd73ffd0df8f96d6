// Makes the entry points of a dispatch's shadow maps, below each other in one image. A group makes 16x16 of one level of a map, each
// of the texel in the middle of those that it stands for.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_ENTRY_POINTS_GROUP
#include "frame/blocks.glsl"
#include "gather/entry_level.glsl"
#include "gather/texel_entry.glsl"

layout(push_constant) uniform Pass { EntryPointsPass pass; };
layout(set = 0, binding = PELLUCID_BINDING_ENTRY_MAPS) readonly buffer EntryMaps { EntryMapConstants entryMaps[]; };
layout(set = 0, binding = PELLUCID_BINDING_ENTRIES_DESTINATION, rgba32ui) uniform writeonly uimage2D entriesDestination;

void main() {
  // Without lists a map's levels follow each other.
  EntryGroup group = EntryGroup(gl_WorkGroupID.xy, gl_WorkGroupID.z % PELLUCID_ENTRY_LEVELS, gl_WorkGroupID.z / PELLUCID_ENTRY_LEVELS);
  if (goesByLists()) group = unpackEntryGroup(readWord(entryList() + gl_WorkGroupID.x));
  ivec4 place = maps[group.map].place;
  EntryMapConstants constants = entryMaps[group.map];
  int level = int(group.level), side = int(constants.map.z) << level;
  ivec2 own = ivec2(group.at) * GROUP_SIDE + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThan(own, (place.zw - 1) >> level))) return;
  ivec2 texel = min(own * side + side / 2, ivec2(constants.map.xy) - 1), size = ivec2(pass.entries & 0xFFFFu, pass.entries >> 16);
  imageStore(entriesDestination, entryPlace(place.xy, level, size) + own, entryOf(constants, texel));
}
