// Decides if a frame takes the light that came through from an earlier one.
#include <algorithm>
#include <cmath>

#include "frame.h"
#include "plan.h"

namespace pellucid {
namespace {

// Cosine between the camera's axis and the direction to the light.
float cameraLightDot(const FrameFacts& f, const PellucidLight& light) {
  if (isAmbient(light)) return 0;  // from everywhere alike
  const glm::dmat4& view = f.viewFromWorld;
  const glm::dvec3 axis = f.depthRange.forward * glm::dvec3(view[0][2], view[1][2], view[2][2]);
  const glm::dvec3 toLight = light.type == PELLUCID_LIGHT_DIRECTIONAL ? -toVector(light.direction)
                                                                       : toVector(light.position) - toVector(f.thesis.objectCenter);
  const double length = glm::length(toLight);
  return static_cast<float>(length > 0 ? glm::dot(axis, toLight) / length : 0);
}

// The kept light is of the same pixels.
bool fits(const History& kept, const History& now) {
  return kept.valid != 0 && kept.format == now.format && kept.gatherSpacing == now.gatherSpacing && kept.accumulates == now.accumulates &&
         std::equal(kept.extent, kept.extent + 2, now.extent) && kept.rect == now.rect;
}

// The kept light can stand for this frame's.
bool isAlike(const History& kept, const History& now) {
  return fits(kept, now) && kept.lightCount == now.lightCount && kept.preExposure == now.preExposure;
}

bool coherent(const PellucidFrame& f, const History& kept, const History& now) {
  if (now.lightCount > kCoherentLights) return false;
  const float threshold = f.options.coherenceThreshold;
  for (uint32_t i = 0; i < now.lightCount; ++i)
    if (!(std::abs(now.lightDots[i] - kept.lightDots[i]) <= threshold)) return false;
  return true;
}

}  // namespace

bool decideReuse(const FrameFacts& f, const History& kept, History* result) {
  History& now = *result;
  now = {};
  now.valid = 1;
  now.format = f.stages.keepsProbes ? VK_FORMAT_R32G32B32A32_UINT : f.colorFormat;
  now.gatherSpacing = f.stages.keepsProbes ? f.gatherSpacing : 0;
  now.accumulates = f.stages.accumulates;
  now.preExposure = f.frame.preExposure;
  // With an anchor the history is larger, and its rows lie elsewhere.
  now.extent[0] = f.lattice.extent.x, now.extent[1] = f.lattice.extent.y;
  now.rect = renderRect(f.frame);
  now.first[0] = f.lattice.first.x, now.first[1] = f.lattice.first.y;
  now.lightCount = f.lights.lightCount;
  for (uint32_t i = 0; i < std::min(now.lightCount, kCoherentLights); ++i)
    now.lightDots[i] = cameraLightDot(f, f.light(i));
  if (f.stages.accumulates) {
    now.age = fits(kept, now) ? kept.age + 1 : 0;
    return false;
  }
  if (!isAlike(kept, now)) return false;
  const bool reused =
      f.frame.options.reuse == PELLUCID_REUSE_ALTERNATE ? kept.age == 0 : coherent(f.frame, kept, now);
  if (reused) {
    now = kept;
    ++now.age;
  }
  return reused;
}

}  // namespace pellucid
