// Images of a frame by the numbers that plans give them.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
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
      {PELLUCID_RESOURCE_OUTPUT, &frame.output},
      {PELLUCID_RESOURCE_HISTORY, &frame.options.history}};
  for (const auto& [name, image] : named)
    if (name == resource) return *image;
  if (resource >= PELLUCID_RESOURCE_SHADOW0) return frame.shadowImages[resource - PELLUCID_RESOURCE_SHADOW0];
  const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
  if (transient >= PELLUCID_MAX_TRANSIENTS) throw std::logic_error("no image of a frame has the resource " + std::to_string(resource));
  return frame.transients[transient];
}

}  // namespace pellucid::harness
