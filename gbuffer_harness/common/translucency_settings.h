// How light through thin parts is computed: the fields of PellucidFrame and PellucidThesisOptions of these
// names, for the module and the float64 reference alike.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pellucid/pellucid_thesis.h"

namespace pellucid::harness {

// PellucidFrameOptions::gatherSamples, as pellucidInitFrame has it.
inline constexpr std::uint32_t kDefaultGatherSamples = 8;

struct TranslucencySettings {
  bool cameraThickness = false;
  PellucidAngleModel angleModel = PELLUCID_ANGLE_NORMAL;
  std::array<float, 4> anglePolynomial = {-1, 0.63661977f, 0, 0};  // linear in the angle
  float minimumDot = 0;
  bool constantViewDirection = false;
  bool chordThickness = false;
  float maximumThickness = 0;  // mm; 0: no limit
  std::array<float, 3> transmittanceFilter = {1, 1, 1};
  std::uint32_t gatherSamples = 0;
  std::uint32_t gatherSpacing = 0;
  std::vector<float> minimumDotTable;  // entries of the azimuth, or rows of the square octahedral map
  std::array<float, 3> faceVector = {0, 0, 1}, upAxis = {0, 1, 0}, objectCenter = {0, 0, 0};
  uint32_t materialMarkBit = 0;
  bool prescaleAngle = false;

  bool operator==(const TranslucencySettings&) const = default;
};

}  // namespace pellucid::harness
