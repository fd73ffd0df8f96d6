// Tile lists, for C++ and GLSL; pellucid_shared.h includes this file.
#ifndef PELLUCID_TILES_H
#define PELLUCID_TILES_H

// Lists of the groups that have work, one for each pass, in the order in which one pass makes them.
#define PELLUCID_LIST_TILES 0u // of PELLUCID_TILE pixels a side, with material
#define PELLUCID_LIST_DOWNSAMPLE 1u // levels 2 and 3
#define PELLUCID_LIST_DOWNSAMPLE_COARSE 2u
#define PELLUCID_LIST_UPSAMPLE 3u
#define PELLUCID_LIST_DIFFUSE 4u
#define PELLUCID_LIST_PROBES 5u
#define PELLUCID_LIST_FILTER_PROBES 6u
#define PELLUCID_LIST_ENTRY_POINTS 7u
// GroupList::size.z: a group runs if there is material in a cell of its part, in a block of it, in one or beside it, anywhere.
#define PELLUCID_RUNS_WITH_CELLS 0
#define PELLUCID_RUNS_WITH_BLOCKS 1
#define PELLUCID_RUNS_BESIDE_BLOCKS 2
#define PELLUCID_RUNS_WITH_ANY 3
#define PELLUCID_TILE_WORDS_SHIFT 10 // log2 of the columns of their image
#define PELLUCID_ENTRY_GROUP_WORDS 128 // a bit for each of a map's groups of entry points, at most 64 x 64
#define PELLUCID_BLOCK_WORDS 4 // bits of cells' rows 0 to 3 and 4 to 7; bits of the nearest and farthest planar distance

// A listed group is a word: its column, a flag, and its row; of entry points its column, from bit 8 on its row, and its map.
// Images of many groups list some rows of them together (FrameConstants::listRows), which the dispatch has in y: all devices
// take 65535 groups along an axis, and no more of them need be promised.
#define PELLUCID_GROUP_COLUMN 0x7FFFu
#define PELLUCID_GROUP_WHOLE 0x8000u // all that the group reads of the pass before has been written
#define PELLUCID_GROUP_ROW_SHIFT 16
#define PELLUCID_GROUP_MAP_SHIFT 16

#ifdef __cplusplus
namespace pellucid::shared {
#endif

// Groups of a pass as its list has them. A group has work if there is material in its part of the image.
struct GroupList {
  ivec4 places; // xy: first pixel of group (0, 0)'s part, from the first block on; zw: pixels from a group to the next
  ivec4 size;   // xy: pixels of a part; z: PELLUCID_RUNS_*
  uvec4 count;  // x, y: groups; z: rows of the pass in each
};

// Buffer that the passes read and write which make tile lists.
struct TileCommands {
  GatherDispatches gather; // w: groups that are listed, where the gather decides
  uvec4 commands[PELLUCID_LISTS]; // VkDispatchIndirectCommand
  GroupList groups[PELLUCID_LISTS];
  uvec4 maps;   // x: shadow maps that are gathered from; y: 1 if the gather decides which lists run
  vec4 reach; // x: how far from a surface probes look for entry points, scene units
};

#ifdef __cplusplus
} // namespace pellucid::shared
#endif
#endif
