// The image and the commands that the passes write which make tile lists.
#ifndef PELLUCID_TILE_COMMANDS_GLSL
#define PELLUCID_TILE_COMMANDS_GLSL

#include "frame/tile_words.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LEVELS, r32ui) uniform uimage2D tilesDestination;
layout(set = 0, binding = PELLUCID_BINDING_TILE_COMMANDS) buffer Commands {
  TileCommands tiles;
  uint entryGroups[]; // a bit for each group of a map's entry points that is listed
};

void writeTileWord(uint word, uint value) { imageStore(tilesDestination, tileWordPlace(word), uvec4(value)); }

uint listPlace(uint list) { return frame.lists[list >> 2][list & 3u]; }

// Makes room for so many groups at the end of a list; their first place.
uint addToList(uint list, uint count) {
  if (tiles.maps.y != 0u && list == PELLUCID_LIST_FILTER_PROBES) return atomicAdd(tiles.gather.filterProbes.w, count);
  if (tiles.maps.y != 0u && list == PELLUCID_LIST_DIFFUSE) {
    atomicAdd(tiles.gather.noLight.x, count);
    return atomicAdd(tiles.gather.light.w, count);
  }
  return atomicAdd(tiles.commands[list].x, count);
}

// Empties all lists, by so many invocations: a recording may run more than once.
void clearLists(uint invocation, uint invocations) {
  for (uint i = invocation; i < tiles.maps.x * uint(PELLUCID_ENTRY_GROUP_WORDS); i += invocations) entryGroups[i] = 0u;
  if (invocation < uint(PELLUCID_LISTS)) tiles.commands[invocation].x = 0u;
  if (invocation == uint(PELLUCID_LISTS)) {
    tiles.gather.filterProbes.xw = tiles.gather.light.xw = uvec2(0u);
    tiles.gather.noLight.x = 0u;
  }
}

#endif
