#include "reuse.h"

#include <algorithm>
#include <cmath>

#include "camera.h"
#include "frame.h"

namespace pellucid {
namespace {

glm::dvec3 vec(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// Cosine between the camera's axis and the direction to the light.
float cameraLightDot(const PellucidFrame& f, const PellucidLight& light) {
  DepthRange range{};
  readDepthRange(toMatrix(f.clipFromView), &range);
  const glm::dmat4 view = toMatrix(f.viewFromWorld);
  const glm::dvec3 axis = range.forward * glm::dvec3(view[0][2], view[1][2], view[2][2]);
  const glm::dvec3 toLight = light.type == PELLUCID_LIGHT_DIRECTIONAL
                                 ? -vec(light.direction)
                                 : vec(light.position) - vec(f.objectCenter);
  const double length = glm::length(toLight);
  return static_cast<float>(length > 0 ? glm::dot(axis, toLight) / length : 0);
}

// What was kept is of the same pixels and as many lights.
bool fits(const PellucidHistory& kept, const PellucidHistory& now) {
  return kept.valid != 0 && kept.lightCount == now.lightCount && kept.format == now.format &&
         kept.gatherSpacing == now.gatherSpacing && std::equal(kept.extent, kept.extent + 2, now.extent) &&
         std::equal(kept.rect, kept.rect + 4, now.rect);
}

bool coherent(const PellucidFrame& f, const PellucidHistory& kept, const PellucidHistory& now) {
  if (now.lightCount > PELLUCID_MAX_COHERENT_LIGHTS) return false;
  const float threshold = f.coherenceThreshold * std::max(1.0f, f.frameLoad);
  for (uint32_t i = 0; i < now.lightCount; ++i)
    if (!(std::abs(now.lightDots[i] - kept.lightDots[i]) <= threshold)) return false;
  return true;
}

}  // namespace

bool keepsHistory(const PellucidFrame& f) {
  return f.reuse != PELLUCID_REUSE_NONE && f.debugView == PELLUCID_DEBUG_NONE &&
         (f.features & PELLUCID_FEATURE_TRANSLUCENCY) != 0 && lightGroups(f).count > 0;
}

bool keepsProbes(const PellucidFrame& f) { return keepsHistory(f) && lightGroups(f).gathered > 0; }

bool decideReuse(const PellucidFrame& f, const PellucidHistory& kept, PellucidHistory* result) {
  PellucidHistory& now = *result;
  now = {};
  now.valid = 1;
  now.format = keepsProbes(f) ? VK_FORMAT_R32G32B32A32_UINT : colorFormat(f);
  now.gatherSpacing = keepsProbes(f) ? gatherSpacing(f) : 0;
  const Rect r = renderRect(f);
  const uint32_t rect[4] = {r.x, r.y, r.width, r.height};
  std::copy(f.imageExtent, f.imageExtent + 2, now.extent);
  std::copy(rect, rect + 4, now.rect);
  forEachLightGroup(
      f,
      [&](const LightGroup&, const PellucidLight& light) {
        if (now.lightCount < PELLUCID_MAX_COHERENT_LIGHTS)
          now.lightDots[now.lightCount] = cameraLightDot(f, light);
        ++now.lightCount;
      },
      [](const LightGroup&) {});
  if (!fits(kept, now)) return false;
  const bool reused = f.reuse == PELLUCID_REUSE_ALTERNATE ? kept.age == 0 : coherent(f, kept, now);
  if (reused) {
    now = kept;
    ++now.age;
  }
  return reused;
}

}  // namespace pellucid
