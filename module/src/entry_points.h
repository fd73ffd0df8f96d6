// Texels of shadow maps, places of the gather's entry points (compute/gather/entry_point.glsl), and what the
// shaders know of their maps.
#pragma once

#include "setup.h"

namespace pellucid {

bool isPerspective(const PellucidShadowMap& map);

// Longer side of a texel, scene units across the light; perspective: at planar distance 1.
double texelSide(const PellucidShadowMap& map);

// Entry points of a dispatch's maps, which are below each other: at most. Maps that are wider take fewer
// entries than texels, as samples are further apart than their texels.
constexpr uint32_t kEntryColumns = 1024, kEntryRows = 4096;

// Entry points along either side of a map that no length takes away: they know but the texel in their middle,
// and bodies have details whatever their material.
constexpr uint32_t kLeastEntries = 512;

// Up to whole groups of the pass that makes them.
constexpr uint32_t wholeGroups(uint32_t entries) {
  return parts(entries, PELLUCID_ENTRY_POINTS_GROUP) * PELLUCID_ENTRY_POINTS_GROUP;
}

// Columns with the coarser levels beside them, of compute/gather/entry_level.glsl.
constexpr uint32_t withCoarserEntries(uint32_t columns) { return columns + columns / 2; }

struct EntryExtent {
  uint32_t width, height;
  uint32_t side;  // texels of the map that an entry point stands for, a side

  // Groups of the pass that makes them, of all levels.
  constexpr uint32_t groups() const {
    uint32_t sum = 0;
    for (uint32_t level = 0; level < PELLUCID_ENTRY_LEVELS; ++level) {
      const uint32_t along = PELLUCID_ENTRY_POINTS_GROUP << level;
      sum += parts(width, along) * parts(height, along);
    }
    return sum;
  }
};

// Extent of one of the light's maps: a power of two of texels a side, so that all of them fit. Orthographic
// maps take no more entry points than Setup::longestEntrySide asks for.
EntryExtent entryExtent(const Setup& setup, const PellucidLight& light, uint32_t map);

// `row`: of the map's first entry point. `light`: its place among the dispatch's.
struct EntryConstants {
  shared::GatherMapConstants gather;
  shared::EntryMapConstants map;
};
EntryConstants entryConstants(const PellucidShadowMap& map, const PellucidLight& light,
                              const shared::ShadowConstants& shadow, const glm::dmat4& viewFromWorld,
                              EntryExtent extent, uint32_t row, uint32_t lightIndex);

}  // namespace pellucid
