#include "reference/ambient.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/color.h"
#include "reference/transmittance.h"
#include "scene/environment.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {

Ambient::Ambient(const Capture& capture, const SurfaceReader& surfaces,
                 const std::vector<PellucidMaterial>& materials)
    : capture_(capture), surfaces_(surfaces), materials_(materials), kernels_(materials.size()) {
  if (!capture.environment && capture.hiddenIrradiance.empty()) return;
  for (std::size_t i = 0; i < materials.size(); ++i)
    if (materials[i].transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2 ||
        materials[i].transmittanceModel == PELLUCID_TRANSMITTANCE_SINH_EXP)
      kernels_[i].emplace(materials[i]);
}

// Convolved with the clamped cosine, band by band: pi, 2 pi / 3, pi / 4.
glm::dvec3 Ambient::irradiance(const Harmonics& environment, const glm::dvec3& n) {
  constexpr double pi = std::numbers::pi;
  const std::array<double, 9> basis = harmonicBasis(fromGlm(n));
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < 9; ++i) {
    const double band = i == 0 ? pi : i < 4 ? 2 * pi / 3 : pi / 4;
    sum += band * basis[i] * toGlm(environment[i]);
  }
  return glm::max(sum, glm::dvec3(0));
}

glm::dvec3 Ambient::at(const Surface& s, std::size_t material) const {
  if (!capture_.environment && capture_.hiddenIrradiance.empty()) return glm::dvec3(0);
  const PellucidMaterial& m = materials_[material];
  const glm::dvec3 front = surfaces_.facet(s);
  const glm::dmat3 world(surfaces_.worldFromView());
  const auto visible = [&](const glm::dvec3& normal) {
    return capture_.environment ? irradiance(*capture_.environment, world * normal) : glm::dvec3(0);
  };
  const auto hidden = [&](const glm::dvec3& normal) {
    if (capture_.hiddenIrradiance.empty()) return visible(normal);
    return readColor(capture_.hiddenIrradiance.at(s.pixel.x, s.pixel.y));
  };
  if (m.thinWalled)
    return glm::dvec3(m.wallTransmittance[0], m.wallTransmittance[1], m.wallTransmittance[2]) *
           hidden(-front);
  if (!s.chord) return glm::dvec3(0);
  const SurfaceReader::HiddenFace face = surfaces_.hiddenFace(s);
  const double h = face.thickness * surfaces_.millimetersPerUnit();
  const glm::dvec3 rho(m.reflectance[0], m.reflectance[1], m.reflectance[2]);
  const glm::dvec3 kept = kernels_[material] ? kernels_[material]->slabReflectance(h) : glm::dvec3(1);
  const glm::dvec3 through = transmittance(m, h) * hidden(face.normal);
  const glm::dvec3 lost = (1.0 - kept) * rho * visible(front);
  return face.opposite * (through - lost);
}

}  // namespace pellucid::harness::reference
