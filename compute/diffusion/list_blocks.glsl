// Lists the blocks that later passes do, and the groups of entry points within reach of the surfaces that blocks show.
#ifndef PELLUCID_LIST_BLOCKS_GLSL
#define PELLUCID_LIST_BLOCKS_GLSL

#include "frame/lists.glsl"

layout(set = 0, binding = PELLUCID_BINDING_GATHER_MAPS) uniform GatherMaps { GatherMapConstants maps[PELLUCID_DISPATCH_SHADOWS]; };

// ---- Blocks. Each adds to the counters of the blocks around. The last one to do so knows all that a list says of a block

// Counts in a block's half of a word, 4 bits each: blocks around, itself among them, that were looked at, that hold material, and all
// of whose cells do. Another bit: the block itself holds material.
const uint kLooked = 1u, kHolds = 0x10u, kFull = 0x100u, kOwnHolds = 0x1000u;
const uint kCounts = 15u, kHalf = 0xFFFFu;

void listBlock(uint block, uint counts) {
  bool near = (counts & kCounts * kHolds) != 0u;
  writeWord(blockWord(block, kNearWord), near ? 1u : 0u);
  if (!near) return;
  uint word = (counts & kCounts * kFull) == 9u * kFull ? block | kWholeBlock : block;
  writeWord(nearList() + atomicAdd(lists.commands[PELLUCID_LIST_DOWNSAMPLE].groups.x, 1u), word);
  atomicAdd(lists.commands[PELLUCID_LIST_UPSAMPLE].groups.x, 1u);
  if ((counts & kOwnHolds) == 0u) return;
  writeWord(materialList() + atomicAdd(lists.commands[PELLUCID_LIST_DIFFUSE].groups.x, 1u), word);
  atomicAdd(lists.commands[PELLUCID_LIST_PROBES].groups.x, 1u);
  atomicAdd(lists.commands[PELLUCID_LIST_FILTER].groups.x, 1u);
  atomicMax(lists.commands[PELLUCID_LIST_COARSE].groups.x, lists.commands[PELLUCID_LIST_COARSE].groups.w);
}

// Counts a block at the i-th of the 3 x 3 blocks around it. `cells`: its words of cells with material.
void countBlock(uint block, int i, uvec2 cells) {
  ivec2 blocks = ivec2(frame.blocks.xy), at = ivec2(block % frame.blocks.x, block / frame.blocks.x) + ivec2(i % 3, i / 3) - 1;
  if (!contains(ivec4(0, 0, blocks), at)) return;
  bool holds = cells != uvec2(0u);
  uint other = uint(at.y) * frame.blocks.x + uint(at.x), shift = 16u * (other & 1u);
  uint added = kLooked + (holds ? kHolds : 0u) + (cells == uvec2(~0u) ? kFull : 0u) + (holds && other == block ? kOwnHolds : 0u);
  uint counts = (atomicAdd(listWords[other >> 1], added << shift) >> shift & kHalf) + added;
  ivec2 around = min(at + 2, blocks) - max(at - 1, ivec2(0));
  if ((counts & kCounts) != uint(around.x * around.y)) return;
  atomicAnd(listWords[other >> 1], ~(kHalf << shift));
  listBlock(other, counts);
}

// ---- Groups of entry points

const uint kEntryGroupRowWords = 2u, kEntryGroupRows = 64u; // a row has 64 groups
const uint kEntryGroupWords = uint(PELLUCID_ENTRY_GROUP_WORDS);

// Entry points [xy, zw] of a map that lie within reach of what a block shows between two planar distances.
vec4 entriesInReach(uint map, uint block, float nearest, float farthest) {
  ivec2 first = firstPixel(block);
  bool perspective = maps[map].stepX.w != 0.0;
  float reach = lists.reach.x;
  vec3 least = vec3(3.0e38), most = vec3(-3.0e38);
  vec4 at = vec4(3.0e38, 3.0e38, -3.0e38, -3.0e38);
  for (int i = 0; i < 8; ++i) {
    ViewRay ray = viewRay(frame.camera, first + ivec2(i & 1, i >> 1 & 1) * PELLUCID_BLOCK);
    vec3 corner = ray.origin + (i < 4 ? nearest : farthest) * ray.direction;
    least = min(least, corner);
    most = max(most, corner);
    vec2 entry = vec2(dot(maps[map].column, vec4(corner, 1.0)), dot(maps[map].row, vec4(corner, 1.0)));
    at = vec4(min(at.xy, entry), max(at.zw, entry));
  }
  if (!perspective) {
    vec2 around = reach * vec2(length(maps[map].column.xyz), length(maps[map].row.xyz));
    return at + vec4(-around, around);
  }
  // A box around the corners and all within reach of them projects into what its corners span.
  at = vec4(3.0e38, 3.0e38, -3.0e38, -3.0e38);
  for (int i = 0; i < 8; ++i) {
    bvec3 far = bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0);
    vec4 corner = vec4(mix(least - reach, most + reach, far), 1.0);
    float depth = dot(maps[map].depth, corner);
    if (!(depth > 0.0)) return vec4(-3.0e38, -3.0e38, 3.0e38, 3.0e38); // next to the light: all of the map
    vec2 entry = vec2(dot(maps[map].column, corner), dot(maps[map].row, corner)) / depth;
    at = vec4(min(at.xy, entry), max(at.zw, entry));
  }
  return at;
}

// The bits [first, last] of a word that begins at bit `begin`.
uint bitsWithin(int first, int last, int begin) {
  int from = max(first - begin, 0), to = min(last - begin, 31);
  return to >= from ? 0xFFFFFFFFu >> (31 - to + from) << from : 0u;
}

// Lists the groups in a row of a map that a block needs and that no other has listed.
void listEntryGroups(uint map, uint block, int row, float nearest, float farthest) {
  vec4 entries = entriesInReach(map, block, nearest, farthest);
  ivec2 last = maps[map].place.zw - 1;
  if (any(isnan(entries))) entries = vec4(vec2(0.0), vec2(last));
  // Far outside stays outside after the conversion. Below, groups are within the map whatever a NaN would convert to.
  ivec4 within = ivec4(floor(clamp(entries, vec4(-1.0), vec4(last + 1, last + 1))));
  if (any(greaterThan(within.xy, last)) || any(lessThan(within.zw, ivec2(0)))) return;
  ivec4 groups = ivec4(max(within.xy, ivec2(0)), min(within.zw, last)) / PELLUCID_ENTRY_POINTS_GROUP;
  if (row < groups.y || row > groups.w) return;
  for (uint i = 0u; i < kEntryGroupRowWords; ++i) {
    uint bits = bitsWithin(groups.x, groups.z, 32 * int(i));
    uint at = counterWords() + map * kEntryGroupWords + kEntryGroupRowWords * uint(row) + i;
    // Read first: neighboring blocks need mostly the same.
    uint added = bits & ~listWords[at];
    if (added != 0u) added &= ~atomicOr(listWords[at], added);
    if (added == 0u) continue;
    uint place = entryList() + atomicAdd(lists.commands[PELLUCID_LIST_ENTRIES].groups.x, bitCount(added));
    for (; added != 0u; added &= added - 1u, ++place)
      writeWord(place, packEntryGroup(uvec3(32u * i + uint(findLSB(added)), uint(row), map)));
  }
}

#endif
