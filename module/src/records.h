// Where the records of the light-space gather lie (compute/passes/records.glsl), and what the shaders know of
// their maps. Pure.
#pragma once

#include "frame.h"

namespace pellucid {

// Of the image that holds a dispatch's records: its maps' are below each other. No device has a smaller
// limit.
constexpr uint32_t kRecordColumns = 2048, kRecordRows = 4096;

// Columns with the summaries beside them, of compute/passes/records.glsl.
constexpr uint32_t withSummaries(uint32_t columns) {
  return columns + (columns + PELLUCID_RECORDS_GROUP - 1) / PELLUCID_RECORDS_GROUP;
}

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
