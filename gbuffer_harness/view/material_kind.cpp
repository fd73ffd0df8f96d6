#include "view/material_kind.h"

#include <algorithm>

#include "capture/material.h"

namespace pellucid::harness {

namespace {

constexpr const char* kWhere = "this material";

OpenPbrMaterial asOpenPbr(const MaterialSource& source) {
  const CoefficientMaterial medium = coefficientsOf(source, kWhere);
  const PellucidMaterial compiled = compileMaterial(source, kWhere);
  OpenPbrMaterial result;
  std::array<double, 3> paths;
  for (std::size_t c = 0; c < 3; ++c) {
    paths[c] = 1 / (medium.scattering[c] + medium.absorption[c]);
    result.color[c] = std::clamp<double>(compiled.reflectance[c], 0, 1);
  }
  result.radius = *std::max_element(paths.begin(), paths.end());
  for (std::size_t c = 0; c < 3; ++c) result.radiusScale[c] = paths[c] / result.radius;
  result.anisotropy = medium.g;
  result.ior = medium.ior;
  return result;
}

}  // namespace

MaterialKind kindOf(const MaterialSource& source) { return static_cast<MaterialKind>(source.index()); }

const char* materialKindName(MaterialKind kind) {
  constexpr std::array<const char*, 7> kNames = {
      "preset", "coefficients", "Burley's profile", "Gaussians", "thin wall", "OpenPBR", "skin"};
  return kNames[static_cast<std::size_t>(kind)];
}

MaterialSource asKind(const MaterialSource& source, MaterialKind kind) {
  if (kind == kindOf(source)) return source;
  switch (kind) {
    case MaterialKind::Coefficients:
      return coefficientsOf(source, kWhere);
    case MaterialKind::OpenPbr:
      return asOpenPbr(source);
    case MaterialKind::Skin:
      return SkinMaterial{};
    default:
      return PresetMaterial{"skin1"};
  }
}

}  // namespace pellucid::harness
