#include "shadow_map.h"

#include <algorithm>

#include "camera.h"

namespace pellucid {

bool isPerspective(const PellucidShadowMap& map) {
  const float* clip = map.clipFromWorld;
  return clip[3] != 0 || clip[7] != 0 || clip[11] != 0;
}

double texelSide(const PellucidShadowMap& map) {
  const glm::dmat4 clip = toMatrix(map.clipFromWorld);
  const auto row = [&](int i) { return glm::dvec3(clip[0][i], clip[1][i], clip[2][i]); };
  const bool perspective = isPerspective(map);
  const glm::dvec3 w = row(3);
  double side = 0;
  for (int i = 0; i < 2; ++i) {
    // An axis that is off center leans along the view; that does not make texels smaller.
    const glm::dvec3 across = perspective ? row(i) - w * (glm::dot(row(i), w) / glm::dot(w, w)) : row(i);
    side = std::max(side, 2 * (perspective ? glm::length(w) : 1) / (glm::length(across) * map.extent[i]));
  }
  return side;
}

float meanFreePath(const PellucidMaterial& material) {
  float sum = 0;
  for (const float(&t)[5] : material.transmittance) {
    float rate = 0;
    if (material.transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP) {
      rate = t[1];
    } else if (material.transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2) {
      // The slower of the two terms that are there reaches farther.
      rate = t[0] > 0 && t[2] > 0 ? std::min(t[1], t[3]) : t[0] > 0 ? t[1] : t[3];
    }
    if (!(rate > 0)) return 0;
    sum += 1 / rate;
  }
  return sum / 3;
}

}  // namespace pellucid
