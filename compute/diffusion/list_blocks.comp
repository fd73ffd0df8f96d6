// Lists the blocks that later passes do, and the groups of entry points within reach of the surfaces that blocks show: an
// invocation looks at a block, or for one block at a row of the groups of a map.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_LIST_GROUP
#define GROUP_ROWS 1
#include "frame/blocks.glsl"

layout(set = 0, binding = PELLUCID_BINDING_GATHER_MAPS) uniform GatherMaps { GatherMapConstants maps[PELLUCID_DISPATCH_SHADOWS]; };
layout(set = 0, binding = PELLUCID_BINDING_LISTS) buffer Lists {
  BlockLists lists;
  uint entryGroups[]; // a bit for each group of a map's entry points that is listed
};

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
void listEntryGroups(uint map, uint block, int row) {
  float nearest = uintBitsToFloat(readWord(blockWord(block, kNearestWord)));
  float farthest = uintBitsToFloat(readWord(blockWord(block, kFarthestWord)));
  if (!(farthest > 0.0)) return;
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
    uint at = map * kEntryGroupWords + kEntryGroupRowWords * uint(row) + i;
    // Read first: neighboring blocks need mostly the same.
    uint added = bits & ~entryGroups[at];
    if (added != 0u) added &= ~atomicOr(entryGroups[at], added);
    if (added == 0u) continue;
    uint place = entryList() + atomicAdd(lists.commands[PELLUCID_LIST_ENTRIES].x, bitCount(added));
    for (; added != 0u; added &= added - 1u, ++place)
      writeWord(place, packEntryGroup(uvec3(32u * i + uint(findLSB(added)), uint(row), map)));
  }
}

uvec2 cellsOfBlock(ivec2 at) {
  if (!contains(ivec4(0, 0, frame.blocks.xy), at)) return uvec2(0u);
  uint block = uint(at.y) * frame.blocks.x + uint(at.x);
  return uvec2(readWord(blockWord(block, kCellWord)), readWord(blockWord(block, kCellWord + 1u)));
}

void listBlock(uint block) {
  ivec2 at = ivec2(block % frame.blocks.x, block / frame.blocks.x);
  uvec2 some = uvec2(0u), all = uvec2(~0u);
  for (int i = 0; i < 9; ++i) { // no early exit: it would wait for each word
    uvec2 cells = cellsOfBlock(at + ivec2(i % 3, i / 3) - 1);
    some |= cells;
    all &= cells;
  }
  bool near = some != uvec2(0u);
  writeWord(blockWord(block, kNearWord), near ? 1u : 0u);
  if (!near) return;
  bool holds = cellsOfBlock(at) != uvec2(0u);
  if (all == uvec2(~0u)) block |= kWholeBlock;
  writeWord(nearList() + atomicAdd(lists.commands[PELLUCID_LIST_DOWNSAMPLE].x, 1u), block);
  atomicAdd(lists.commands[PELLUCID_LIST_UPSAMPLE].x, 1u);
  if (!holds) return;
  uint place = atomicAdd(lists.commands[PELLUCID_LIST_DIFFUSE].x, 1u);
  writeWord(materialList() + place, block);
  atomicAdd(lists.commands[PELLUCID_LIST_PROBES].x, 1u);
  atomicAdd(lists.commands[PELLUCID_LIST_FILTER].x, 1u);
  atomicMax(lists.commands[PELLUCID_LIST_COARSE].x, lists.commands[PELLUCID_LIST_COARSE].w);
}

void main() {
  uint index = gl_GlobalInvocationID.x, blocks = blockCount();
  if (index < blocks) {
    listBlock(index);
  } else if (index < blocks * (1u + kEntryGroupRows * lists.maps.x)) {
    uint row = (index - blocks) % kEntryGroupRows, rest = (index - blocks) / kEntryGroupRows;
    listEntryGroups(rest / blocks, rest % blocks, int(row));
  }
}
