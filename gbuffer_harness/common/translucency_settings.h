// How light through thin parts is computed: the fields of PellucidFrame and PellucidThesisOptions of these
// names, for the module and the float64 reference alike.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "pellucid/pellucid_thesis.h"

namespace pellucid::harness {

// PellucidFrameOptions::gatherSamples, as pellucidInitFrame has it.
inline constexpr std::uint32_t kDefaultGatherSamples = 8;

// MINIMUM_DOT with the minimum dot of each light from a table, by its azimuth around the object (Whelan 2009, 4.6.2) or by its
// direction on the sphere. The module has MINIMUM_DOT alone.
inline constexpr auto kMinimumDotAzimuth = static_cast<PellucidAngleModel>(5), kMinimumDotSphere = static_cast<PellucidAngleModel>(6);

struct TranslucencySettings {
  bool cameraThickness = false;
  PellucidAngleModel angleModel = PELLUCID_ANGLE_NORMAL;
  std::array<float, 4> anglePolynomial = {-1, 0.63661977f, 0, 0};  // linear in the angle
  float minimumDot = 0;  // of all lights, but for models with a table
  bool constantViewDirection = false;
  bool chordThickness = false;
  float maximumThickness = 0;  // mm; 0: no limit
  std::array<float, 3> transmittanceFilter = {1, 1, 1};
  std::uint32_t gatherSamples = 0;
  std::uint32_t gatherSpacing = 0;
  // Minimum dots, each -1..0, by the direction from objectCenter to a light.
  // - kMinimumDotAzimuth: entries at equal angles about upAxis, linear in between, around the whole turn. The first entry is at
  //   faceVector, and the next entries are towards cross(upAxis, faceVector).
  // - kMinimumDotSphere: size x size entries, 3 x 3 or more, row by row, bilinear in an octahedral map. A direction has the components s
  //   along cross(upAxis, faceVector), u along upAxis and f along the face. Its place is x = s / l, y = f / l with l = |s| + |u| + |f|.
  //   For u < 0 this place is folded over the corners. The first entry of a row or column is at -1, and the last one at 1.
  std::vector<float> minimumDotTable;
  // World space. The face's direction is not parallel to the up axis.
  std::array<float, 3> faceVector = {0, 0, 1}, upAxis = {0, 1, 0}, objectCenter = {0, 0, 0};
  uint32_t materialMarkBit = 0;
  bool prescaleAngle = false;

  bool hasMinimumDotTable() const { return angleModel > PELLUCID_ANGLE_MINIMUM_DOT; }
  PellucidAngleModel moduleModel() const { return std::min(angleModel, PELLUCID_ANGLE_MINIMUM_DOT); }
  bool operator==(const TranslucencySettings&) const = default;
};

}  // namespace pellucid::harness
