// Lists the blocks that later passes do, and the groups of entry points within reach of the surfaces that blocks show.
#ifndef PELLUCID_LIST_BLOCKS_GLSL
#define PELLUCID_LIST_BLOCKS_GLSL

#include "frame/lists.glsl"
#include "gather/entry_level.glsl"

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

// The part of a map that the probes of a block may read.
struct EntriesInReach {
  vec4 entries; // [xy, zw], of level 0
  ivec2 levels; // the finest and the coarsest
};

// Probes round otherwise.
const float kRounding = 1.001;

// Levels that probes read whose cells and entry points of level 0 have sides from x to y.
ivec2 levelsOf(vec2 cells, vec2 sides) {
  return ivec2(entryLevel(kRounding * sides.y, cells.x), entryLevel(sides.x, kRounding * cells.y));
}

// For the surfaces that a block shows between two planar distances.
EntriesInReach entriesInReach(uint map, uint block, float nearest, float farthest) {
  ivec2 first = firstPixel(block);
  bool perspective = maps[map].stepX.w != 0.0;
  float reach = lists.reach.x, side = length(maps[map].stepX.xyz);
  vec2 cells = vec2(cellSide(nearest, lists.maps.y), cellSide(farthest, lists.maps.y));
  cells = vec2(min(cells.x, cells.y), max(cells.x, cells.y));
  vec3 least = vec3(kFarthest), most = vec3(-kFarthest);
  vec4 at = vec4(kFarthest, kFarthest, -kFarthest, -kFarthest);
  [[dont_unroll]] for (int i = 0; i < 8; ++i) {
    ViewRay ray = viewRay(frame.camera, first + ivec2(i & 1, i >> 1 & 1) * PELLUCID_BLOCK);
    vec3 corner = ray.origin + (i < 4 ? nearest : farthest) * ray.direction;
    least = min(least, corner);
    most = max(most, corner);
    vec2 entry = vec2(dot(maps[map].column, vec4(corner, 1.0)), dot(maps[map].row, vec4(corner, 1.0)));
    at = vec4(min(at.xy, entry), max(at.zw, entry));
  }
  if (!perspective) {
    vec2 around = reach * vec2(length(maps[map].column.xyz), length(maps[map].row.xyz));
    return EntriesInReach(at + vec4(-around, around), levelsOf(cells, vec2(side)));
  }
  // A box around the corners and all within reach of them projects into what its corners span.
  at = vec4(kFarthest, kFarthest, -kFarthest, -kFarthest);
  vec2 depths = vec2(kFarthest, -kFarthest);
  bool ahead = true;
  [[dont_unroll]] for (int i = 0; i < 8; ++i) {
    bvec3 far = bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0);
    vec4 corner = vec4(mix(least - reach, most + reach, far), 1.0);
    float depth = dot(maps[map].depth, corner);
    depths = vec2(min(depths.x, depth), max(depths.y, depth));
    ahead = ahead && depth > 0.0;
    vec2 entry = vec2(dot(maps[map].column, corner), dot(maps[map].row, corner)) / depth;
    at = vec4(min(at.xy, entry), max(at.zw, entry));
  }
  if (!ahead) at = vec4(-kFarthest, -kFarthest, kFarthest, kFarthest); // next to the light: all of the map
  return EntriesInReach(at, levelsOf(cells, side * depths));
}

// The bits [first, last] of a word that begins at bit `begin`.
uint bitsWithin(int first, int last, int begin) {
  int from = max(first - begin, 0), to = min(last - begin, 31);
  return to >= from ? 0xFFFFFFFFu >> (31 - to + from) << from : 0u;
}

// Lists the groups [first, last] in a row of a level that no other block has listed.
void listGroupsInRow(uint map, uint level, uint row, int first, int last) {
  // The levels' rows of bits follow each other.
  uint rowsBefore = 2u * kEntryGroupRows - (2u * kEntryGroupRows >> level);
  for (uint i = 0u; i < kEntryGroupRowWords; ++i) {
    uint bits = bitsWithin(first, last, 32 * int(i)), at = counterWords() + map * kEntryGroupWords + kEntryGroupRowWords * (rowsBefore + row) + i;
    // Read first: neighboring blocks need mostly the same.
    uint added = bits & ~listWords[at];
    if (added != 0u) added &= ~atomicOr(listWords[at], added);
    if (added == 0u) continue;
    uint place = entryList() + atomicAdd(lists.commands[PELLUCID_LIST_ENTRIES].groups.x, bitCount(added));
    for (; added != 0u; added &= added - 1u, ++place)
      writeWord(place, packEntryGroup(EntryGroup(uvec2(32u * i + uint(findLSB(added)), row), level, map)));
  }
}

// Lists the groups that a block needs in a row of each level of a map.
void listEntryGroups(uint map, uint block, int row, float nearest, float farthest) {
  EntriesInReach reach = entriesInReach(map, block, nearest, farthest);
  ivec2 last = maps[map].place.zw - 1;
  if (any(isnan(reach.entries))) reach = EntriesInReach(vec4(vec2(0.0), vec2(last)), ivec2(0, PELLUCID_ENTRY_LEVELS - 1));
  // Far outside stays outside after the conversion. Below, groups are within the map whatever a NaN would convert to.
  const int kOutside = 3 << PELLUCID_ENTRY_LEVELS;
  ivec4 within = ivec4(floor(clamp(reach.entries, vec4(-kOutside), vec4(last + kOutside, last + kOutside))));
  for (int level = reach.levels.x; level <= reach.levels.y; ++level) {
    ivec4 around = within + ivec4(-2, -2, 2, 2) * (1 << level); // besideHair of probe_light.glsl reads entries two away
    if (any(greaterThan(around.xy, last)) || any(lessThan(around.zw, ivec2(0)))) continue;
    ivec4 groups = (ivec4(max(around.xy, ivec2(0)), min(around.zw, last)) >> level) / PELLUCID_ENTRY_POINTS_GROUP;
    if (row >= groups.y && row <= groups.w) listGroupsInRow(map, uint(level), uint(row), groups.x, groups.z);
  }
}

#endif
