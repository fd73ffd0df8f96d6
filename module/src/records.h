// Where the records of the light-space gather lie (compute/passes/records.glsl), and what the shaders know of
// their maps. Pure.
#pragma once

#include "frame.h"

namespace pellucid {

// Records of a dispatch's maps, which are below each other: at most. Maps that are wider take fewer records
// than texels, as samples are further apart than their texels.
constexpr uint32_t kRecordColumns = 1024, kRecordRows = 4096;

// Whole groups of the pass that makes them.
constexpr uint32_t recordGroups(uint32_t records) {
  return (records + PELLUCID_RECORDS_GROUP - 1) / PELLUCID_RECORDS_GROUP * PELLUCID_RECORDS_GROUP;
}

// Columns with the coarser levels beside them, of compute/passes/records.glsl.
constexpr uint32_t withCoarserRecords(uint32_t columns) { return columns + columns / 2; }

struct RecordExtent {
  uint32_t width, height;
  uint32_t side;  // texels of the map that a record stands for, a side
};

// Of one of the light's maps: a power of two of texels a side, so that all of them fit.
RecordExtent recordExtent(const PellucidFrame& frame, const PellucidLight& light, uint32_t map);

// `row`: of the map's first record. `light`: its place among the dispatch's.
struct RecordConstants {
  shared::GatherMapConstants gather;
  shared::RecordMapConstants record;
};
RecordConstants recordConstants(const PellucidFrame& frame, const PellucidShadowMap& map,
                                const PellucidLight& light, const shared::ShadowConstants& shadow,
                                const glm::dmat4& viewFromWorld, RecordExtent extent, uint32_t row,
                                uint32_t lightIndex);

}  // namespace pellucid
