#include "pyramid.h"

#include <algorithm>

#include "quality.h"

namespace pellucid {
namespace {

// Texels of a level under `pixels` in a row, wherever they start, and one more on each side.
uint32_t most(uint32_t pixels, uint32_t level) { return ((pixels - 1) >> level) + 3; }

// What level 1 takes in a row, and in its place the resolved level 2 beside its shares.
uint32_t firstColumns(uint32_t pixels) { return std::max(most(pixels, kFirstLevel), 2 * most(pixels, 2)); }

// Where a level's second clusters begin in rows of the next level: right of it, its clusters and its second
// ones, which begin below it.
uint32_t secondColumn(uint32_t pixels, uint32_t level) {
  const uint32_t next = level + 1;
  const uint32_t seconds = next < PELLUCID_LAST_LEVEL ? secondColumn(pixels, next) + most(pixels, next) : 0;
  return std::max(2 * most(pixels, next), seconds);
}

// What levels from 2 on take in a row: level 2 alone, level 3 and its clusters, or level 4, its clusters and
// the second ones of level 3.
uint32_t coarserColumns(uint32_t pixels) {
  constexpr uint32_t kLevel = PELLUCID_FIRST_BESIDE;
  return std::max(
      {most(pixels, 2), 2 * most(pixels, kLevel), secondColumn(pixels, kLevel) + most(pixels, kLevel)});
}

}  // namespace

bool keepsFirstLevel(const PellucidFrame& frame) {
  const uint32_t best = frame.targetError > 0 ? 3 : frame.quality;
  return sumsEdges(frame, best) || sumsEdgesFast(frame, best);
}

uint32_t coarsestLevel(const PellucidFrame& frame) {
  uint32_t level = kFirstLevel + 2;
  while (level < PELLUCID_LAST_LEVEL && std::max(frame.imageExtent[0], frame.imageExtent[1]) >> level > 1)
    level += 2;
  return level;
}

PyramidPlace placeOf(const PellucidFrame& frame, uint32_t level) {
  PyramidPlace place{};
  if (level > kFirstLevel) place.x = static_cast<int32_t>(firstColumns(frame.imageExtent[0]));
  for (uint32_t l = kFirstLevel + 1; l < level; ++l)
    place.y += static_cast<int32_t>(most(frame.imageExtent[1], l));
  const Rect r = renderRect(frame);
  const int32_t border = level > kFirstLevel ? 1 : 0;
  const auto first = [&](uint32_t pixel) { return static_cast<int32_t>(pixel >> level) - border; };
  const auto end = [&](uint32_t pixels) { return static_cast<int32_t>((pixels - 1) >> level) + 1 + border; };
  place.rect = {first(r.x), first(r.y), end(r.x + r.width) - first(r.x), end(r.y + r.height) - first(r.y)};
  return place;
}

int32_t clusterColumn(const PellucidFrame& frame, uint32_t level) {
  return placeOf(frame, level).x + static_cast<int32_t>(most(frame.imageExtent[0], level));
}

PyramidTexel secondPlace(const PellucidFrame& frame, uint32_t level) {
  const PyramidPlace coarser = placeOf(frame, level + 1);
  return {coarser.x + static_cast<int32_t>(secondColumn(frame.imageExtent[0], level)), coarser.y};
}

PyramidTexel summedPlace(const PellucidFrame& frame) {
  return {static_cast<int32_t>(firstColumns(frame.imageExtent[0])) - 1, 0};
}

ResolvedPlace resolvedPlaceOf(const PellucidFrame& frame) {
  const PyramidPlace second = placeOf(frame, 2);
  if (!keepsFirstLevel(frame)) return {0, 0, second.rect.width, 0};
  const auto x = second.x + static_cast<int32_t>(coarserColumns(frame.imageExtent[0]));
  return {x, 0, x, static_cast<int32_t>(most(frame.imageExtent[1], 2))};
}

PyramidExtent pyramidExtent(const PellucidFrame& frame) {
  const uint32_t last = coarsestLevel(frame), columns = most(frame.imageExtent[0], 2);
  const uint32_t coarser = keepsFirstLevel(frame) ? coarserColumns(frame.imageExtent[0]) + columns : columns;
  const uint32_t resolvedRows = most(frame.imageExtent[1], 2) * (keepsFirstLevel(frame) ? 2 : 1);
  const uint32_t width = firstColumns(frame.imageExtent[0]) + coarser;
  uint32_t height = 0;
  for (uint32_t l = kFirstLevel + 1; l <= last; ++l) height += most(frame.imageExtent[1], l);
  if (keepsFirstLevel(frame))
    for (uint32_t l = PELLUCID_FIRST_BESIDE; l < last; ++l)
      height =
          std::max(height, static_cast<uint32_t>(secondPlace(frame, l).y) + most(frame.imageExtent[1], l));
  return {width, std::max({height, most(frame.imageExtent[1], kFirstLevel), resolvedRows})};
}

}  // namespace pellucid
