// OpenPBR's subsurface medium as coefficients.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "guarded.h"
#include "pellucid/pellucid_material.h"
#include "quadrature.h"
#include "transport.h"

namespace pellucid::material {
namespace {

// OpenPBR Surface 1.1, "Subsurface": of the light that enters a half-space along the normal, the share that
// comes back out. `absorbed` = sqrt(1 - reduced albedo), in which the color is nearly linear.
double observedColor(const Angles& angles, double absorbed) {
  const double absorption = absorbed * absorbed;
  const Medium medium(angles, {1 - absorption, absorption});
  return medium.slab(std::numeric_limits<double>::infinity()).reflectanceNormal /
         (1 - fresnelReflectance(1, angles.ior));
}

// 1 - the reduced albedo of the half-space of that color.
double reducedAbsorption(const Angles& angles, double color) {
  constexpr int kSteps = 28;
  double low = 0, high = 1;  // of `absorbed`; the color falls with it
  for (int step = 0; step < kSteps; ++step) {
    const double middle = (low + high) / 2;
    (observedColor(angles, middle) > color ? low : high) = middle;
  }
  // The ends are exact: a white medium absorbs nothing, a black one scatters nothing.
  const double absorbed = color <= 0 ? 1 : color >= 1 ? 0 : (low + high) / 2;
  return absorbed * absorbed;
}

void requirePositive(const std::string& field, double value) {
  if (!(value > 0 && std::isfinite(value)))
    throw Refusal(field, number(value) + " is not a finite number above 0");
}

PellucidMaterialDesc describeOpenPbr(const PellucidOpenPbr& material) {
  for (std::size_t c = 0; c < 3; ++c) {
    requireRange(indexed("subsurfaceColor", c), material.subsurfaceColor[c], 0, 1);
    requirePositive(indexed("subsurfaceRadiusScale", c), material.subsurfaceRadiusScale[c]);
  }
  requirePositive("subsurfaceRadius", material.subsurfaceRadius);
  requirePositive("millimetersPerUnit", material.millimetersPerUnit);
  requireRange("specularIor", material.specularIor, 1, 3);
  const double g = material.subsurfaceScatterAnisotropy;
  if (!(g > -1 && g < 1))
    throw Refusal("subsurfaceScatterAnisotropy", number(g) + " is not between -1 and 1");

  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  desc.kind = PELLUCID_MATERIAL_COEFFICIENTS;
  desc.g = g;
  desc.ior = material.specularIor;
  const Angles angles = makeAngles(material.specularIor);
  for (std::size_t c = 0; c < 3; ++c) {
    // Similarity: the reduced albedo is (1 - g) a / (1 - g a).
    const double reduced = reducedAbsorption(angles, material.subsurfaceColor[c]);
    const double absorption = (1 - g) * reduced / (1 - g * reduced);
    const double radius =
        material.subsurfaceRadius * material.subsurfaceRadiusScale[c] * material.millimetersPerUnit;
    desc.scattering[c] = (1 - absorption) / radius;
    desc.absorption[c] = absorption / radius;
    checkedCoefficients(desc, "subsurfaceRadius", "subsurfaceColor", desc.scattering[c], desc.absorption[c]);
  }
  return desc;
}

}  // namespace
}  // namespace pellucid::material

using namespace pellucid::material;

void pellucidInitOpenPbr(PellucidOpenPbr* material) {
  *material = {};
  std::fill_n(material->subsurfaceColor, 3, 0.8);
  material->subsurfaceRadius = 1;
  material->subsurfaceRadiusScale[0] = 1;
  material->subsurfaceRadiusScale[1] = 0.5;
  material->subsurfaceRadiusScale[2] = 0.25;
  material->specularIor = 1.5;
  material->millimetersPerUnit = 1;
}

PellucidResult pellucidDescribeOpenPbr(const PellucidOpenPbr* material, PellucidMaterialDesc* desc,
                                       PellucidMessageFn message, void* messageUser) {
  return guarded(message, messageUser, [&] {
    require("material", material);
    if (desc == nullptr) throw Refusal("desc", "NULL");
    *desc = describeOpenPbr(*material);
  });
}
