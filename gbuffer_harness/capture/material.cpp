#include "capture/material.h"

#include <algorithm>

#include "pellucid/pellucid_material.h"

namespace pellucid::harness {

namespace {

// Writes a source into a description; the strings stay the source's.
struct Describe {
  PellucidMaterialDesc& desc;
  const std::string& where;

  void operator()(const PresetMaterial& material) const {
    desc.kind = PELLUCID_MATERIAL_PRESET;
    desc.preset = material.preset.c_str();
  }
  void operator()(const CoefficientMaterial& material) const {
    desc.kind = PELLUCID_MATERIAL_COEFFICIENTS;
    std::copy(material.scattering.begin(), material.scattering.end(), desc.scattering);
    std::copy(material.absorption.begin(), material.absorption.end(), desc.absorption);
    desc.g = material.g;
    desc.ior = material.ior;
  }
  void operator()(const BurleyMaterial& material) const {
    desc.kind = PELLUCID_MATERIAL_BURLEY;
    std::copy(material.distance.begin(), material.distance.end(), desc.burleyDistance);
    for (std::size_t channel = 0; material.transmittance && channel < 3; ++channel)
      std::copy((*material.transmittance)[channel].begin(), (*material.transmittance)[channel].end(),
                desc.transmittance[channel]);
  }
  void operator()(const GaussianMaterial& material) const {
    desc.kind = PELLUCID_MATERIAL_GAUSSIANS;
    const std::size_t count = material.variance.size();
    if (count < 1 || count > PELLUCID_MAX_GAUSSIANS || material.weight.size() != count)
      throw InputError(where, "gaussians",
                       std::to_string(count) + " variances and " + std::to_string(material.weight.size()) +
                           " weights; 1 to " + std::to_string(PELLUCID_MAX_GAUSSIANS) +
                           " of each are needed");
    desc.gaussianCount = static_cast<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) {
      desc.gaussianVariance[i] = material.variance[i];
      for (std::size_t channel = 0; channel < 3; ++channel)
        desc.gaussianWeight[channel][i] = material.weight[i][channel];
    }
  }
  void operator()(const OpenPbrMaterial& material) const {
    PellucidOpenPbr openPbr;
    pellucidInitOpenPbr(&openPbr);
    std::copy(material.color.begin(), material.color.end(), openPbr.subsurfaceColor);
    openPbr.subsurfaceRadius = material.radius;
    std::copy(material.radiusScale.begin(), material.radiusScale.end(), openPbr.subsurfaceRadiusScale);
    openPbr.subsurfaceScatterAnisotropy = material.anisotropy;
    openPbr.specularIor = material.ior;
    requireMaterial(where, [&](PellucidMessageFn note, void* user) {
      return pellucidDescribeOpenPbr(&openPbr, &desc, note, user);
    });
  }
  void operator()(const SkinMaterial& material) const {
    desc.kind = PELLUCID_MATERIAL_SKIN;
    desc.melanin = material.melanin;
    desc.melaninType = material.melaninType;
    desc.hemoglobin = material.hemoglobin;
    desc.ior = material.ior;
  }
  void operator()(const ThinWallMaterial& material) const {
    desc.kind = PELLUCID_MATERIAL_THIN_WALL;
    std::copy(material.reflectance.begin(), material.reflectance.end(), desc.wallReflectance);
    std::copy(material.transmittance.begin(), material.transmittance.end(), desc.wallTransmittance);
    if (material.distance)
      std::copy(material.distance->begin(), material.distance->end(), desc.burleyDistance);
  }
};

CoefficientMaterial coefficientsOf(const PellucidMaterialDesc& desc) {
  CoefficientMaterial material{};
  const double millimeters = desc.millimetersPerUnit > 0 ? desc.millimetersPerUnit : 1;
  for (std::size_t c = 0; c < 3; ++c) {
    material.scattering[c] = desc.scattering[c] / millimeters;
    material.absorption[c] = desc.absorption[c] / millimeters;
  }
  material.g = desc.g;
  if (desc.ior > 0) material.ior = desc.ior;
  return material;
}

}  // namespace

PellucidMaterialDesc describeMaterial(const MaterialSource& source, const std::string& where) {
  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  std::visit(Describe{desc, where}, source);
  return desc;
}

PellucidMaterial compileMaterial(const MaterialSource& source, const std::string& where) {
  const PellucidMaterialDesc desc = describeMaterial(source, where);
  PellucidMaterial material = {};
  requireMaterial(where, [&](PellucidMessageFn note, void* user) {
    return pellucidCompileMaterial(&desc, &material, nullptr, note, user);
  });
  return material;
}

CoefficientMaterial coefficientsOf(const MaterialSource& source, const std::string& where) {
  if (const auto* given = std::get_if<CoefficientMaterial>(&source)) return *given;
  if (std::holds_alternative<OpenPbrMaterial>(source)) return coefficientsOf(describeMaterial(source, where));
  if (std::holds_alternative<ThinWallMaterial>(source))
    throw InputError(where, "", "is thin-walled, which no scattering coefficients define");
  if (std::holds_alternative<SkinMaterial>(source))
    throw InputError(where, "melanin", "skin has layers, which no single set of coefficients defines");
  const auto* preset = std::get_if<PresetMaterial>(&source);
  if (!preset) throw InputError(where, "", "is a profile, which no scattering coefficients define");
  PellucidMaterialDesc desc;
  if (pellucidFindPreset(preset->preset.c_str(), &desc) != PELLUCID_OK)
    throw InputError(where, "preset", "there is no \"" + preset->preset + "\"");
  if (desc.kind != PELLUCID_MATERIAL_COEFFICIENTS)
    throw InputError(where, "preset",
                     "\"" + preset->preset + "\" has layers, which no single set of coefficients defines");
  return coefficientsOf(desc);
}

MaterialSource withIor(const MaterialSource& source, double ior, const std::string& where) {
  if (const auto* openPbr = std::get_if<OpenPbrMaterial>(&source)) {
    OpenPbrMaterial material = *openPbr;
    material.ior = ior;
    return material;
  }
  if (const auto* skin = std::get_if<SkinMaterial>(&source)) {
    SkinMaterial material = *skin;
    material.ior = ior;
    return material;
  }
  CoefficientMaterial material = coefficientsOf(source, where);
  material.ior = ior;
  return material;
}

std::vector<PellucidMaterial> compileMaterials(const Capture& capture) {
  std::vector<PellucidMaterial> materials;
  for (std::size_t i = 0; i < capture.materials.size(); ++i)
    materials.push_back(
        compileMaterial(capture.materials[i], capture.name + ": materials[" + std::to_string(i) + "]"));
  return materials;
}

}  // namespace pellucid::harness
