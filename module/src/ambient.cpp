#include "ambient.h"

#include <algorithm>

namespace pellucid {

PellucidLight ambientLight(const PellucidFrame& frame) {
  PellucidLight light{};
  light.type = PELLUCID_SHADER_LIGHT_AMBIENT;
  std::fill_n(light.color, 3, 1.0f);
  const float* ambient = frame.options.ambient;
  const bool some =
      ambient && std::any_of(ambient, ambient + kAmbientCoefficients, [](float c) { return c != 0; });
  light.intensity = some || given(frame.hiddenIrradiance) ? 1 : 0;
  return light;
}

// Ramamoorthi & Hanrahan 2001, equations 11 and 12.
std::array<glm::mat4, 3> ambientIrradiance(const Inputs& inputs, const Screen& screen) {
  std::array<glm::mat4, 3> result{};
  if (!inputs.frame.options.ambient) return result;
  constexpr double c1 = 0.42904276540489, c2 = 0.51166335397324, c3 = 0.74312386836844, c4 = 0.88622692545276,
                   c5 = 0.24770795612281;
  const glm::dmat4 rotation(glm::dmat3(screen.viewFromWorld));
  for (size_t c = 0; c < 3; ++c) {
    double l[9];
    for (size_t i = 0; i < 9; ++i)
      l[i] = static_cast<double>(inputs.frame.options.ambient[3 * i + c]) *
             static_cast<double>(inputs.frame.preExposure);
    const glm::dmat4 world(c1 * l[8], c1 * l[4], c1 * l[7], c2 * l[3],   //
                           c1 * l[4], -c1 * l[8], c1 * l[5], c2 * l[1],  //
                           c1 * l[7], c1 * l[5], c3 * l[6], c2 * l[2],   //
                           c2 * l[3], c2 * l[1], c2 * l[2], c4 * l[0] - c5 * l[6]);
    result[c] = glm::mat4(rotation * world * glm::transpose(rotation));
  }
  return result;
}

}  // namespace pellucid
