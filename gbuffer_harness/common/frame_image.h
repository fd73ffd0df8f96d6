// Images of a frame by the numbers that plans give them.
#pragma once

#include <cstdint>
#include <utility>

#include "pellucid/pellucid_plan.h"

namespace pellucid::harness {

// The image that a PellucidBinding of an image resource means, for passes that bind what a plan does.
inline const PellucidImage& imageOf(const PellucidFrame& frame, uint32_t resource) {
  const std::pair<uint32_t, const PellucidImage*> named[] = {
      {PELLUCID_RESOURCE_FRONT_DEPTH, &frame.frontDepth},
      {PELLUCID_RESOURCE_BACK_DEPTH, &frame.backDepth},
      {PELLUCID_RESOURCE_IRRADIANCE, &frame.irradiance},
      {PELLUCID_RESOURCE_HIDDEN_IRRADIANCE, &frame.hiddenIrradiance},
      {PELLUCID_RESOURCE_ALBEDO, &frame.albedo},
      {PELLUCID_RESOURCE_MATERIAL, &frame.material},
      {PELLUCID_RESOURCE_MOTION, &frame.motion},
      {PELLUCID_RESOURCE_OUTPUT, &frame.output}};
  for (const auto& [name, image] : named)
    if (name == resource) return *image;
  return resource >= PELLUCID_RESOURCE_SHADOW0 ? frame.shadowImages[resource - PELLUCID_RESOURCE_SHADOW0]
                                               : frame.transients[resource - PELLUCID_RESOURCE_TRANSIENT0];
}

}  // namespace pellucid::harness
