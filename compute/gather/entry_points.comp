// Makes the entry points of a dispatch's shadow maps, below each other in one image, and their means. A group makes 16x16 of
// one map, each of the texel in the middle of those that it stands for.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_ENTRY_POINTS_GROUP
#include "frame/blocks.glsl"
#include "gather/texel_entry.glsl"

layout(set = 0, binding = PELLUCID_BINDING_ENTRY_MAPS) readonly buffer EntryMaps { EntryMapConstants entryMaps[]; };
layout(set = 0, binding = PELLUCID_BINDING_ENTRIES_DESTINATION, rgba32ui) uniform writeonly uimage2D entriesDestination;

shared uint someSurface;
// A group's entry points. Each level is made from one array in the first part of the other, by turns.
shared uvec4 entries[GROUP_SIDE * GROUP_SIDE], means[GROUP_SIDE * GROUP_SIDE / 4];

// The mean of four entry points; kSeveralSurfaces where their depths are further apart than slopes of 70 degrees make them:
// a sample then takes the entry under it. `limit`: depth change from one to the next, scene units; perspective: over depth.
uvec4 meanOf(uvec4 bits[4], float limit, bool perspective) {
  float hidden = 0.0, seen = 0.0, cosine = 0.0, exit = 0.0, count = 0.0, sum = 0.0, least = kNoDepth, most = -kNoDepth;
  uint material = 0u;
  vec3 normal = vec3(0.0);
  bool several = false;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    several = several || bits[i] == kSeveralSurfaces;
    if (!holdsSurface(bits[i])) continue;
    EntryPoint r = unpackEntry(bits[i]);
    // A map's entry points all know their material, or none does. Light enters where the material is not 0.
    several = several || (material != 0u && r.material != 0u && r.material != material);
    material = max(material, r.material);
    least = min(least, r.depth);
    most = max(most, r.depth);
    hidden += r.hidden;
    seen += r.seen;
    cosine += r.cosine;
    normal += r.normal;
    sum += r.depth;
    exit += r.exit;
    count += 1.0;
  }
  if (perspective) limit *= max(abs(least), abs(most));
  if (several || most - least > 2.0 * limit) return kSeveralSurfaces;
  if (count == 0.0) return kNoEntry;
  float squared = dot(normal, normal), inverse = 1.0 / count;
  // Normals towards one light cancel only in rounding.
  if (squared < 1.0e-6) return kSeveralSurfaces;
  return packEntry(EntryPoint(sum * inverse, normal * inversesqrt(squared), 0.25 * hidden, 0.25 * seen, cosine * inverse,
                              exit * inverse, material));
}

// The mean of the four entry points of the level before under one of the level.
uvec4 meanBelow(int level, ivec2 at, float limit, bool perspective) {
  int across = GROUP_SIDE >> level, from = 4 * at.y * across + 2 * at.x;
  uvec4 bits[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    int place = from + (i & 1) + (i >> 1) * 2 * across;
    bits[i] = (level & 1) != 0 ? entries[place] : means[place];
  }
  return meanOf(bits, limit, perspective);
}

void main() {
  uvec3 group = goesByLists() ? unpackEntryGroup(readWord(entryList() + gl_WorkGroupID.x)) : gl_WorkGroupID;
  uint map = group.z;
  EntryMapConstants constants = entryMaps[map];
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
