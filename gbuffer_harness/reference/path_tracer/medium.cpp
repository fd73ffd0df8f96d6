#include "reference/path_tracer/medium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "capture/material.h"
#include "common/error.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::harness::reference {

namespace {

void require(bool holds, const std::string& where, const char* field, double value, const char* range) {
  if (holds) return;
  std::ostringstream sentence;
  sentence << value << " is not " << range;
  throw InputError(where, field, sentence.str());
}

}  // namespace

std::vector<TraceMedium> traceMedia(const std::vector<MaterialSource>& materials, const std::string& where) {
  std::vector<TraceMedium> media;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string name = where + ": materials[" + std::to_string(i) + "]";
    if (std::holds_alternative<ThinWallMaterial>(materials[i])) {
      const PellucidMaterial m = compileMaterial(materials[i], name);
      const float *r = m.reflectance, *t = m.wallTransmittance;
      media.emplace_back().wall = TraceMedium::Wall{{r[0], r[1], r[2]}, {t[0], t[1], t[2]}};
      continue;
    }
    const CoefficientMaterial material = coefficientsOf(materials[i], name);
    TraceMedium medium;
    for (int c = 0; c < 3; ++c) {
      const double s = material.scattering[static_cast<std::size_t>(c)];
      const double a = material.absorption[static_cast<std::size_t>(c)];
      require(s >= 0 && std::isfinite(s), name, "scattering", s, ">= 0");
      require(a >= 0 && std::isfinite(a), name, "absorption", a, ">= 0");
      require(s + a > 0, name, "absorption", s + a, "above 0 together with scattering");
      medium.scattering[c] = s;
      medium.absorption[c] = a;
    }
    medium.g = material.g;
    medium.ior = material.ior;
    require(std::abs(medium.g) < 1, name, "g", medium.g, "between -1 and 1");
    require(medium.ior >= 1 && medium.ior <= 3, name, "ior", medium.ior, "within 1 .. 3");
    media.push_back(medium);
  }
  return media;
}

glm::dvec3 halfSpaceReflectance(const TraceMedium& medium) {
  if (medium.wall) return medium.wall->reflectance;
  glm::dvec3 rho;
  for (int c = 0; c < 3; ++c) {
    PellucidSlab slab;
    const PellucidResult result =
        pellucidSlabTransport((1 - medium.g) * medium.scattering[c], medium.absorption[c], medium.ior,
                              std::numeric_limits<double>::infinity(), &slab, nullptr, nullptr);
    if (result != PELLUCID_OK) throw InputError("", "reflectance", pellucidResultName(result));
    rho[c] = slab.reflectance;
  }
  return rho;
}

}  // namespace pellucid::harness::reference
