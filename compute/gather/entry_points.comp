// Makes the entry points of a dispatch's shadow maps, below each other in one image, and their means. A group makes 16x16 of
// one map, each of the texel in the middle of those that it stands for.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_ENTRY_POINTS_GROUP
#include "frame/work_group.glsl"
#include "gather/entry_point.glsl"
#include "gather/mean_entry.glsl"
#include "gather/texel_entry.glsl"

layout(set = 0, binding = PELLUCID_BINDING_ENTRY_MAPS) readonly buffer EntryMaps { EntryMapConstants entryMaps[]; };
layout(set = 0, binding = PELLUCID_BINDING_LEVELS, rgba32ui) uniform writeonly uimage2D entriesDestination;

shared uint someSurface;

void main() {
  uvec3 group = goesByLists() ? unpackEntryGroup(listedWord(PELLUCID_LIST_ENTRY_POINTS)) : gl_WorkGroupID;
  uint map = group.z;
  EntryMapConstants constants = entryMaps[map];
  if (kDirectional) constants.meta.yz = uvec2(PELLUCID_SHADER_DEPTH_DEVICE, 0u);
  int side = int(constants.map.z), index = int(gl_LocalInvocationIndex);
  ivec2 size = ivec2(pass.value.y & 0xFFFFu, pass.value.y >> 16), start = ivec2(group.xy) * GROUP_SIDE, own = start + ivec2(gl_LocalInvocationID.xy);
  bool contained = all(lessThan(own, maps[map].place.zw));
  ivec2 texel = min(own * side + side / 2, ivec2(constants.map.xy) - 1);
  uvec4 entry = contained ? entryOf(constants, texel) : kNoEntry;
  entries[index] = entry;
  if (index == 0) someSurface = 0u;
  barrier();
  if (holdsSurface(entry)) someSurface = 1u;
  barrier();
  bool some = someSurface != 0u;
  // Groups beyond the map have nothing to write. Maps begin at whole groups.
  ivec2 first = maps[map].place.xy + start;
  bool inside = all(lessThan(start, maps[map].place.zw));
  if (inside) imageStore(entriesDestination, first + ivec2(gl_LocalInvocationID.xy), entry);
  for (int level = 1; level <= kLastEntryLevel; ++level) {
    int across = GROUP_SIDE >> level;
    ivec2 local = ivec2(index % across, index / across);
    bool makes = inside && index < across * across;
    if (makes) {
      // Texels are 2 seen.x wide, and 70 degrees is a slope of 3.
      float limit = 6.0 * float(side << (level - 1)) * constants.seen.x;
      entry = some ? meanBelow(level, local, limit, constants.meta.z != 0u) : kNoEntry;
      imageStore(entriesDestination, entryPlace(first, level, size) + local, entry);
    }
    // Levels alternate between the arrays, so that what is written has been read before the barrier before.
    if (makes) {
      if ((level & 1) != 0)
        means[index] = entry;
      else
        entries[index] = entry;
    }
    barrier();
  }
}
