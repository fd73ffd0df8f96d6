// Media of paths.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "capture/capture.h"

namespace pellucid::harness::reference {

struct TraceMedium {
  glm::dvec3 scattering, absorption;  // sigma_s, sigma_a of R, G, B, 1/mm; their sum is > 0
  double g = 0;                       // mean cosine of Henyey-Greenstein's phase function, (-1, 1)
  double ior = 1;                     // relative to what is outside, [1, 3]; 1: no boundary
  // A sheet without thickness, which paths do not enter: parts of the irradiance of a face that leave by it
  // and by the other.
  struct Wall {
    glm::dvec3 reflectance, transmittance;
  };
  std::optional<Wall> wall = {};
};

// Media of a capture's materials, in their order. `where` names the capture in messages. Throws InputError
// for materials that no scattering coefficients define (profiles, layered skin) and for values out of range.
std::vector<TraceMedium> traceMedia(const std::vector<MaterialSource>& materials, const std::string& where);

// Diffuse reflectance rho of the wall, or of the half-space under Lambertian light from outside, R, G, B:
// what a flat body returns of E. By similarity, sigma_s' = (1 - g) sigma_s, as the material compiler has it.
glm::dvec3 halfSpaceReflectance(const TraceMedium& medium);

}  // namespace pellucid::harness::reference
